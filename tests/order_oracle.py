# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Orders by brute force, and costs to try them on."""

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
