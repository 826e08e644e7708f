# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From a state to the path that is handed out."""

from __future__ import annotations

import numpy as np

from walk_trajopt.path import OptimisedPath, Stretch, read_only
from walk_trajopt.polyline import arc_lengths
from walk_trajopt.solvers import Solution
from walk_trajopt.state import State


def path_of(state: State, solution: Solution, solver: str) -> OptimisedPath:
    """Returns the path of a state, its stretches named by its own arc length.

    Args:
        state: Solved and checked.
        solution: What the solver said last.
        solver: Its name.
    """
    points, tour_m = state.way.points, state.way.tour_m
    stretches = _stretches(state)
    after = np.minimum(tour_m.searchsorted(state.keypoint_m), len(tour_m) - 1)
    before = np.maximum(after - 1, 0)
    nearer = state.keypoint_m - tour_m[before] < tour_m[after] - state.keypoint_m
    return OptimisedPath(
        points=read_only(points),
        keypoint_index=np.where(nearer, before, after),
        cost=state.cost,
        iterations=solution.iterations,
        evaluations=solution.evaluations,
        solver=solver,
        repaired=tuple(stretch for stretch, free in stretches if free),
        colliding=tuple(stretch for stretch, free in stretches if not free),
    )


def _stretches(state: State) -> list[tuple[Stretch, bool]]:
    """Returns what was mended, and whether it passes now."""
    if not state.mended:
        return []
    ends = np.array([(m.start_m, m.end_m) for m in state.mended])
    arc_m = np.interp(ends, state.way.tour_m, arc_lengths(state.way.points)).tolist()
    after = (state.keypoint_m.searchsorted(ends[:, 0], side="right") - 1).tolist()
    before = state.keypoint_m.searchsorted(ends[:, 1]).tolist()
    return [
        (Stretch(start_m=a, end_m=b, after_keypoint=low, before_keypoint=high, how=m.how), m.free)
        for m, (a, b), low, high in zip(state.mended, arc_m, after, before, strict=True)
    ]
