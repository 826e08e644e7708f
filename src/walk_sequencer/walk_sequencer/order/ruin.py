# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Ruin and recreate (`schrimpf2000`), compiled, on closed tours that begin with vertex 0.

Takes stretches near one vertex out of the tour (`christiaens2020`) and puts each vertex back where it costs least. Few
turned or exchanged stretches keep rules; an insertion always finds a place, behind all that must come before it.
`costs`, `early` and `tour` are those of the descent.
"""

from __future__ import annotations

import numba
import numpy as np

_MOST = 20  # vertices taken out at once
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
    near = np.empty((n, n), np.int64)
    for v in range(n):
        near[v] = np.argsort(np.minimum(costs[v], costs[:, v]))
    here, best = tour.copy(), tour.copy()
    now = _cost(costs, here)
    least, step = now, now / n
    new, out = np.empty(n, np.int64), np.empty(n, np.int64)
    for k in range(rounds):
        centre = 1 + int(random.random() * (n - 1))
        count = _ruin(here, near[centre], new, out, random)
        distance = costs[centre] + costs[:, centre]
        size = n - count
        for v in _queue(out[:count], distance, random):
            _insert(costs, early, new, size, v, random)
            size += 1
        cost = _cost(costs, new)
        if cost < now - step * _HOT * (_COLD / _HOT) ** (k / rounds) * np.log(1.0 - random.random()):
            here[:] = new
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
def _ruin(tour, near, left, out, random):
    """Splits the tour into `left` and `out`, filled from their beginnings; returns how many are out."""
    n = len(tour)
    place, gone = np.empty(n, np.int64), np.zeros(n, np.bool_)
    for k in range(n):
        place[tour[k]] = k
    wish = 1 + int(random.random() * min(_MOST, n - 1))
    longest = 1 + int(random.random() * min(10, wish))
    count = 0
    for u in near:
        if count == wish:
            break
        if u == 0 or gone[u]:
            continue
        size = 1 + int(random.random() * min(longest, wish - count))
        first = max(place[u] - int(random.random() * size), 1)
        for v in tour[first : first + size]:
            if not gone[v]:
                out[count], gone[v] = v, True
                count += 1
    size = 0
    for v in tour:
        if not gone[v]:
            left[size] = v
            size += 1
    return count


@numba.njit(cache=True, nogil=True)
def _queue(out, distance, random):
    """Returns the vertices in the order to put them back: by chance, the farthest or the nearest first."""
    chance = random.random()
    rank = np.empty(len(out))
    for k in range(len(out)):
        by_distance = -distance[out[k]] if chance < 0.75 else distance[out[k]]
        rank[k] = random.random() if chance < 0.5 else by_distance
    return out[np.argsort(rank)]


@numba.njit(cache=True, nogil=True)
def _insert(costs, early, tour, size, v, random):
    """Puts v into tour[:size] where it costs least, behind all that must come before it."""
    low = 1
    for at in range(size - 1, 0, -1):
        if early[tour[at], v]:
            low = at + 1
            break
    high = low
    while high < size and not early[v, tour[high]]:
        high += 1
    to, least = -1, np.inf
    for at in range(low, high + 1):
        p, s = tour[at - 1], tour[at] if at < size else 0
        more = costs[p, v] + costs[v, s] - costs[p, s]
        if more < least and (to < 0 or random.random() >= _BLINK):
            to, least = at, more
    for at in range(size, to, -1):
        tour[at] = tour[at - 1]
    tour[to] = v
