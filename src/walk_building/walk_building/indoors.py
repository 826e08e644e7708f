# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Which places are indoors, and in which declared space. Our own.

In this order: inside a declared space, with the doorways between spaces; on storeys without spaces, under
something; and where a model has no ceilings at all, what its walls enclose.
"""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from walk_building.model import Space
from walk_building.raster import Columns, Hits, cast_columns

# Heights above the floor at which a place is looked up in the spaces: spaces may end above a raised floor or
# below a ceiling, and on stairs they often start at another level than the tread.
_PROBE_HEIGHTS_M = (1.0, 0.3, 1.6)
# The thickest wall a doorway between two spaces may go through.
DOORWAY_DEPTH_M = 0.8
# A model in which less than this share of the standable floor is under something has no ceilings.
_COVERED_SHARE = 0.1
# Openings up to twice this wide count as doors when looking at a model without ceilings from outside.
_DOOR_HALF_WIDTH_M = 0.9


def declared_space(
    columns: Columns, spaces: tuple[Space, ...], column: NDArray[np.int64], z: NDArray[np.float64]
) -> NDArray[np.int32]:
    """Returns the index of the space that each place is in, -1 for none.

    Args:
        columns: The grid.
        spaces: Closed meshes.
        column: (P,) flat column index of each place.
        z: (P,) its height [m].
    """
    if not spaces:
        return np.full(len(z), -1, np.int32)
    base = np.cumsum([0] + [len(s.vertices) for s in spaces])
    vertices = np.concatenate([s.vertices for s in spaces])
    faces = np.concatenate([s.faces + offset for s, offset in zip(spaces, base, strict=False)]).astype(np.int32)
    owner = np.repeat(np.arange(len(spaces)), [len(s.faces) for s in spaces]).astype(np.int32)
    hits = cast_columns(columns, vertices, faces)
    corners = vertices[faces]
    sign = np.sign(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]).astype(np.int8)
    found = np.full(len(z), -1, np.int32)
    for height in _PROBE_HEIGHTS_M:
        missing = np.flatnonzero(found < 0)
        found[missing] = _space_at(
            hits.start, hits.z, owner[hits.face], sign[hits.face], len(spaces), column[missing], z[missing] + height
        )
    return found


@numba.njit(cache=True, nogil=True)
def _space_at(start, hit_z, owner, sign, n_spaces, column, z):
    """Index of the space around each point: the one whose faces above it point up and down unequally often.

    The winding number along a ray, which unlike parity allows a space made of solids that touch.
    """
    found = np.full(len(z), -1, np.int32)
    last = np.full((n_spaces, 3), np.inf)
    winding = np.zeros(n_spaces, np.int64)
    for p in range(len(z)):
        begin, end = start[column[p]], start[column[p] + 1]
        first = end
        while first > begin and hit_z[first - 1] > z[p]:
            first -= 1
            s, up = owner[first], sign[first]
            # A line through an edge meets both faces beside it at one height; that is one crossing.
            if abs(last[s, up + 1] - hit_z[first]) > 1e-6:
                winding[s] += up
            last[s, up + 1] = hit_z[first]
        for k in range(first, end):
            if winding[owner[k]] != 0 and found[p] < 0:
                found[p] = owner[k]
        for k in range(first, end):
            winding[owner[k]] = 0
            last[owner[k]] = np.inf
    return found


def covered(hits: Hits, column: NDArray[np.int64], z: NDArray[np.float64], height_m: float) -> NDArray[np.bool_]:
    """Returns whether anything lies more than a body's height above each place."""
    top = np.full(len(hits.start) - 1, -np.inf)
    occupied = np.diff(hits.start) > 0
    top[occupied] = hits.z[hits.start[1:][occupied] - 1]
    return np.asarray(top[column] > z + height_m)


def has_ceilings(is_covered: NDArray[np.bool_]) -> bool:
    """Returns whether enough of the floor is under something for 'under something' to mean indoors."""
    return bool(is_covered.mean() >= _COVERED_SHARE) if len(is_covered) else False


def enclosed(columns: Columns, column: NDArray[np.int64], walls: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Returns whether each place is within the walls, as a flood from outside that passes no door sees it.

    Args:
        columns: The grid.
        column: (P,) column of each place.
        walls: (columns,) whether a body's height of wall stands in the column.
    """
    solid = np.pad(walls.reshape(columns.shape), 1)
    radius = _DOOR_HALF_WIDTH_M / columns.cell_m
    pad = int(np.ceil(radius)) + 2
    away = ndimage.distance_transform_edt(~np.pad(solid, pad))
    labels, _ = ndimage.label(away > radius)
    core = labels == labels[0, 0]
    # The flooded cores grow back by the half width they kept from the walls, but not through them.
    outside = ndimage.distance_transform_edt(~core) <= radius + 1.0
    shape = columns.shape
    inner = outside[pad + 1 : pad + 1 + shape[0], pad + 1 : pad + 1 + shape[1]]
    return np.asarray(~inner.reshape(-1)[column])


@numba.njit(cache=True, nogil=True)
def close_gaps(indptr, neighbours, places, inside, reach):
    """Adds to `inside` the places between insides: those within `reach` of it that the outside does not come near.

    A morphological closing along the surface: what the doorway of an outer door adds is taken away again.
    """
    near_inside = surface_distance(indptr, neighbours, places, inside) <= reach
    far_outside = surface_distance(indptr, neighbours, places, ~near_inside) > reach
    return inside | (near_inside & far_outside)


@numba.njit(cache=True, nogil=True)
def surface_distance(indptr, neighbours, places, source):
    """Horizontal distance along the surface to the nearest place of `source`, inf where none can be reached.

    Each place keeps the source it was reached from, as in a vector distance transform: sweeps in the order of the
    places and back, until nothing changes. Exact where the straight line to the source stays on the surface.
    """
    n = len(source)
    distance = np.full(n, np.inf)
    origin = np.full(n, -1, np.int64)
    for p in range(n):
        if source[p]:
            distance[p] = 0.0
            origin[p] = p
    changed = True
    while changed:
        changed = False
        for sweep in range(2):
            for k in range(n):
                p = k if sweep == 0 else n - 1 - k
                for e in range(indptr[p], indptr[p + 1]):
                    o = origin[neighbours[e]]
                    if o < 0 or o == origin[p]:
                        continue
                    d = np.hypot(places[p, 0] - places[o, 0], places[p, 1] - places[o, 1])
                    # The slack ends the sweeps where two sources are equally far.
                    if d < distance[p] - 1e-9:
                        distance[p] = d
                        origin[p] = o
                        changed = True
    return distance
