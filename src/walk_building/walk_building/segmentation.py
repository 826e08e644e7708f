# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Rooms where the file declares none: the surface is cut at its doorway-wide necks. Our own."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

# Half the free width of the widest doorway, measured where the body's axis can be: a gap of 1.4 m leaves the axis
# of a body of 0.25 m radius 0.9 m, that is 0.45 m to each side.
DOORWAY_HALF_WIDTH_M = 0.70
# A room is wider than the neck that leads into it by at least this, or it is a bend of a corridor.
_WIDER_THAN_NECK_M = 0.15
# Less floor than this, seen where the body's axis can be, is a niche of the room beside it.
_MIN_ROOM_AREA_M2 = 1.5


def segment_rooms(
    indptr: NDArray[np.int64],
    neighbours: NDArray[np.int32],
    clearance_m: NDArray[np.float64],
    mask: NDArray[np.bool_],
    *,
    level: NDArray[np.int32],
    radius_m: float,
    place_area_m2: float,
) -> NDArray[np.int32]:
    """Returns a room label for each place of `mask`, -1 elsewhere; labels count from 0.

    A watershed on the clearance: places are taken from the widest to the narrowest, each joins the basin of the
    neighbours taken before it, and where two basins meet they become one room unless the neck between them is
    narrow as a doorway and both are wider than it.

    Args:
        indptr: (P + 1,) neighbour lists.
        neighbours: (E,).
        clearance_m: (P,) distance along the surface to where standing ends.
        mask: (P,) the places to divide.
        level: (P,) storey of each place; no room reaches over two.
        radius_m: The body's radius.
        place_area_m2: What a place stands for.
    """
    order = np.flatnonzero(mask)
    order = order[np.argsort(-clearance_m[order], kind="stable")]
    min_places = int(np.ceil(_MIN_ROOM_AREA_M2 / place_area_m2))
    root = _watershed(
        indptr, neighbours, clearance_m, level, order, DOORWAY_HALF_WIDTH_M - radius_m, _WIDER_THAN_NECK_M, min_places
    )
    label = np.full(len(mask), -1, np.int32)
    label[order] = np.unique(root[order], return_inverse=True)[1]
    return label


@numba.njit(cache=True, nogil=True)
def _find(parent, p):
    while parent[p] != p:
        parent[p] = parent[parent[p]]
        p = parent[p]
    return p


@numba.njit(cache=True, nogil=True)
def _watershed(indptr, neighbours, clearance, level, order, neck, wider, min_places):
    """Union-find over the places from wide to narrow; see segment_rooms. Returns each place's room."""
    n = len(clearance)
    parent = np.full(n, -1, np.int64)
    size = np.zeros(n, np.int64)
    peak = np.zeros(n)
    for p in order:
        parent[p] = p
        size[p] = 1
        peak[p] = clearance[p]
        best = -1
        for e in range(indptr[p], indptr[p + 1]):
            q = neighbours[e]
            if parent[q] >= 0 and level[q] == level[p] and (best < 0 or clearance[q] > clearance[best]):
                best = q
        if best >= 0:
            r = _find(parent, best)
            parent[p] = r
            size[r] += 1
        for e in range(indptr[p], indptr[p + 1]):
            q = neighbours[e]
            if parent[q] < 0 or level[q] != level[p]:
                continue
            a, b = _find(parent, p), _find(parent, q)
            if a == b:
                continue
            narrow = clearance[p] <= neck and min(peak[a], peak[b]) >= clearance[p] + wider
            if narrow and min(size[a], size[b]) >= min_places:
                continue
            if size[a] < size[b]:
                a, b = b, a
            parent[b] = a
            size[a] += size[b]
            peak[a] = max(peak[a], peak[b])
    for p in order:
        parent[p] = _find(parent, p)
    return parent
