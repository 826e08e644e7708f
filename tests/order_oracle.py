# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Orders by brute force and by the sets that may be walked first, and costs to try them on."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from walk_sequencer.config import SequencerConfig
from walk_sequencer.order import find_order, order_cost
from walk_sequencer.rules import FREE, Rules


def euclidean(n: int, seed: int) -> NDArray[np.float64]:
    points = np.random.default_rng(seed).uniform(0.0, 20.0, (n, 2))
    return np.linalg.norm(points[:, None] - points[None], axis=2)


def ordered(
    name: str, costs: NDArray[np.float64], start: int = -1, end: int = -1, rules: Rules = FREE, **settings: int
) -> NDArray[np.int64]:
    return find_order(costs, start, end, SequencerConfig(method=name, **settings), rules)  # type: ignore[arg-type]


def keeps(order: tuple[int, ...], start: int = -1, end: int = -1, rules: Rules = FREE) -> bool:
    at = {k: place for place, k in enumerate(order)}
    return (
        (start < 0 or order[0] == start)
        and (end < 0 or order[-1] == end)
        and all(at[a] < at[b] for a, b in rules.before)
        and all(at[a] + 1 == at[b] for a, b in rules.links)
    )


def brute_force(costs: NDArray[np.float64], start: int, end: int, rules: Rules = FREE) -> float:
    orders = (p for p in itertools.permutations(range(len(costs))) if keeps(p, start, end, rules))
    return min((order_cost(costs, np.array(p)) for p in orders), default=np.inf)


def least_by_sets(costs: NDArray[np.float64], rules: Rules) -> float:
    """Returns the cost of the best order that keeps `rules.before`.

    Goes from every set of keypoints that can have been walked to those with one more, and keeps for each the least
    cost by the last keypoint; other sets never come to be, so that rules make it faster.
    """
    n = len(costs)
    needs = [sum({1 << a for a, b in rules.implied() if b == k}) for k in range(n)]
    least: dict[int, NDArray[np.float64]] = {}
    for k in range(n):
        if not needs[k]:
            least[1 << k] = np.where(np.arange(n) == k, 0.0, np.inf)
    for _ in range(n - 1):
        wider: dict[int, NDArray[np.float64]] = {}
        for walked, by_last in least.items():
            onward = (by_last[:, None] + costs).min(axis=0)
            for k in range(n):
                if not walked >> k & 1 and needs[k] & walked == needs[k]:
                    ends = wider.setdefault(walked | 1 << k, np.full(n, np.inf))
                    ends[k] = min(ends[k], onward[k])
        least = wider
    return float(min(by_last.min() for by_last in least.values()))
