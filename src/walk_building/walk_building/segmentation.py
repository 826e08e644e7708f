# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Rooms where the file declares none: a storey's plan, above its furniture, is cut where its walls end. Our own."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from walk_building.corridors import part_corridors
from walk_building.floor_plan import FloorPlan

# Half the free width of the widest doorway without a lintel.
DOORWAY_HALF_WIDTH_M = 0.95
# A room is wider than the neck that leads into it by at least this on each side, or it is a bend of a corridor.
_WIDER_THAN_NECK_M = 0.15
# What is cut off by a neck alone, without a lintel, and has less floor is a niche, too.
_MIN_NECK_ROOM_AREA_M2 = 2.5
# Less floor than this, furniture included, is a niche of the room beside it.
_MIN_ROOM_AREA_M2 = 0.7
# The widest opening between two walls that end in line with each other.
_OPENING_M = 3.0
# A wall is at least so long along the opening that it ends at, and at most so thick.
_WALL_LENGTH_M = 0.5
_WALL_THICKNESS_M = 0.5
# Half the width of the narrowest stair, seen in the plan; narrower slopes are kerbs and gutters.
_STAIR_HALF_WIDTH_M = 0.35
# Less is the head of a flight that lies on the storey below.
_MIN_STAIR_AREA_M2 = 1.5
# Of this share of stairs, a room is a stairwell; else the stairs in it are a room of their own.
_STAIRWELL_SHARE = 0.25


def segment_plan(plan: FloorPlan, cell_m: float) -> NDArray[np.int32]:
    """Returns the room of each column (nx, ny) of a plan's free floor; -1 elsewhere; labels count from 0.

    Openings between walls that end in line are closed first; what lies over them is shared out afterwards. The rest
    is a watershed on the distance to walls: columns are taken from the widest to the narrowest, each joins the basin
    of its neighbours taken before it, and where two basins meet they become one room unless the neck between them is
    narrow as a doorway and both are wider than it.
    """
    open_floor = plan.free & ~(_openings(plan.wall, plan.free, cell_m) | _openings(plan.wall.T, plan.free.T, cell_m).T)
    room = part_corridors(_basins(open_floor, cell_m), cell_m)
    stairs, n_stairs = ndimage.label(plan.stair & (room >= 0), structure=np.ones((3, 3)))
    if n_stairs == 0:
        return room
    numbers = np.arange(1, n_stairs + 1)
    wide = ndimage.maximum(ndimage.distance_transform_edt(plan.stair), stairs, numbers) * cell_m
    around = ndimage.median(room, stairs, numbers).astype(int)
    stair_size = np.bincount(stairs.reshape(-1))[1:]
    is_stair = (wide >= _STAIR_HALF_WIDTH_M) & (stair_size * cell_m**2 >= _MIN_STAIR_AREA_M2)
    share = np.zeros(room.max() + 1)
    np.add.at(share, around[is_stair], stair_size[is_stair])
    share /= np.bincount(room[room >= 0])
    own = is_stair & (share[around] < _STAIRWELL_SHARE)
    number = np.concatenate([[-1], np.where(own, room.max() + np.cumsum(own), -1)]).astype(np.int32)
    room = np.where(number[stairs] >= 0, number[stairs], room)
    return room


def _basins(free: NDArray[np.bool_], cell_m: float) -> NDArray[np.int32]:
    """The watershed; see segment_plan."""
    distance = ndimage.distance_transform_edt(free) * cell_m
    order = np.flatnonzero(free)
    # In whole millimetres, which sort in linear time.
    rank = np.minimum(distance.reshape(-1)[order] * 1000, 65535).astype(np.uint16)
    order = order[np.argsort(65535 - rank, kind="stable")]
    least = int(np.ceil(_MIN_ROOM_AREA_M2 / cell_m**2))
    root = _watershed(
        distance, order, DOORWAY_HALF_WIDTH_M, _WIDER_THAN_NECK_M, int(np.ceil(_MIN_NECK_ROOM_AREA_M2 / cell_m**2))
    )
    kept, index, count = np.unique(root[order], return_inverse=True, return_counts=True)
    number = np.where(count >= least, np.cumsum(count >= least) - 1, -1)
    room = np.full(free.size, -1, np.int32)
    room[order] = number[index] if len(kept) else -1
    return room.reshape(free.shape)


def _openings(wall: NDArray[np.bool_], free: NDArray[np.bool_], cell_m: float) -> NDArray[np.bool_]:
    """Free columns between two walls along the second axis that end in line with each other; (nx, ny)."""
    blocked = wall.astype(np.int8)
    length = round(_WALL_LENGTH_M / cell_m)
    beside = round(_WALL_THICKNESS_M / cell_m)
    closed = np.zeros_like(free)
    _close_openings(blocked, free, round(_OPENING_M / cell_m), length, beside, closed)
    return closed


@numba.njit(cache=True, nogil=True)
def _close_openings(wall, free, widest, length, beside, closed):
    """Marks the runs of free cells along each row between two wall ends; see _wall_ends."""
    nx, ny = wall.shape
    for i in range(nx):
        j = 0
        while j < ny:
            if not free[i, j]:
                j += 1
                continue
            end = j
            while end < ny and free[i, end]:
                end += 1
            near, far = (wall, free, i, j - 1, -1, length, beside), (wall, free, i, end, 1, length, beside)
            if end - j <= widest and _wall_ends(*near) and _wall_ends(*far):
                closed[i, j:end] = True
            j = end


@numba.njit(cache=True, nogil=True)
def _wall_ends(wall, free, i, j, step, length, beside):
    """Whether a wall that comes along row i ends at (i, j): a run of wall, free within its thickness on both sides."""
    nx, ny = wall.shape
    for k in range(length):
        b = j + k * step
        if b < 0 or b >= ny or wall[i, b] == 0:
            return False
    # Beside its end, and a little way back from it, where a wall that it joins would be in the way.
    for k in (0, length - 1):
        thickness = 1
        for side in (-1, 1):
            a = i + side
            while 0 <= a < nx and wall[a, j + k * step]:
                thickness += 1
                a += side
            if a < 0 or a >= nx or not free[a, j + k * step]:
                return False
        if thickness > beside:
            return False
    return True


@numba.njit(cache=True, nogil=True)
def _find(parent, p):
    while parent[p] != p:
        parent[p] = parent[parent[p]]
        p = parent[p]
    return p


@numba.njit(cache=True, nogil=True)
def _watershed(distance, order, neck, wider, least):
    """Union-find over the columns from wide to narrow; returns the root of each flat column."""
    nx, ny = distance.shape
    height = distance.ravel()
    parent = np.full(nx * ny, -1, np.int64)
    size = np.zeros(nx * ny, np.int64)
    peak = np.zeros(nx * ny)
    for p in order:
        parent[p] = p
        size[p] = 1
        peak[p] = height[p]
        i, j = p // ny, p % ny
        best = -1
        # The plan has a rim of columns without floor, so neighbours are always on the grid.
        for k in range(9):
            q = (i + k // 3 - 1) * ny + j + k % 3 - 1
            if k != 4 and parent[q] >= 0 and (best < 0 or height[q] > height[best]):
                best = q
        if best >= 0:
            root = _find(parent, best)
            parent[p] = root
            size[root] += 1
        for k in range(9):
            q = (i + k // 3 - 1) * ny + j + k % 3 - 1
            if k == 4 or parent[q] < 0:
                continue
            a, b = _find(parent, p), _find(parent, q)
            if a == b:
                continue
            narrow = height[p] <= neck and min(peak[a], peak[b]) >= height[p] + wider
            if narrow and min(size[a], size[b]) >= least:
                continue
            if size[a] < size[b]:
                a, b = b, a
            parent[b] = a
            size[a] += size[b]
            peak[a] = max(peak[a], peak[b])
    for p in order:
        parent[p] = _find(parent, p)
    return parent


def drop_small(label: NDArray[np.int32], least: int) -> None:
    """Takes the label away from the rooms of fewer than `least` places."""
    count = np.bincount(label[label >= 0], minlength=1)
    label[(label >= 0) & (count[np.maximum(label, 0)] < least)] = -1


@numba.njit(cache=True, nogil=True)
def spread(indptr, neighbours, mask, level, label):
    """Gives each place of `mask` without a label the label of the nearest one on its storey, counted in steps."""
    n = len(label)
    queue = np.empty(n, np.int64)
    first = last = 0
    for p in range(n):
        if label[p] >= 0:
            queue[last] = p
            last += 1
    while first < last:
        p = queue[first]
        first += 1
        for e in range(indptr[p], indptr[p + 1]):
            q = neighbours[e]
            if label[q] < 0 and mask[q] and level[q] == level[p]:
                label[q] = label[p]
                queue[last] = q
                last += 1
