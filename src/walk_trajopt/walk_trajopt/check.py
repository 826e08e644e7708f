# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The guarantee: the walker's body swept along a path against the exact geometry, by steps it can take."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from walk_building.body import axis_distance_sq
from walk_building.bvh import first_hit
from walk_building.geometry import Geometry
from walk_building.surface import WalkableSurface
from walk_building.surface_kernels import place_in_column
from walk_building.sweep import CONTACT_M
from walk_building.walker import Walker

# Added to what counts as touching: it bounds the number of steps along a wall that is just not touched. Far above the
# rounding of the exact distances, it keeps this sweep the stricter of the two wherever the library's differ from them.
_MARGIN_M = 1e-4
_ROUNDING_M = 1e-9
_AHEAD_M = 0.4  # how far ahead is looked at least: fewer questions, each a little longer
_STRIDE_M = 0.1  # the floor is looked at so often along a path; a tread is no shorter
_LEDGE_M = 0.02  # a step may be so much higher: places stand for the floor about them


class PathCheck:
    """Says which segments of a path the body passes, by the exact distance between the body's axis and the triangles.

    With the surface also whether a walker could: off the side of a ramp the body meets nothing and yet nobody goes.

    In compiled code and a little stricter than `walk_building.BodySweep`, which the tests hold it to. What one sweep
    has found out about the room around a path spares the next one, of a path near by, most of its questions; the
    answers are the same. Not safe to share between threads.
    """

    def __init__(self, geometry: Geometry, walker: Walker, surface: WalkableSurface | None = None) -> None:
        self._geometry = geometry
        self._walker = walker
        self._surface = surface
        self._balls = np.empty((0, 4))

    def segments_free(self, eye_path: NDArray[np.float64], *, remember: bool = False) -> NDArray[np.bool_]:
        """Returns for each segment of the eye path (n, 3) whether the body passes it, (n − 1,).

        Args:
            eye_path: What to sweep the body along [m].
            remember: Another path near by will be asked for next.
        """
        free = np.ones(max(len(eye_path) - 1, 0), np.bool_)
        if len(free):
            walker = self._walker
            low, high = walker.axis_low_m - walker.eye_height_m, walker.axis_high_m - walker.eye_height_m
            contact = walker.radius_m + CONTACT_M
            eyes = np.ascontiguousarray(eye_path)
            balls = _sweep(self._geometry.bvh, eyes, (low, high), contact, free, self._balls)
            self._balls = balls if remember else self._balls
            if self._surface is not None:
                limit = self._surface.step_m + _LEDGE_M
                _step(self._surface.grid, self._geometry.bvh, eyes, walker.eye_height_m, limit, free)
        return free


@numba.njit(cache=True, nogil=True)
def _sweep(bvh, eyes, ends, contact, free, balls):
    """Writes for each segment whether the body's axis stays farther than `contact` from all triangles.

    Conservative advancement: an axis that is c farther than that from everything may move on by c, over as many
    segments as that reaches.

    Args:
        bvh: The triangles.
        eyes: (n, 3) the path.
        ends: Heights of the axis' ends relative to the eye.
        contact: What counts as touching.
        free: (n - 1,) out.
        balls: (k, 4) eye positions and radii within which an eye is known to be free, in the order of a path near by.

    Returns:
        The balls (m, 4) that were found or of use this time, in the order of this path.
    """
    low, high = ends
    found, used = np.empty((len(free), 4)), 0
    nearest = _nearest_ball(balls, eyes[0])
    at_x, at_y, at_z, known = 0.0, 0.0, 0.0, np.inf  # where was asked last, and how far everything is from there
    for i in range(len(free)):
        free[i] = True
        if used > 0 and _covers(found[used - 1], eyes[i], eyes[i + 1]):
            continue
        while nearest + 1 < len(balls) and _apart(balls[nearest + 1], eyes[i]) < _apart(balls[nearest], eyes[i]):
            nearest += 1
        covered = False
        for k in range(max(nearest - 1, 0), min(nearest + 2, len(balls))):
            if _covers(balls[k], eyes[i], eyes[i + 1]):
                found[used] = balls[k]
                used += 1
                covered = True
                break
        if covered:
            continue
        move, length = eyes[i + 1] - eyes[i], _apart(eyes[i], eyes[i + 1])
        limit = (contact + _MARGIN_M) ** 2, (contact + max(length, _AHEAD_M) + _MARGIN_M) ** 2
        at = 0.0
        while True:
            share = at / length if length > 0.0 else 0.0
            x, y, z = eyes[i, 0] + share * move[0], eyes[i, 1] + share * move[1], eyes[i, 2] + share * move[2]
            # A distance changes by no more than the axis moves: farther there is nothing to look for.
            moved = np.sqrt((x - at_x) ** 2 + (y - at_y) ** 2 + (z - at_z) ** 2)
            most = min(limit[1], (known + moved + _ROUNDING_M) ** 2)
            square = axis_distance_sq(bvh, x, y, z + low, z + high, (limit[0], most))
            at_x, at_y, at_z, known = x, y, z, np.sqrt(square) if square < limit[1] else np.inf
            if square <= limit[0]:
                free[i] = False
                break
            ahead = np.sqrt(square) - contact
            if at == 0.0:
                found[used, :3] = eyes[i]
                found[used, 3] = ahead - _MARGIN_M
                used += 1
            at += ahead
            if at >= length:
                break
    return found[:used].copy()


@numba.njit(cache=True, nogil=True)
def _step(grid, bvh, eyes, eye_height, limit, free):
    """Clears `free` for each segment of the eye path (n, 3) on which the floor rises or falls by more than a limit."""
    before = _floor(grid, bvh, eyes[0], eye_height, limit)
    at = np.empty(3)
    for i in range(len(free)):
        parts = max(int(np.ceil(_apart(eyes[i], eyes[i + 1]) / _STRIDE_M)), 1)
        for k in range(1, parts + 1):
            at[:] = eyes[i] + (eyes[i + 1] - eyes[i]) * (k / parts)
            floor = _floor(grid, bvh, at, eye_height, limit)
            free[i] &= abs(floor - before) <= limit
            before = floor


@numba.njit(cache=True, nogil=True)
def _floor(grid, bvh, eye, eye_height, limit):
    """Height of the floor that a walker stands on here: of a place around, else of what is right below the eye."""
    z = eye[2] - eye_height
    i, j = int(np.floor((eye[0] - grid.origin_x) / grid.cell)), int(np.floor((eye[1] - grid.origin_y) / grid.cell))
    best, off = 0.0, np.inf
    for di in range(2):
        for dj in range(2):
            p = place_in_column(grid, i + di, j + dj, z, 2.0 * limit)
            if p >= 0 and abs(grid.places[p, 2] - z) < off:
                best, off = grid.places[p, 2], abs(grid.places[p, 2] - z)
    if off < np.inf:
        return best
    t, _ = first_hit(bvh, eye[0], eye[1], eye[2], 0.0, 0.0, -1.0, np.inf)
    return eye[2] - t


@numba.njit(cache=True, nogil=True)
def _covers(ball, a, b):
    """Returns whether a segment, like both its ends, lies within a ball (x, y, z, radius)."""
    return max(_apart(ball, a), _apart(ball, b)) <= ball[3]


@numba.njit(cache=True, nogil=True)
def _nearest_ball(balls, eye):
    nearest, apart = 0, np.inf
    for k in range(len(balls)):
        here = _apart(balls[k], eye)
        if here < apart:
            nearest, apart = k, here
    return nearest


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
    if free.all():
        return runs
    for i in np.flatnonzero(~free):
        start, end = float(arc_m[i]), float(arc_m[i + 1])
        if runs and start - runs[-1][1] < gap_m:
            runs[-1] = (runs[-1][0], end)
        else:
            runs.append((start, end))
    return runs
