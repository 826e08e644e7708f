# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Ruin and recreate (`schrimpf2000`), compiled, on closed tours that begin with vertex 0.

Takes stretches near one vertex out of the tour (`christiaens2020`) and puts each vertex back where it costs least. Few
turned stretches keep rules; an insertion always finds a place, behind all that must come before it. What lies far apart
on the tour changes places by exchanges of stretches in between (our own combination). `costs`, `early` and `tour` are
those of the descent. What is written again and again is made once, by `recreate`.
"""

from __future__ import annotations

import numba
import numpy as np

from walk_sequencer.order.exchange import best_exchange, exchange, keeps_rules

_MOST = 40  # vertices taken out at once; rules part the good tours so far that 20 seldom lead from one to the other
_LONGEST = 20  # vertices of a stretch
_EXCHANGES = 20  # tried between two ruins, which cost as much
_NEAR = 8  # a vertex is put right behind one of so many nearest
_HOT, _COLD = 1.0, 0.01  # by how much a tour may become longer, first and last, as shares of a mean step
_BLINK = 0.01  # share of the better places that an insertion overlooks, or equal ruins would end equally


@numba.njit(cache=True, nogil=True)
def recreate(costs, early, tour, rounds, random):
    """Returns the best tour found from `tour` in so many rounds, under simulated annealing.

    Args:
        costs: (n, n), see above.
        early: (n, n), with all that follows from it.
        tour: (n,) keeps `early`.
        rounds: How often to ruin; the time is proportional.
        random: A NumPy generator.
    """
    n = len(tour)
    into, late = costs.T.copy(), early.T.copy()
    near, bound = np.empty((n, n), np.int64), np.empty(n, np.bool_)
    for v in range(n):
        near[v] = np.argsort(np.minimum(costs[v], into[v]))
        bound[v] = early[v].any() or late[v].any()
    here, best, new, out = tour.copy(), tour.copy(), np.empty(n, np.int64), np.empty(n, np.int64)
    place, gone, rank = np.argsort(tour), np.zeros(n, np.bool_), np.empty(n)
    now = _cost(costs, here)
    least, heat, cooling = now, now / n * _HOT, (_COLD / _HOT) ** (1.0 / max(rounds, 1))
    for _ in range(rounds):
        heat *= cooling
        now = _exchanges(costs, early, here, place, near, new, now, heat, random)
        if now < least:
            best[:] = here
            least = now
        centre = 1 + int(random.random() * (n - 1))
        count = _ruin(here, place, near[centre], new, out, gone, random)
        _queue(out[:count], costs[centre], into[centre], rank, random)
        for k in range(count):
            v = out[k]
            gone[v] = False
            _insert(costs, costs[v], into[v], early[v], late[v], bound[v], new, n - count + k, v, random)
        cost = _cost(costs, new)
        if cost < now - heat * np.log(1.0 - random.random()):
            here[:] = new
            for k in range(n):
                place[new[k]] = k
            now = cost
            if cost < least:
                best[:] = new
                least = cost
    return best


@numba.njit(cache=True, nogil=True)
def _cost(costs, tour):
    cost = costs[tour[-1], tour[0]]
    for k in range(len(tour) - 1):
        cost += costs[tour[k], tour[k + 1]]
    return cost


@numba.njit(cache=True, nogil=True)
def _exchanges(costs, early, tour, place, near, room, cost, heat, random):
    """Tries some exchanges that put a vertex right behind one near it, in place; returns the cost after them."""
    n = len(tour)
    for _ in range(_EXCHANGES):
        u = int(random.random() * n)
        v = near[u, int(random.random() * min(_NEAR, n))]
        if v in (0, u) or place[v] == place[u] + 1:
            continue
        more, a, b, c = best_exchange(costs, tour, place, u, v)
        if c > b and more < -heat * np.log(1.0 - random.random()) and keeps_rules(early, tour, a, b, c):
            exchange(tour, place, a, b, c, room)
            cost += more
    return cost


@numba.njit(cache=True, nogil=True)
def _ruin(tour, place, near, left, out, gone, random):
    """Splits the tour into `left` and `out`, filled from their beginnings; returns how many are out, and `gone`."""
    n = len(tour)
    wish = 1 + int(random.random() * min(_MOST, n - 1))
    longest = 1 + int(random.random() * min(_LONGEST, wish))
    count = 0
    for u in near:
        if count == wish:
            break
        if u == 0 or gone[u]:
            continue
        size = 1 + int(random.random() * min(longest, wish - count))
        first = max(place[u] - int(random.random() * size), 1)
        for at in range(first, min(first + size, n)):
            if not gone[tour[at]]:
                out[count] = tour[at]
                gone[tour[at]] = True
                count += 1
    size = 0
    for at in range(n):
        if not gone[tour[at]]:
            left[size] = tour[at]
            size += 1
    return count


@numba.njit(cache=True, nogil=True)
def _queue(out, from_centre, to_centre, rank, random):
    """Sorts the vertices as they are to be put back: by chance, the farthest or the nearest first."""
    chance = random.random()
    for k in range(len(out)):
        v, at = out[k], k
        distance = from_centre[v] + to_centre[v]
        key = random.random() if chance < 0.5 else (-distance if chance < 0.75 else distance)
        # A few numbers: sorted in place in less time than it takes to ask for memory.
        while at > 0 and rank[at - 1] > key:
            rank[at], out[at] = rank[at - 1], out[at - 1]
            at -= 1
        rank[at], out[at] = key, v


@numba.njit(cache=True, nogil=True)
def _insert(costs, leaving, entering, before, behind, bound, tour, size, v, random):
    """Puts v into tour[:size] where it costs least, behind all that must come before it.

    Args:
        costs: (n, n).
        leaving: (n,) from v.
        entering: (n,) to v.
        before: (n,) whether v must come before them.
        behind: (n,) whether v must come behind them.
        bound: Whether there is any of either.
        tour: (n,), written.
        size: How many vertices it has.
        v: The vertex.
        random: A NumPy generator.
    """
    low, high = 1, size
    if bound:
        for at in range(size - 1, 0, -1):
            if behind[tour[at]]:
                low = at + 1
                break
        for at in range(low, size):
            if before[tour[at]]:
                high = at
                break
    to, least, p = low, np.inf, tour[low - 1]
    for at in range(low, high + 1):
        s = tour[at] if at < size else 0
        more = entering[p] + leaving[s] - costs[p, s]
        if more < least and (at == low or random.random() >= _BLINK):
            to, least = at, more
        p = s
    for at in range(size, to, -1):
        tour[at] = tour[at - 1]
    tour[to] = v
