# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A storey seen from above: where there is floor, and what stands on it above furniture. Our own.

Furniture ends below the lintels of doors, walls do not: a cut through the storey above the height of doors shows the
walls alone, and shows doorways closed.
"""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from walk_building.body import standing_clearances
from walk_building.geometry import Geometry, in_chunks
from walk_building.railings import RAILING_M, railings
from walk_building.raster import Columns, Hits

# Floor that furniture stands on belongs to the plan this far from where somebody can stand.
_UNDER_FURNITURE_M = 1.5
# The floor under furniture lies this near to the height of the floor beside it.
_SAME_FLOOR_M = 0.3
# Above most doors and furniture, and below most beams.
_LINTEL_M = 2.3
# Above tall doors. What hangs between the two heights is a lintel over an opening, and a beam across a room.
_TALL_LINTEL_M = 2.6
# Half the width of the widest opening that counts as a doorway by a lintel at the upper height.
_TALL_DOOR_HALF_WIDTH_M = 1.4
# Both cuts stay this far below the room's ceiling: what is overhead, lintels and the tops of walls left out.
_BELOW_CEILING_M = 0.1
_WALL_M = 2.0
_DEEP_LINTEL_M = 1.0
# What counts as overhead begins here; lower things are furniture.
_OVERHEAD_M = 1.5
# Lines 0.1 m apart, also along diagonals, see every wall within this distance.
_HIT_SHARE = 0.75
_BESIDE_M = 1.0
_SQUARE = np.ones((3, 3))
# A column and the four beside it; across a tread two steps may lie.
_CROSS = ndimage.generate_binary_structure(2, 1)
_CROSS_SLACK_M = 0.15
# Steeper floor is a stair: ramps are less steep than 1 : 6.
_STAIR_SLOPE = 0.35
_SMOOTHING_M = 0.25


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class FloorPlan:
    """One storey on the grid of columns; all (nx, ny)."""

    place: NDArray[np.int64]  # the place of the column that the plan shows, -1 for none
    free: NDArray[np.bool_]  # floor with no wall or lintel above it, whether or not furniture stands on it
    wall: NDArray[np.bool_]  # floor with a wall or lintel above it
    stair: NDArray[np.bool_]  # free, and steep


def floor_plan(
    geometry: Geometry,
    columns: Columns,
    hits: Hits,
    column: NDArray[np.int64],
    places: NDArray[np.float64],
    mask: NDArray[np.bool_],
    outdoors: NDArray[np.bool_],
    step_m: float,
) -> FloorPlan:
    """Returns the plan of the places of `mask`, all of one storey.

    Args:
        geometry: What stands on the floor.
        columns: The grid.
        hits: What its lines meet.
        column: (P,) column of each place.
        places: (P, 3).
        mask: (P,) the places to show; where two lie in a column, the lower one.
        outdoors: (P,) the places of the storey at which the plan ends.
        step_m: The highest step within a room.
    """
    place = _lowest(column, mask, columns)
    distance, nearest = ndimage.distance_transform_edt(place < 0, return_indices=True)
    floor = places[place[nearest[0], nearest[1]], 2]
    # Outdoors begins where places beside these, not the roof above them, are nearer.
    beside = outdoors & (np.abs(places[:, 2] - floor.reshape(-1)[column]) < _BESIDE_M)
    outside = (_lowest(column, beside, columns) >= 0) & (place < 0)
    domain = (distance * columns.cell_m <= _UNDER_FURNITURE_M) & _has_floor(hits, floor.reshape(-1)).reshape(
        place.shape
    )
    if outside.any():
        domain &= distance < ndimage.distance_transform_edt(~outside)
    ledge = domain & _uneven(floor, domain, step_m)
    if ledge.any():
        ledge |= railings(_cut(geometry, columns, floor + RAILING_M, domain), ledge, columns.cell_m)
    wall = ledge | _walls(geometry, columns, floor, _ceiling(columns, hits, floor, domain), domain)
    free = domain & ~wall
    stair = free & _steep(floor, domain, ledge, columns.cell_m)
    return FloorPlan(place=np.where(domain, place, -1), free=free, wall=wall, stair=stair)


def _lowest(column: NDArray[np.int64], mask: NDArray[np.bool_], columns: Columns) -> NDArray[np.int64]:
    """The lowest place of `mask` in each column (nx, ny), -1 for none."""
    lowest = np.full(columns.count, -1, np.int64)
    members = np.flatnonzero(mask)[::-1]
    lowest[column[members]] = members
    return lowest.reshape(columns.shape)


def _of_hits(hits: Hits) -> NDArray[np.int64]:
    """The column of each hit."""
    return np.repeat(np.arange(len(hits.start) - 1), np.diff(hits.start))


def _has_floor(hits: Hits, floor: NDArray[np.float64]) -> NDArray[np.bool_]:
    at = _of_hits(hits)
    found = np.zeros(len(floor), bool)
    found[at[np.abs(hits.z - floor[at]) <= _SAME_FLOOR_M]] = True
    return found


def _ceiling(
    columns: Columns, hits: Hits, floor: NDArray[np.float64], domain: NDArray[np.bool_]
) -> NDArray[np.float64]:
    """Height of the room's ceiling above its floor [m], over lintels that of the rooms beside; inf for none."""
    at = _of_hits(hits)
    above = hits.z - floor.reshape(-1)[at]
    overhead = np.flatnonzero((above > _OVERHEAD_M) & domain.reshape(-1)[at])
    height = np.where(domain, np.inf, 0.0).reshape(-1)
    # From high to low, so that the lowest of each column is written last.
    height[at[overhead[::-1]]] = above[overhead[::-1]]
    height = height.reshape(columns.shape)
    # Inside a wall the next thing above is the wall's own top: what is thin and high goes first.
    for thin_m, high_first in ((_WALL_M, False), (_DEEP_LINTEL_M, True)):
        size = 2 * round(thin_m / columns.cell_m / 2) + 1
        for take_high in (high_first, not high_first):
            if take_high:
                height = ndimage.maximum_filter(np.where(domain, height, 0.0), size=size)
            else:
                height = ndimage.minimum_filter(np.where(domain, height, np.inf), size=size)
    return np.asarray(np.where(domain, height, np.inf))


def _walls(
    geometry: Geometry,
    columns: Columns,
    floor: NDArray[np.float64],
    ceiling: NDArray[np.float64],
    domain: NDArray[np.bool_],
) -> NDArray[np.bool_]:
    """Where a wall or a lintel is above the floor of `domain`."""
    low = _cut(geometry, columns, floor + np.minimum(_LINTEL_M, ceiling - _BELOW_CEILING_M), domain)
    clear = domain & ~low
    height = np.minimum(_TALL_LINTEL_M, ceiling - _BELOW_CEILING_M)
    high, _ = ndimage.label(_cut(geometry, columns, floor + height, clear & (height > _LINTEL_M)), _SQUARE)
    far = clear & (ndimage.distance_transform_edt(clear) * columns.cell_m > _TALL_DOOR_HALF_WIDTH_M)
    high[np.isin(high, high[far])] = 0
    return low | (high > 0)


def _cut(geometry: Geometry, columns: Columns, z: NDArray[np.float64], where: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Whether something is at the height z over each column of `where`."""
    i, j = np.nonzero(where)
    points = np.column_stack([columns.origin[0] + i * columns.cell_m, columns.origin[1] + j * columns.cell_m, z[i, j]])
    reach_sq = (_HIT_SHARE * columns.cell_m) ** 2
    distance_sq = np.empty(len(points))
    limit = (reach_sq, reach_sq * 1.0001)
    in_chunks(standing_clearances, len(points), geometry.bvh, points, 0.0, 0.0, limit, distance_sq)
    cut = np.zeros(where.shape, bool)
    cut[i, j] = distance_sq < reach_sq
    return cut


def _uneven(floor: NDArray[np.float64], domain: NDArray[np.bool_], step_m: float) -> NDArray[np.bool_]:
    """Where the floor ends at a higher or lower one."""
    low = ndimage.minimum_filter(np.where(domain, floor, np.inf), footprint=_CROSS)
    high = ndimage.maximum_filter(np.where(domain, floor, -np.inf), footprint=_CROSS)
    return np.asarray(high - low > step_m + _CROSS_SLACK_M)


def _steep(
    floor: NDArray[np.float64], domain: NDArray[np.bool_], ledge: NDArray[np.bool_], cell_m: float
) -> NDArray[np.bool_]:
    """Where the floor, smoothed over the treads, rises as stairs do."""
    sigma = _SMOOTHING_M / cell_m
    weight = ndimage.gaussian_filter(domain.astype(float), sigma)
    smooth = ndimage.gaussian_filter(np.where(domain, floor, 0.0), sigma) / np.maximum(weight, 1e-6)
    steep = domain & (np.hypot(*np.gradient(smooth, cell_m)) > _STAIR_SLOPE)
    # A ledge, smoothed, looks steep, too.
    near = ndimage.distance_transform_edt(~ledge) * cell_m <= _SMOOTHING_M if ledge.any() else ledge
    return np.asarray(ndimage.binary_dilation(steep & ~near, iterations=3, mask=domain & ~ledge & steep))
