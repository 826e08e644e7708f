# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The clearance's pieces in compiled code: what is near each point, and what would be near if it gave way."""

from __future__ import annotations

import numba
import numpy as np

from walk_building.body import axis_distance_sq
from walk_building.bvh import closest_point

# How much farther than the wish a free point looks, so that it need not look again until it has come this much nearer.
_AHEAD_M = 0.25
_BEYOND_M = 0.05  # the same for a single height, where there is much within it already
_ROUNDING_M = 1e-9
_SAME_M = 1e-3  # less than this inside the wish is not worth a piece
_PARALLEL = 0.999  # cosine above which two witnesses lie in one direction


@numba.njit(cache=True, nogil=True)
def write_clearance(bvh, x, below, wish, far, known, values, slopes):
    """Writes the pieces of each point: none at all where nothing is near, else 0 and one for each witness.

    A witness c, any point of the geometry, says that the shortfall is at least D − |q − c|; the nearest says what it
    is. From each height of the body the nearest is asked for, and once more from where that one would push the body to.

    Args:
        bvh: The triangles.
        x: (n, 3) eye positions.
        below: (K,) heights of the looked-at points of the axis relative to the eye, rising.
        wish: (K,) D of each.
        far: (n, 4) in and out: a place and how far from it the geometry is at least; carried on between calls.
        known: (n, 2 K, 8) in and out: a place for each witness, how far from it the geometry is at least, and at
            most, and the closest point; carried on between calls.
        values: (n, 2 K + 1) out.
        slopes: (n, 2 K + 1, 3) out.
    """
    largest = wish.max()
    for i in range(len(x)):
        values[i] = -np.inf
        if not _near(bvh, x[i], below, largest, far[i], known[i]):
            continue
        for k in range(len(below)):
            if _write_nearest(bvh, x[i], below[k], wish[k], 2 * k + 1, known[i, 2 * k], values[i], slopes[i]):
                _write_next(bvh, x[i], below[k], wish[k], 2 * k + 1, known[i, 2 * k + 1], values[i], slopes[i])
        if values[i].max() > -np.inf:
            values[i, 0] = 0.0
            slopes[i, 0] = 0.0


@numba.njit(cache=True, nogil=True)
def _near(bvh, eye, below, largest, far, known):
    moved = np.sqrt((eye[0] - far[0]) ** 2 + (eye[1] - far[1]) ** 2 + (eye[2] - far[2]) ** 2)
    if far[3] - moved >= largest:
        return False
    for k in range(len(below)):
        place = known[2 * k]
        moved = np.sqrt((eye[0] - place[0]) ** 2 + (eye[1] - place[1]) ** 2 + (eye[2] + below[k] - place[2]) ** 2)
        if place[4] + moved < largest:
            return True
    limit = (largest**2, (largest + _AHEAD_M) ** 2)
    square = axis_distance_sq(bvh, eye[0], eye[1], eye[2] + below[0], eye[2] + below[-1], limit)
    if square < limit[0]:
        return True
    far[:3] = eye
    far[3] = np.sqrt(square)
    return False


@numba.njit(cache=True, nogil=True)
def _closest(bvh, x, y, z, reach, known):
    """Returns the closest point within reach, its distance and whether there is one.

    Distances change by no more than the place that they are asked from moves: what is known from an earlier place
    says where there is nothing to ask, and how far to look.
    """
    moved = np.sqrt((x - known[0]) ** 2 + (y - known[1]) ** 2 + (z - known[2]) ** 2)
    if known[3] - moved >= reach:
        return 0.0, 0.0, 0.0, reach, False
    if moved == 0.0 and known[4] < reach:
        return known[5], known[6], known[7], known[4], True
    look = min(known[4] + moved + _ROUNDING_M, reach + _BEYOND_M)
    cx, cy, cz, square, face = closest_point(bvh, x, y, z, look)
    distance = np.sqrt(square)
    known[0], known[1], known[2], known[3] = x, y, z, distance
    known[4] = distance if face >= 0 else np.inf
    known[5], known[6], known[7] = cx, cy, cz
    return cx, cy, cz, distance, face >= 0 and distance < reach


@numba.njit(cache=True, nogil=True)
def _write_nearest(bvh, eye, below, wish, piece, known, values, slopes):
    """Writes the piece of the nearest witness seen from one height; returns whether it says anything new."""
    x, y, z = eye[0], eye[1], eye[2] + below
    cx, cy, cz, distance, found = _closest(bvh, x, y, z, wish, known)
    if not found:
        return False
    values[piece] = wish - distance
    slope = slopes[piece]
    if distance <= 1e-9:
        # On the geometry itself there is no direction away from it.
        slope[:] = 0.0
        return False
    slope[0], slope[1], slope[2] = (cx - x) / distance, (cy - y) / distance, (cz - z) / distance
    for j in range(1, piece, 2):
        same = slope[0] * slopes[j, 0] + slope[1] * slopes[j, 1] + slope[2] * slopes[j, 2]
        if values[j] >= values[piece] and same > _PARALLEL:
            # One wall seen from another height.
            values[piece] = -np.inf
            return False
    return True


@numba.njit(cache=True, nogil=True)
def _write_next(bvh, eye, below, wish, piece, known, values, slopes):
    """Writes behind a piece the one of the witness that is nearest where the first one would push the body to."""
    x, y, z = eye[0], eye[1], eye[2] + below
    push = values[piece]
    sx, sy, sz = slopes[piece]
    ox, oy, oz, _, found = _closest(bvh, x - push * sx, y - push * sy, z - push * sz, wish - _SAME_M, known)
    if not found:
        return
    away = np.sqrt((ox - x) ** 2 + (oy - y) ** 2 + (oz - z) ** 2)
    if away <= 1e-9 or (ox - x) * sx + (oy - y) * sy + (oz - z) * sz > _PARALLEL * away:
        return
    values[piece + 1] = wish - away
    slopes[piece + 1, 0], slopes[piece + 1, 1], slopes[piece + 1, 2] = (ox - x) / away, (oy - y) / away, (oz - z) / away
