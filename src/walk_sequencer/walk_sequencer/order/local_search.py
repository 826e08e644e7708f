# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A near-optimal order for many keypoints: 2-opt and Or-opt again and again, and insertion under rules."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from walk_sequencer.config import SequencerConfig
from walk_sequencer.order.descent import search
from walk_sequencer.order.ruin import recreate

_STARTS = 8
_ONE_WAY = 4  # times as many kicks where few stretches can be turned: there are more valleys
_RUINS = 40  # for each kick asked for, under rules; one costs less than a kick
_REACH = 30  # indices that the stretches a kick exchanges span: what is far away stays good as it is


def order_local_search(
    costs: NDArray[np.float64], start: int, end: int, config: SequencerConfig, before: NDArray[np.bool_]
) -> NDArray[np.int64]:
    """Returns an order that no turned stretch (`croes1958`) and no move of a few keypoints (`or1976`) betters.

    Starts from nearest-neighbour orders, keeps the best, and tries again `config.kicks` times a keypoint from it
    with two neighbouring stretches exchanged (the double bridge of `martin1991`, kept local). After a kick only what
    is near a changed step is looked at again (the queue of `bentley1992`), and at first a kick may leave the tour a
    little longer (`dueck1990`). Under rules most kicks break one; there the tour is then ruined and recreated, and the
    better of the two counts. The open tour is searched as a closed one
    through a further vertex that costs nothing, from which only a chosen start and to which only a chosen end can be
    had for less than every tour costs. A change after which something came too early is none.
    """
    n = len(costs)
    if n < 2:
        return np.arange(n)
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
    random = np.random.default_rng(config.seed)
    may_begin = np.flatnonzero(~early[1:, 1:].any(axis=0))
    firsts = random.permutation(may_begin)[:_STARTS] if start < 0 else np.array([start])
    one_way = before.any() or not np.array_equal(costs, costs.T)
    kicks = config.kicks * n * (_ONE_WAY if one_way else 1) if n > 3 else 0
    size = random.integers(1, min(_REACH, n - 1) // 2 + 1, size=(kicks, 2)) if kicks else np.zeros((0, 2), np.int64)
    begin = random.integers(1, n + 2 - size.sum(axis=1)) if kicks else np.zeros(0, np.int64)
    cuts = np.column_stack([begin, begin + size[:, 0], begin + size.sum(axis=1)]).astype(np.int64)
    tour: NDArray[np.int64] = search(closed, early, firsts.astype(np.int64) + 1, cuts)
    if before.any():
        tour = recreate(closed, early, tour, config.kicks * n * _RUINS, random)
    return tour[1:] - 1
