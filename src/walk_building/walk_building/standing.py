# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From triangles to places: upward faces with room for a body above them, and the steps between them."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from walk_building.body import standing_clearances
from walk_building.geometry import Geometry, in_chunks
from walk_building.raster import Columns, Hits
from walk_building.surface_kernels import Grid, link
from walk_building.walker import Walker

# A body that moves straight between two free places 0.1 m apart comes up to 5 mm nearer to a corner than at either.
MARGIN_M = 0.006


def standing_places(
    geometry: Geometry, walker: Walker, columns: Columns, hits: Hits
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Returns the floor points where the walker's body fits, and where each column's begin.

    A face counts as floor whichever way its normal points: mesh formats do not agree on it.

    Returns:
        places: (P, 3), ordered by column, then height.
        column_start: (columns + 1,).
    """
    corners = geometry.vertices[geometry.faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normal, axis=1)
    flat = np.abs(normal[:, 2]) >= np.cos(np.radians(walker.max_slope_deg)) * length
    column, z = _floors(hits.start, hits.z, flat[hits.face], walker.step_m, walker.height_m)
    i, j = np.divmod(column, columns.shape[1])
    floor = np.column_stack([columns.origin[0] + i * columns.cell_m, columns.origin[1] + j * columns.cell_m, z])
    free = body_fits(geometry, walker, floor, MARGIN_M)
    start = np.zeros(columns.count + 1, np.int64)
    np.cumsum(np.bincount(column[free], minlength=columns.count), out=start[1:])
    return np.ascontiguousarray(floor[free]), start


def body_fits(
    geometry: Geometry, walker: Walker, floor: NDArray[np.float64], margin_m: float = 0.0
) -> NDArray[np.bool_]:
    """Returns whether the walker's body, larger by a margin, is free above each floor point (N, 3)."""
    reach_sq = (walker.radius_m + margin_m) ** 2
    out = np.empty(len(floor))
    in_chunks(
        standing_clearances,
        len(floor),
        geometry.bvh,
        np.ascontiguousarray(floor),
        walker.axis_low_m,
        walker.axis_high_m,
        (reach_sq, reach_sq * 1.0001),
        out,
    )
    return out >= reach_sq


def neighbour_graph(grid: Grid, step_m: float) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
    """Returns the neighbour lists of all places as (indptr, neighbours)."""
    indptr = np.empty(len(grid.places) + 1, np.int64)
    neighbours = np.empty(8 * len(grid.places), np.int32)
    n = link(grid, step_m, indptr, neighbours)
    return indptr, neighbours[:n].copy()


@numba.njit(cache=True, nogil=True)
def _floors(start, z, flat, step, height):
    """Columns and heights of the hits to stand on: flat, with head-room, none to step up to."""
    column = np.empty(len(z), np.int64)
    level = np.empty(len(z))
    n = 0
    for c in range(len(start) - 1):
        for k in range(start[c], start[c + 1]):
            if not flat[k]:
                continue
            free = True
            m = k + 1
            while free and m < start[c + 1] and z[m] - z[k] < height:
                gap = z[m] - z[k]
                # Of faces less than a step apart, such as a carpet on a slab, the upper one is stood on.
                free = gap <= step and not flat[m]
                m += 1
            if free:
                column[n] = c
                level[n] = z[k]
                n += 1
    return column[:n].copy(), level[:n].copy()
