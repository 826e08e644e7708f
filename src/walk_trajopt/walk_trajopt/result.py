# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From a state to the path that is handed out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from walk_trajopt.path import OptimisedPath, Stretch, read_only
from walk_trajopt.polyline import arc_lengths
from walk_trajopt.repair import Mended
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
    arc = arc_lengths(points)
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
        repaired=tuple(_stretch(m, state, arc) for m in state.mended if m.free),
        colliding=tuple(_stretch(m, state, arc) for m in state.mended if not m.free),
    )


def _stretch(mended: Mended, state: State, arc_m: NDArray[np.float64]) -> Stretch:
    start, end = np.interp([mended.start_m, mended.end_m], state.way.tour_m, arc_m)
    return Stretch(
        start_m=float(start),
        end_m=float(end),
        after_keypoint=int(np.searchsorted(state.keypoint_m, mended.start_m, side="right")) - 1,
        before_keypoint=int(np.searchsorted(state.keypoint_m, mended.end_m, side="left")),
        how=mended.how,
    )
