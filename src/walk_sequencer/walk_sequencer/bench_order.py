# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""How far the local search's orders are from the best, and what fifty keypoints cost with all pairs.

Without rules the best is known: the integer program of all steps, solved with subtour cuts (`dantzig1954`) by HiGHS.
Under rules it is the exact order where there is one, and else the best of longer searches with other seeds: the gaps
there are lower bounds of the true ones.
"""

from __future__ import annotations

import dataclasses
import statistics
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import Bounds, LinearConstraint, milp
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from walk_building.building import Building
from walk_sequencer.config import SequencerConfig
from walk_sequencer.order import find_order, order_cost
from walk_sequencer.order.exact import MAX_EXACT
from walk_sequencer.pipeline import plan_tour
from walk_sequencer.rules import Rules

_FREE, _LONGER, _SEEDS = Rules(), 4, (101, 102)


def order_gaps(seed: int) -> dict[str, Any]:
    """Returns for each kind of costs the gaps [share of the best] and the seconds of instances drawn from `seed` on."""
    flat_50 = [(straight(50, s), _FREE) for s in range(seed, seed + 6)]
    flat_100 = [(straight(100, s), _FREE) for s in range(seed, seed + 2)]
    one_way = [(np.random.default_rng(s).uniform(1.0, 9.0, (50, 50)), _FREE) for s in range(seed, seed + 4)]
    few = [(straight(MAX_EXACT, s), random_rules(MAX_EXACT, s)) for s in range(seed, seed + 40)]
    ruled = [(straight(50, s), random_rules(50, s)) for s in range(seed, seed + 6)]
    free = {"straight_50": flat_50, "straight_100": flat_100, "one_way_50": one_way}
    kinds = {**free, f"ruled_{MAX_EXACT}": few, "ruled_50": ruled}
    find_order(straight(16, 0), -1, -1, SequencerConfig(), random_rules(16, 0))  # loads the compiled code
    return {name: _gaps(instances) for name, instances in kinds.items()}


def fifty(building: Building, seed: int, repeats: int) -> dict[str, float]:
    """Returns the time [s] to plan fifty keypoints at random places, all pairs included, without and under rules."""
    surface, random = building.surface, np.random.default_rng(seed)
    rows = random.choice(np.flatnonzero(building.reachable), 50, replace=False)
    keypoints = surface.places[rows] + [0.0, 0.0, building.walker.eye_height_m]
    figures: dict[str, float] = {}
    for name, rules in (("free", _FREE), ("ruled", random_rules(50, seed))):
        config = SequencerConfig(before=rules.texts()[0])
        seconds = []
        for _ in range(repeats):
            started = time.perf_counter()
            tour = plan_tour(building, keypoints, config)
            seconds.append(time.perf_counter() - started)
        figures |= {f"{name}_s": statistics.median(seconds), f"{name}_m": tour.length_m}
    return figures | {"keypoints": float(len(tour.order)), "pairs": float(len(tour.pairs))}


def straight(n: int, seed: int) -> NDArray[np.float64]:
    """Returns the distances (n, n) [m] of random points in a square of 20 m."""
    points = np.random.default_rng(seed).uniform(0.0, 20.0, (n, 2))
    distances: NDArray[np.float64] = np.linalg.norm(points[:, None] - points[None], axis=2)
    return distances


def random_rules(n: int, seed: int) -> Rules:
    """Returns a third as many random pairs as keypoints, all kept by a hidden order."""
    random = np.random.default_rng(seed)
    hidden = random.permutation(n).tolist()
    picks = (sorted(random.choice(n, 2, replace=False).tolist()) for _ in range(n // 3))
    return Rules(before=tuple((hidden[a], hidden[b]) for a, b in picks))


def least_cost(costs: NDArray[np.float64]) -> float:
    """Returns the cost of the best open tour of costs (n, n), which need not be symmetric, without rules."""
    n = len(costs) + 1
    closed = np.zeros((n, n))
    closed[1:, 1:] = costs
    # Steps of equal costs both ways are one variable: twice as many have far more ties to break.
    twin = np.array_equal(closed, closed.T)
    tails, heads = np.nonzero(np.triu(np.ones((n, n)), 1) if twin else ~np.eye(n, dtype=bool))
    step = np.arange(len(tails))
    leaves, enters = (coo_array((np.ones(len(step)), (ends, step)), (n, len(step))) for ends in (tails, heads))
    limits = [LinearConstraint(leaves + enters, 2, 2)] if twin else []
    limits = limits or [LinearConstraint(leaves, 1, 1), LinearConstraint(enters, 1, 1)]
    while True:
        found = milp(closed[tails, heads], integrality=np.ones(len(step)), bounds=Bounds(0, 1), constraints=limits)
        used = found.x > 0.5
        parts, part = connected_components(coo_array((np.ones(used.sum()), (tails[used], heads[used])), (n, n)))
        if parts == 1:
            return float(found.fun)
        inside = [((part[tails] == k) & (part[heads] == k)).astype(float) for k in range(parts)]
        sizes = np.bincount(part)
        limits.append(LinearConstraint(np.array(inside), -np.inf, sizes - 1))


def _gaps(instances: list[tuple[NDArray[np.float64], Rules]]) -> dict[str, Any]:
    gaps, seconds, config = [], [], SequencerConfig(method="local_search")
    for costs, rules in instances:
        started = time.perf_counter()
        cost = order_cost(costs, find_order(costs, -1, -1, config, rules))
        seconds.append(time.perf_counter() - started)
        best = _best_ruled(costs, rules) if rules else least_cost(costs)
        gaps.append(cost / best - 1.0)
    return {
        "gaps": gaps,
        "mean_gap": statistics.mean(gaps),
        "worst_gap": max(gaps),
        "seconds": statistics.mean(seconds),
    }


def _best_ruled(costs: NDArray[np.float64], rules: Rules) -> float:
    if len(costs) <= MAX_EXACT:
        return order_cost(costs, find_order(costs, -1, -1, SequencerConfig(method="exact"), rules))
    usual = SequencerConfig(method="local_search")
    configs = (dataclasses.replace(usual, kicks=_LONGER * usual.kicks, seed=seed) for seed in _SEEDS)
    return min(order_cost(costs, find_order(costs, -1, -1, config, rules)) for config in configs)
