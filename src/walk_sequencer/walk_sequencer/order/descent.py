# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The compiled descent of the local search, on closed tours that begin with vertex 0.

`costs` (n, n) from row to column; `early` (n, n), true where the row must come before the column; `tour` (n,) the
vertices, `tour[0]` is 0 and stays so.
"""

from __future__ import annotations

import numba
import numpy as np

_SHORT, _LONG = 3, 30  # pieces of Or-opt; the long ones where few stretches can be turned
_ALLOWED = 1.0
_LEAST = 1e-9  # a smaller gain is rounding


@numba.njit(cache=True, nogil=True)
def search(costs, early, firsts, cuts):
    """Returns the best tour found from nearest-neighbour tours by way of `firsts`, and then of the kicks.

    Args:
        costs: See above.
        early: See above.
        firsts: (s,) vertices to come first.
        cuts: (k, 3) rising places a < b < c; a kick exchanges tour[a..b) and tour[b..c).
    """
    n = len(costs)
    ruled = early.any()
    longest = min(_LONG if ruled or np.any(costs[1:, 1:] != costs[1:, 1:].T) else _SHORT, n - 2)
    best, least = np.zeros(n, np.int64), np.inf
    place, queued = np.empty(n, np.int64), np.zeros(n, np.bool_)
    for first in firsts:
        tour = _nearest_neighbour(costs, early, first)
        queued[:] = True
        cost = _descend(costs, early, ruled, longest, tour, place, queued)
        if cost < least - _LEAST:
            best, least = tour, cost
    tour, here, now = best.copy(), best.copy(), least
    for k in range(len(cuts)):
        a, b, c = cuts[k]
        if ruled and _too_early(early, here[a:b], here[b:c]):
            continue
        tour[:] = here
        tour[a : a + c - b] = here[b:c]
        tour[a + c - b : c] = here[a:b]
        for at in (a - 1, a, a + c - b - 1, a + c - b, c - 1, c % n):
            queued[tour[at]] = True
        cost = _descend(costs, early, ruled, longest, tour, place, queued)
        # At first a tour may become a little worse, by a share of its mean step, or it would stay in its valley.
        if cost < now + _ALLOWED * least / n * (1.0 - k / len(cuts)):
            here[:] = tour
            now = cost
        if cost < least - _LEAST:
            best[:] = tour
            least = cost
    return best


@numba.njit(cache=True, nogil=True)
def _nearest_neighbour(costs, early, first):
    n = len(costs)
    tour = np.zeros(n, np.int64)
    waits_for = early.sum(axis=0)
    left = np.ones(n, np.bool_)
    left[0], at = False, first
    for k in range(1, n):
        if k > 1:
            at = -1
            for v in range(n):
                if left[v] and waits_for[v] == 0 and (at < 0 or costs[tour[k - 1], v] < costs[tour[k - 1], at]):
                    at = v
        tour[k], left[at] = at, False
        waits_for -= early[at]
    return tour


@numba.njit(cache=True, nogil=True)
def _descend(costs, early, ruled, longest, tour, place, queued):
    """Makes the best change at a queued vertex, and queues its ends, until the queue is empty; returns the cost."""
    n = len(tour)
    turned = np.zeros(n)  # what the steps up to each place cost more when walked backwards
    fresh = False
    while queued.any():
        for v in range(n):
            if not queued[v]:
                continue
            if not fresh:
                for k in range(n):
                    place[tour[k]] = k
                for k in range(1, n):
                    turned[k] = turned[k - 1] + costs[tour[k], tour[k - 1]] - costs[tour[k - 1], tour[k]]
                fresh = True
            gain, i, size, to, turn = _best_turn(costs, early, ruled, tour, turned, place[v])
            other = _best_move(costs, early, ruled, longest, tour, turned, place[v])
            if other[0] < gain:
                gain, i, size, to, turn = other
            if gain > -_LEAST:
                queued[v] = False
                continue
            low, high = _change(tour, i, size, to, turn)
            joint = to + size if to < i else to - size
            for at in (low - 1, low, joint, (joint + 1) % n, high, (high + 1) % n):
                queued[tour[at]] = True
            fresh = False
    cost = costs[tour[-1], 0]
    for k in range(n - 1):
        cost += costs[tour[k], tour[k + 1]]
    return cost


@numba.njit(cache=True, nogil=True)
def _best_turn(costs, early, ruled, tour, turned, at):
    """Returns (gain, i, size, i - 1, True): the best reversal of a tour[i..i+size) with an end at or beside `at`."""
    n = len(tour)
    best, first, length = 0.0, 1, 0
    for k in range(1, n):
        for beside in range(2):
            i, j = (at + beside, k) if k > at else (k, at - beside)
            if i < 1 or i >= j:
                continue
            p, q, r, s = tour[i - 1], tour[i], tour[j], tour[(j + 1) % n]
            gain = costs[p, r] + costs[q, s] - costs[p, q] - costs[r, s] + turned[j] - turned[i]
            if gain < best and not (ruled and _ordered(early, tour[i : j + 1])):
                best, first, length = gain, i, j + 1 - i
    return best, first, length, first - 1, True


@numba.njit(cache=True, nogil=True)
def _best_move(costs, early, ruled, longest, tour, turned, at):
    """Returns (gain, i, size, to, turn): the best move of a piece tour[i..i+size) at `at` to behind tour[to]."""
    n = len(tour)
    best, first, length, behind, backward = 0.0, 1, 0, 0, False
    for size in range(1, longest + 1):
        for i in (at, at + 1 - size):
            if i < 1 or i + size > n or (size == 1 and i != at):
                continue
            j = i + size - 1
            p, b, c, q = tour[i - 1], tour[i], tour[j], tour[(j + 1) % n]
            saved = costs[p, q] - costs[p, b] - costs[c, q]
            back = turned[j] - turned[i]
            for k in range(n):
                if i - 1 <= k <= j:
                    continue
                r, s = tour[k], tour[(k + 1) % n]
                gap = saved - costs[r, s]
                straight = gap + costs[r, b] + costs[c, s]
                turn = gap + costs[r, c] + costs[b, s] + back
                gain = min(straight, turn)
                if gain >= best:
                    continue
                if ruled and ((turn < straight and _ordered(early, tour[i : j + 1])) or _passes(early, tour, i, j, k)):
                    continue
                best, first, length, behind, backward = gain, i, size, k, turn < straight
            if size == 1:
                break
    return best, first, length, behind, backward


@numba.njit(cache=True, nogil=True)
def _passes(early, tour, i, j, k):
    """Returns whether tour[i..j], put behind tour[k], would pass what it must not."""
    if k > j:
        return _too_early(early, tour[i : j + 1], tour[j + 1 : k + 1])
    return _too_early(early, tour[k + 1 : i], tour[i : j + 1])


@numba.njit(cache=True, nogil=True)
def _too_early(early, firsts, seconds):
    """Returns whether one of the first vertices must come before one of the second, which come before them now."""
    for a in firsts:
        for b in seconds:
            if early[a, b]:
                return True
    return False


@numba.njit(cache=True, nogil=True)
def _ordered(early, piece):
    """Returns whether one vertex of the piece must come before another of it, so that it cannot be turned."""
    for k in range(len(piece)):  # noqa: SIM110  numba compiles no generators
        if _too_early(early, piece[k : k + 1], piece[k + 1 :]):
            return True
    return False


@numba.njit(cache=True, nogil=True)
def _change(tour, i, size, to, turn):
    """Moves tour[i..i+size) to behind tour[to], turned or not; returns the first and the last place that changed."""
    piece = tour[i : i + size].copy()
    if turn:
        piece = piece[::-1].copy()
    if to < i:
        tour[to + 1 + size : i + size] = tour[to + 1 : i].copy()
        tour[to + 1 : to + 1 + size] = piece
        return to + 1, i + size - 1
    tour[i : to + 1 - size] = tour[i + size : to + 1].copy()
    tour[to + 1 - size : to + 1] = piece
    return i, to
