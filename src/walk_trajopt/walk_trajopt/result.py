# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From a state to the path that is handed out."""

from __future__ import annotations

import numba
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
    return OptimisedPath(
        points=read_only(points),
        keypoint_index=_nearest_each(tour_m, state.keypoint_m),
        cost=state.cost,
        iterations=solution.iterations,
        evaluations=solution.evaluations,
        solver=solver,
        repaired=tuple(stretch for stretch, free in stretches if free),
        colliding=tuple(stretch for stretch, free in stretches if not free),
    )


@numba.njit(cache=True, nogil=True)
def _nearest_each(rising, wanted):
    """Returns for each of `wanted` (M,) the index of the nearest of rising numbers (n,)."""
    out = np.empty(len(wanted), np.int64)
    for k in range(len(wanted)):
        after = min(np.searchsorted(rising, wanted[k]), len(rising) - 1)
        before = max(after - 1, 0)
        out[k] = before if wanted[k] - rising[before] < rising[after] - wanted[k] else after
    return out


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
