# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The guarantee: the walker's body swept along every segment of a path against the exact geometry."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from walk_building.body import axis_distance_sq
from walk_building.geometry import Geometry
from walk_building.sweep import BodySweep
from walk_building.walker import Walker

# A segment on which the body keeps so far from everything is passed without the library's sweep. Both compute exact
# distances; a margin far above their rounding keeps them from differing about contact.
_MARGIN_M = 0.002


class PathCheck:
    """Says which segments of a path the body passes. Not safe to share between threads.

    The same sweep twice: in compiled code, which knows the exact distance between the body's axis and the triangles,
    and by `walk_building.BodySweep` for each segment on which the body comes nearer than a margin to anything.
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
        clear = np.empty(len(eye_path) - 1, np.bool_)
        low, high = walker.axis_low_m - walker.eye_height_m, walker.axis_high_m - walker.eye_height_m
        _sweep(self._geometry.bvh, np.ascontiguousarray(eye_path), low, high, walker.radius_m, _MARGIN_M, clear)
        return clear


@numba.njit(cache=True, nogil=True)
def _sweep(bvh, eyes, low, high, radius, margin, clear):
    """Writes for each segment whether the body stays farther than the margin from all triangles where it is asked.

    Conservative advancement: a body that is c away from everything may move on by c.
    """
    for i in range(len(clear)):
        move = eyes[i + 1] - eyes[i]
        length = np.sqrt(move[0] ** 2 + move[1] ** 2 + move[2] ** 2)
        # What is farther than the segment is long matters to nobody.
        limit = ((radius + margin) ** 2, (radius + margin + length) ** 2)
        at = 0.0
        clear[i] = False
        while True:
            share = at / length if length > 0.0 else 0.0
            x, y, z = eyes[i, 0] + share * move[0], eyes[i, 1] + share * move[1], eyes[i, 2] + share * move[2]
            square = axis_distance_sq(bvh, x, y, z + low, z + high, limit)
            if square <= limit[0]:
                break
            at += np.sqrt(square) - radius
            if at >= length:
                clear[i] = True
                break


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
