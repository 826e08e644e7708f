# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A near-optimal order for many keypoints: 2-opt and Or-opt, restarted from the best so far."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from walk_sequencer.config import SequencerConfig

_LONGEST_PIECE = 3  # of Or-opt
_STARTS = 8


def order_local_search(costs: NDArray[np.float64], start: int, end: int, config: SequencerConfig) -> NDArray[np.int64]:
    """Returns an order that no turned stretch (`croes1958`) and no move of up to three keypoints (`or1976`) betters.

    Starts from nearest-neighbour orders, keeps the best, and tries again `config.kicks` times from it with two
    stretches exchanged (the double bridge of (`martin1991`)). Costs need not be symmetric. The open tour is
    searched as a closed one through a further vertex that costs nothing, from which only a chosen start and to which
    only a chosen end can be had for less than every tour costs.
    """
    n = len(costs)
    if n < 3:
        return np.array(sorted(range(n), key=lambda k: (k == end) - (k == start)), dtype=np.int64)
    never = 1.0 + 2.0 * n * float(costs.max())
    closed = np.zeros((n + 1, n + 1))
    closed[1:, 1:] = costs
    if start >= 0:
        closed[0, 1:] = never
        closed[0, start + 1] = 0.0
    if end >= 0:
        closed[1:, 0] = never
        closed[end + 1, 0] = 0.0
    random = np.random.default_rng(config.seed)
    firsts = random.permutation(n)[:_STARTS] if start < 0 else np.array([start])
    cuts = np.sort(random.integers(1, n + 1, size=(config.kicks, 3)), axis=1)
    tour: NDArray[np.int64] = _search(closed, firsts.astype(np.int64) + 1, cuts.astype(np.int64))
    return tour[1:] - 1


@numba.njit(cache=True, nogil=True)
def _cost(costs, tour):
    total = costs[tour[-1], tour[0]]
    for k in range(len(tour) - 1):
        total += costs[tour[k], tour[k + 1]]
    return total


@numba.njit(cache=True, nogil=True)
def _nearest_neighbour(costs, first):
    n = len(costs)
    tour = np.zeros(n, dtype=np.int64)
    left = np.ones(n, dtype=np.bool_)
    left[0], left[first], tour[1] = False, False, first
    for k in range(2, n):
        best = -1
        for v in range(n):
            if left[v] and (best < 0 or costs[tour[k - 1], v] < costs[tour[k - 1], best]):
                best = v
        tour[k], left[best] = best, False
    return tour


@numba.njit(cache=True, nogil=True)
def _reverse(tour, i, j):
    while i < j:
        tour[i], tour[j] = tour[j], tour[i]
        i += 1
        j -= 1


@numba.njit(cache=True, nogil=True)
def _two_opt(costs, tour):
    """Makes the first improving reversal of tour[i..j] for each i; returns whether there was one."""
    n, better = len(tour), False
    for i in range(1, n - 1):
        turned = 0.0  # what walking tour[i..j] backwards adds
        for j in range(i + 1, n):
            turned += costs[tour[j], tour[j - 1]] - costs[tour[j - 1], tour[j]]
            a, b, c, d = tour[i - 1], tour[i], tour[j], tour[(j + 1) % n]
            if costs[a, c] + costs[b, d] - costs[a, b] - costs[c, d] + turned < -1e-9:
                _reverse(tour, i, j)
                better = True
                break
    return better


@numba.njit(cache=True, nogil=True)
def _best_gap(costs, tour, i, size):
    """Returns (k, turned) for the piece tour[i..i+size) best put behind tour[k], k -1 where it is best off already."""
    n = len(tour)
    a, b, c, d = tour[i - 1], tour[i], tour[i + size - 1], tour[(i + size) % n]
    turned = 0.0
    for k in range(i, i + size - 1):
        turned += costs[tour[k + 1], tour[k]] - costs[tour[k], tour[k + 1]]
    saved = costs[a, b] + costs[c, d] - costs[a, d]
    best, to, turn = -1e-9, -1, False
    for k in range(n):
        if i - 1 <= k < i + size:
            continue
        p, q = tour[k], tour[(k + 1) % n]
        gap = costs[p, q] + saved
        straight = costs[p, b] + costs[c, q] - gap
        backward = costs[p, c] + costs[b, q] + turned - gap
        if straight < best:
            best, to, turn = straight, k, False
        if backward < best:
            best, to, turn = backward, k, True
    return to, turn


@numba.njit(cache=True, nogil=True)
def _or_opt(costs, tour, piece):
    """Moves pieces tour[i..i+size) to where they cost less, turned or not; returns whether one moved."""
    n, better = len(tour), False
    for size in range(1, _LONGEST_PIECE + 1):
        for i in range(1, n - size + 1):
            to, turn = _best_gap(costs, tour, i, size)
            if to < 0:
                continue
            better = True
            piece[:size] = tour[i : i + size]
            if turn:
                _reverse(piece, 0, size - 1)
            if to < i:
                for k in range(i - 1, to, -1):
                    tour[k + size] = tour[k]
                tour[to + 1 : to + 1 + size] = piece[:size]
            else:
                for k in range(i + size, to + 1):
                    tour[k - size] = tour[k]
                tour[to + 1 - size : to + 1] = piece[:size]
    return better


@numba.njit(cache=True, nogil=True)
def _descend(costs, tour, piece):
    better = True
    while better:
        better = _two_opt(costs, tour)
        better |= _or_opt(costs, tour, piece)


@numba.njit(cache=True, nogil=True)
def _search(costs, firsts, cuts):
    n = len(costs)
    piece = np.empty(_LONGEST_PIECE, dtype=np.int64)
    best = _nearest_neighbour(costs, firsts[0])
    _descend(costs, best, piece)
    least = _cost(costs, best)
    for f in range(1, len(firsts)):
        tour = _nearest_neighbour(costs, firsts[f])
        _descend(costs, tour, piece)
        cost = _cost(costs, tour)
        if cost < least - 1e-9:
            best, least = tour, cost
    for k in range(len(cuts)):
        a, b, c = cuts[k]
        tour = np.concatenate((best[:a], best[b:c], best[a:b], best[c:n]))
        _descend(costs, tour, piece)
        cost = _cost(costs, tour)
        if cost < least - 1e-9:
            best, least = tour, cost
    return best
