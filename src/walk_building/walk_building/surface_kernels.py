# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Compiled look-ups on the walkable surface."""

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray

FIT_RADIUS_M = 0.3  # about a tread: enough for a plane through a stair, too little to round off a landing
NEAREST_RADIUS_M = 1.0


class Grid(NamedTuple):
    """Places by column: those of (i, j) are `start[i * ny + j] : start[i * ny + j + 1]`."""

    origin_x: float
    origin_y: float
    cell: float
    nx: int
    ny: int
    start: NDArray[np.int64]
    places: NDArray[np.float64]


@numba.njit(cache=True, nogil=True)
def place_in_column(grid, i, j, z, tolerance):
    """Place of column (i, j) whose height is nearest to z and within the tolerance, -1 for none."""
    if i < 0 or j < 0 or i >= grid.nx or j >= grid.ny:
        return -1
    best, best_gap = -1, tolerance
    c = i * grid.ny + j
    for p in range(grid.start[c], grid.start[c + 1]):
        gap = abs(grid.places[p, 2] - z)
        if gap <= best_gap:
            best, best_gap = p, gap
    return best


@numba.njit(cache=True, nogil=True)
def link(grid, step, indptr, neighbours):
    """Writes each place's neighbours, at most one in each of the eight columns around it; returns how many in all.

    Two places are neighbours if each is the other's nearest in height, so the relation is symmetric.
    """
    n = 0
    for c in range(grid.nx * grid.ny):
        i, j = c // grid.ny, c % grid.ny
        for p in range(grid.start[c], grid.start[c + 1]):
            indptr[p] = n
            for k in range(9):
                if k == 4:
                    continue
                q = place_in_column(grid, i + k // 3 - 1, j + k % 3 - 1, grid.places[p, 2], step)
                if q >= 0 and place_in_column(grid, i, j, grid.places[q, 2], step) == p:
                    neighbours[n] = q
                    n += 1
    indptr[len(grid.places)] = n
    return n


@numba.njit(cache=True, nogil=True)
def edge_lengths(indptr, neighbours, places):
    """Straight distance from each place to each of its neighbours (E,); in a loop, to need no memory but the result."""
    length = np.empty(len(neighbours))
    for p in range(len(places)):
        for e in range(indptr[p], indptr[p + 1]):
            q = neighbours[e]
            dx, dy, dz = places[q, 0] - places[p, 0], places[q, 1] - places[p, 1], places[q, 2] - places[p, 2]
            length[e] = np.sqrt(dx * dx + dy * dy + dz * dz)
    return length


@numba.njit(cache=True, nogil=True)
def floor_planes(grid, eyes, eye_height, reach, out):
    """Fits a plane to the places around each eye; see WalkableSurface.floor_plane."""
    for n in range(eyes.shape[0]):
        z = eyes[n, 2] - eye_height
        out[n, 0], out[n, 1], out[n, 2] = _fit_plane(grid, eyes[n, 0], eyes[n, 1], z, reach)
        if np.isnan(out[n, 0]):
            p = nearest_place(grid, eyes[n, 0], eyes[n, 1], z, reach, NEAREST_RADIUS_M)
            if p >= 0:
                out[n, 0], out[n, 1], out[n, 2] = grid.places[p, 2], 0.0, 0.0


@numba.njit(cache=True, nogil=True)
def _fit_plane(grid, x, y, z, reach):
    """Returns height and slopes of the plane through the floor around a point, by weighted least squares; nan: none."""
    i0, j0 = (x - grid.origin_x) / grid.cell, (y - grid.origin_y) / grid.cell
    r = FIT_RADIUS_M / grid.cell
    # Sums of weight, and of weight times u, v, uu, uv, vv, h, uh, vh; u, v, h are offsets from the point.
    w, wu, wv, wuu, wuv, wvv, wh, wuh, wvh = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(int(np.ceil(i0 - r)), int(np.floor(i0 + r)) + 1):
        for j in range(int(np.ceil(j0 - r)), int(np.floor(j0 + r)) + 1):
            square = ((i - i0) ** 2 + (j - j0) ** 2) / (r * r)
            if square >= 1.0:
                continue
            p = place_in_column(grid, i, j, z, reach)
            if p < 0:
                continue
            # A weight that ends with zero value and slope at the rim keeps the height smooth along a path.
            weight = (1.0 - square) ** 2
            u, v, h = grid.places[p, 0] - x, grid.places[p, 1] - y, grid.places[p, 2] - z
            w, wu, wv, wh = w + weight, wu + weight * u, wv + weight * v, wh + weight * h
            wuu, wuv, wvv = wuu + weight * u * u, wuv + weight * u * v, wvv + weight * v * v
            wuh, wvh = wuh + weight * u * h, wvh + weight * v * h
    if w <= 0.0:
        return np.nan, 0.0, 0.0
    # A little damping of the slopes, in units of the weights, decides for level where the places are in a line.
    damping = w * (0.1 * grid.cell) ** 2
    # Positive definite: elimination needs no choice of rows.
    uu, uv, uh = wuu + damping - wu * wu / w, wuv - wu * wv / w, wuh - wu * wh / w
    vv, vh = wvv + damping - wv * wv / w - uv * uv / uu, wvh - wv * wh / w - uv * uh / uu
    along_y = vh / vv
    along_x = (uh - uv * along_y) / uu
    return z + (wh - wu * along_x - wv * along_y) / w, along_x, along_y


@numba.njit(cache=True, nogil=True)
def nearest_place(grid, x, y, z, reach, radius):
    """Place nearest to (x, y) within the radius whose height is within `reach` of z, -1 for none."""
    i0, j0 = (x - grid.origin_x) / grid.cell, (y - grid.origin_y) / grid.cell
    r = radius / grid.cell
    best, best_sq = -1, r * r
    for i in range(int(np.ceil(i0 - r)), int(np.floor(i0 + r)) + 1):
        for j in range(int(np.ceil(j0 - r)), int(np.floor(j0 + r)) + 1):
            sq = (i - i0) ** 2 + (j - j0) ** 2
            if sq <= best_sq:
                p = place_in_column(grid, i, j, z, reach)
                if p >= 0:
                    best, best_sq = p, sq
    return best


@numba.njit(cache=True, nogil=True)
def nearest_places(grid, points, radius, out):
    """Writes the place nearest in space to each point (N, 3), -1 where there is none within the radius."""
    for n in range(len(points)):
        out[n] = _nearest_in_space(grid, points[n, 0], points[n, 1], points[n, 2], radius)


@numba.njit(cache=True, nogil=True)
def _nearest_in_space(grid, x, y, z, radius):
    u, v, reach = (x - grid.origin_x) / grid.cell, (y - grid.origin_y) / grid.cell, radius / grid.cell
    # Also because a column's number has to be one that an integer holds.
    if not (-reach <= u <= grid.nx + reach and -reach <= v <= grid.ny + reach):
        return -1
    i0, j0 = int(np.rint(u)), int(np.rint(v))
    best, best_sq = -1, radius * radius
    for ring in range(int(np.ceil(reach)) + 1):
        # No column of this ring, or of one farther out, is nearer than half a cell less.
        if ring > 0 and ((ring - 0.5) * grid.cell) ** 2 > best_sq:
            break
        for i in range(max(i0 - ring, 0), min(i0 + ring + 1, grid.nx)):
            # Between its first and its last row, a ring has two columns in a row.
            stride = 1 if abs(i - i0) == ring else 2 * ring
            for j in range(j0 - ring, j0 + ring + 1, stride):
                if j < 0 or j >= grid.ny:
                    continue
                c = i * grid.ny + j
                for p in range(grid.start[c], grid.start[c + 1]):
                    dx, dy, dz = grid.places[p, 0] - x, grid.places[p, 1] - y, grid.places[p, 2] - z
                    square = dx * dx + dy * dy + dz * dz
                    if square < best_sq:
                        best, best_sq = p, square
    return best


@numba.njit(cache=True, nogil=True)
def segment_walkable(grid, mask, start, end, step):
    """Whether the straight line between two places crosses only squares with four standable corners.

    The squares lie between four columns each. The line is followed from crossing to crossing; the height is
    carried on from corner to corner, so a line never jumps between storeys.
    """
    ax, ay = (grid.places[start, 0] - grid.origin_x) / grid.cell, (grid.places[start, 1] - grid.origin_y) / grid.cell
    bx, by = (grid.places[end, 0] - grid.origin_x) / grid.cell, (grid.places[end, 1] - grid.origin_y) / grid.cell
    steps = int(np.ceil(max(abs(bx - ax), abs(by - ay)) * 4.0))
    z = grid.places[start, 2]
    if not (mask[start] and mask[end]):
        return False
    for s in range(steps + 1):
        t = s / steps if steps > 0 else 0.0
        x, y = ax + t * (bx - ax), ay + t * (by - ay)
        i, j = int(np.floor(x + 1e-9)), int(np.floor(y + 1e-9))
        total, n = 0.0, 0
        for k in range(4):
            ci, cj = i + k // 2, j + k % 2
            # On a side of the square only that side's two corners count: lines along a row of places have two.
            if abs(ci - x) >= 1.0 - 1e-9 or abs(cj - y) >= 1.0 - 1e-9:
                continue
            p = place_in_column(grid, ci, cj, z, step)
            if p < 0 or not mask[p]:
                return False
            total += grid.places[p, 2]
            n += 1
        if n > 0:
            z = total / n
    return abs(z - grid.places[end, 2]) <= step
