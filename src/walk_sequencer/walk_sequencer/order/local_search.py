# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A near-optimal order for many keypoints: 2-opt and Or-opt again and again; under rules, ruin and recreate."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

from walk_sequencer.config import SequencerConfig
from walk_sequencer.order.descent import search
from walk_sequencer.order.ruin import recreate

_STARTS = 8
_ONE_WAY = 4  # times as many kicks where few stretches can be turned: there are more valleys
_RUINS = 12  # in a chain, for each kick asked for
_CHAINS = 6  # under rules; a chain ends in one of several valleys far apart, and more time would not get it out
_REACH = 30  # indices that the stretches a kick exchanges span: what is far away stays good as it is


def order_local_search(
    costs: NDArray[np.float64], start: int, end: int, config: SequencerConfig, before: NDArray[np.bool_]
) -> NDArray[np.int64]:
    """Returns an order that no turned stretch (`croes1958`) and no move of a few keypoints (`or1976`) betters.

    Starts from nearest-neighbour orders, keeps the best, and tries again `config.kicks` times a keypoint from it
    with two neighbouring stretches exchanged (the double bridge of `martin1991`, kept local). After a kick only what
    is near a changed step is looked at again (the queue of `bentley1992`), and at first a kick may leave the tour a
    little longer (`dueck1990`). Under rules most kicks break one; there the order is ruined and recreated as well, or
    instead where the costs are the same both ways, in several chains of chance, and the best of them counts.

    The open tour is searched as a closed one through a further vertex that costs nothing, from which only a chosen
    start and to which only a chosen end can be had for less than every tour costs. A change after which something came
    too early is none.
    """
    n = len(costs)
    if n < 2:
        return np.arange(n)
    closed, early = _closed(costs, start, end, before)
    may_begin = np.flatnonzero(~early[1:, 1:].any(axis=0)) if start < 0 else np.array([start])
    kicks, ruled = config.kicks * n, bool(before.any())
    one_way = not np.array_equal(costs, costs.T)
    # A quick search under rules has one chain too.
    chains = min(_CHAINS, 1 + config.kicks // 8) if ruled else 1

    def chain(number: int) -> NDArray[np.int64]:
        random = np.random.default_rng(config.seed if chains == 1 else [config.seed, number])
        firsts = random.permutation(may_begin)[:_STARTS] + 1
        cuts = _cuts(n, kicks * _ONE_WAY if one_way else 0 if ruled else kicks, random)
        tour: NDArray[np.int64] = search(closed, early, firsts, cuts)
        return recreate(closed, early, tour, kicks * _RUINS, random) if ruled else tour

    return _best(closed, chain, chains)[1:] - 1


def _closed(
    costs: NDArray[np.float64], start: int, end: int, before: NDArray[np.bool_]
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Returns the costs and the rules of the closed tour, whose further vertex is 0."""
    n = len(costs)
    never = 1.0 + 2.0 * n * float(costs.max())
    closed, early = np.zeros((n + 1, n + 1)), np.zeros((n + 1, n + 1), bool)
    closed[1:, 1:], early[1:, 1:] = costs, before
    if start >= 0:
        closed[0, 1:] = never
        closed[0, start + 1] = 0.0
    if end >= 0:
        closed[1:, 0] = never
        closed[end + 1, 0] = 0.0
        early[1:, end + 1] |= np.arange(n) != end
    return closed, early


def _cuts(n: int, kicks: int, random: np.random.Generator) -> NDArray[np.int64]:
    """Returns the places (kicks, 3) between which each kick exchanges two stretches."""
    if not kicks or n <= 3:
        return np.zeros((0, 3), np.int64)
    size = random.integers(1, min(_REACH, n - 1) // 2 + 1, size=(kicks, 2))
    begin = random.integers(1, n + 2 - size.sum(axis=1))
    return np.column_stack([begin, begin + size[:, 0], begin + size.sum(axis=1)]).astype(np.int64)


def _best(closed: NDArray[np.float64], chain: Callable[[int], NDArray[np.int64]], chains: int) -> NDArray[np.int64]:
    """Returns the best of the tours by the chains, which run on all processors; the first of equals."""
    if chains == 1:
        return chain(0)
    with ThreadPoolExecutor(min(chains, len(os.sched_getaffinity(0)))) as threads:
        return min(threads.map(chain, range(chains)), key=lambda tour: float(closed[tour, np.roll(tour, -1)].sum()))
