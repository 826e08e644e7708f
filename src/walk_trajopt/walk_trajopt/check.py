# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The guarantee: the walker's body swept along every segment of a path against the exact geometry."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from walk_building.body import standing_clearances
from walk_building.geometry import Geometry
from walk_building.sweep import BodySweep
from walk_building.walker import Walker

_MARGIN_M = 0.01  # by which a segment must be clear to be passed without the sweep


class PathCheck:
    """Says which segments of a path the body passes. Not safe to share between threads.

    Most of a path is far from every wall. Where the body's exact distance from the geometry in the middle of a
    segment is more than half the segment's length, and a margin, the body passes; compiled code finds that out in a
    few microseconds. All other segments are swept (`walk_building.BodySweep`).
    """

    def __init__(self, geometry: Geometry, walker: Walker) -> None:
        self._geometry = geometry
        self._walker = walker
        self._sweep = BodySweep(geometry, walker)

    def segments_free(self, eye_path: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Returns for each segment of the eye path (n, 3) whether the body passes it, (n − 1,)."""
        if len(eye_path) < 2:
            return np.zeros(0, bool)
        free = self._clear(eye_path)
        near = np.flatnonzero(~free)
        # Neighbours are swept in one go: they share the clearance where they meet.
        for run in np.split(near, np.flatnonzero(np.diff(near) > 1) + 1):
            if len(run):
                free[run] = self._sweep.segments_free(eye_path[run[0] : run[-1] + 2])
        return free

    def _clear(self, eye_path: NDArray[np.float64]) -> NDArray[np.bool_]:
        walker = self._walker
        middle = 0.5 * (eye_path[1:] + eye_path[:-1])
        middle[:, 2] -= walker.eye_height_m
        needed = walker.radius_m + 0.5 * np.linalg.norm(np.diff(eye_path, axis=0), axis=1) + _MARGIN_M
        square = np.empty(len(middle))
        limit = (walker.radius_m**2, float(needed.max()) ** 2)
        standing_clearances(
            0, len(middle), self._geometry.bvh, middle, walker.axis_low_m, walker.axis_high_m, limit, square
        )
        return np.asarray(square >= needed**2)


def colliding_runs(free: NDArray[np.bool_], arc_m: NDArray[np.float64], gap_m: float) -> list[tuple[float, float]]:
    """Returns the intervals of arc length that are not free, those closer than `gap_m` joined.

    Args:
        free: (n − 1,) per segment.
        arc_m: (n,) at the points, rising.
        gap_m: Free pieces shorter than this do not part two intervals.
    """
    runs: list[tuple[float, float]] = []
    for i in np.flatnonzero(~free):
        start, end = float(arc_m[i]), float(arc_m[i + 1])
        if runs and start - runs[-1][1] < gap_m:
            runs[-1] = (runs[-1][0], end)
        else:
            runs.append((start, end))
    return runs
