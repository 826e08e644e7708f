# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The guarantee: the walker's body swept along every segment of a path against the exact geometry."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from walk_building.body import axis_distance_sq
from walk_building.geometry import Geometry
from walk_building.sweep import CONTACT_M, BodySweep
from walk_building.walker import Walker

# The library's distances were found to be up to 0.06 mm above the exact ones, never below. Only where the two could
# differ about contact is it asked.
_DOUBT_M = 2e-4

_AHEAD_M = 0.4  # how far ahead is looked at least: fewer questions, each a little longer

_HITS, _ASKS, _PASSES = 0, 1, 2


class PathCheck:
    """Says which segments of a path the body passes. Not safe to share between threads.

    In compiled code, which knows the exact distance between the body's axis and the triangles, and by
    `walk_building.BodySweep` for each segment on which the nearest that the body comes to anything is contact, give or
    take a fraction of a millimetre.
    """

    def __init__(self, geometry: Geometry, walker: Walker) -> None:
        self._geometry = geometry
        self._walker = walker
        self._sweep = BodySweep(geometry, walker)

    def segments_free(self, eye_path: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Returns for each segment of the eye path (n, 3) whether the body passes it, (n − 1,)."""
        if len(eye_path) < 2:
            return np.zeros(0, bool)
        found = self._swept(eye_path)
        free = found == _PASSES
        doubtful = np.flatnonzero(found == _ASKS)
        # Neighbours are swept in one go: they share the clearance where they meet.
        for run in np.split(doubtful, np.flatnonzero(np.diff(doubtful) > 1) + 1):
            if len(run):
                free[run] = self._sweep.segments_free(eye_path[run[0] : run[-1] + 2])
        return np.asarray(free)

    def _swept(self, eye_path: NDArray[np.float64]) -> NDArray[np.int64]:
        walker = self._walker
        found = np.empty(len(eye_path) - 1, np.int64)
        low, high = walker.axis_low_m - walker.eye_height_m, walker.axis_high_m - walker.eye_height_m
        touching, clear = walker.radius_m + CONTACT_M - _DOUBT_M, walker.radius_m + CONTACT_M + _DOUBT_M
        _sweep(self._geometry.bvh, np.ascontiguousarray(eye_path), low, high, touching, clear, found)
        return found


@numba.njit(cache=True, nogil=True)
def _sweep(bvh, eyes, low, high, touching, clear, found):
    """Writes for each segment whether the body's axis comes nearer than `touching` to a triangle, or than `clear`.

    Conservative advancement: an axis that is c farther than `clear` from everything may move on by c, over as many
    segments as that reaches.
    """
    anchor, reach = eyes[0], -1.0
    for i in range(len(found)):
        if max(_apart(anchor, eyes[i]), _apart(anchor, eyes[i + 1])) <= reach:
            found[i] = _PASSES
            continue
        move = eyes[i + 1] - eyes[i]
        length = np.sqrt(move[0] ** 2 + move[1] ** 2 + move[2] ** 2)
        limit = (touching**2, (clear + max(length, _AHEAD_M) + _DOUBT_M) ** 2)
        at = 0.0
        found[i] = _PASSES
        while at < length or at == 0.0:
            share = at / length if length > 0.0 else 0.0
            x, y, z = eyes[i, 0] + share * move[0], eyes[i, 1] + share * move[1], eyes[i, 2] + share * move[2]
            distance = np.sqrt(axis_distance_sq(bvh, x, y, z + low, z + high, limit))
            if at == 0.0:
                anchor, reach = eyes[i], distance - clear
            if distance <= clear:
                found[i] = _HITS if distance < touching else _ASKS
            if distance < touching:
                break
            # In doubt it goes on, in steps of the doubt itself: there may be a hit ahead.
            at += max(distance - clear, clear - touching)


@numba.njit(cache=True, nogil=True)
def _apart(a, b):
    return np.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)


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
