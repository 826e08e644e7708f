# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The floor that one walks on, as level rectangles: what plans and maps are laid on. Our own."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from walk_building.building import Building
from walk_building.raster import Columns

LEVEL_M = 0.05
"""Heights are rounded to this: a ramp is a stair of so high steps."""

APART_M = 1.0
"""Floors over each other are at least so far apart."""


def floor_of(building: Building, storey: int) -> NDArray[np.float64]:
    """Returns the floor of a storey under the bodies of all who walk or could stand there, (R, 5).

    Each row is a rectangle [x0, y0, x1, y1, z] in the building's coordinates [m]. Where two overlap, one is over the
    other, as a stair is over the floor that it rises from.
    """
    surface, columns = building.surface, building.surface.columns
    stood_on = building.reachable | (surface.indoor & (surface.room >= 0))
    places = surface.places[stood_on & (surface.storey == storey)]
    layers = _under_bodies(_layers(places, columns), building.walker.radius_m / columns.cell_m)
    levels = [np.where(np.isnan(heights), _NONE, np.rint(heights / LEVEL_M)).astype(np.int64) for heights in layers]
    tiles = np.concatenate([np.empty((0, 5), np.int64), *map(rectangles, levels)])
    # A column's place is at its centre: its cell begins half of one before.
    corner = np.asarray(columns.origin) - columns.cell_m / 2
    ends = np.tile(corner, 2) + tiles[:, :4] * columns.cell_m
    return np.column_stack([ends, tiles[:, 4] * LEVEL_M])


_NONE = np.iinfo(np.int32).min


def rectangles(levels: NDArray[np.int64], none: int = _NONE) -> NDArray[np.int64]:
    """Returns the cells of a grid (nx, ny) as rectangles [i0, j0, i1, j1, level], the ends not included, (R, 5).

    Runs of one level along x that repeat in the next row are one rectangle. Cells of `none` are left out.
    """
    done: list[tuple[int, int, int, int, int]] = []
    open_since: dict[tuple[int, int, int], int] = {}
    for j in range(levels.shape[1] + 1):
        runs = _runs(levels[:, j], none) if j < levels.shape[1] else []
        before, open_since = open_since, {run: open_since.get(run, j) for run in runs}
        done += [(i0, since, i1, j, at) for (i0, i1, at), since in before.items() if (i0, i1, at) not in open_since]
    return np.array(done, dtype=np.int64).reshape(-1, 5)


def _runs(row: NDArray[np.int64], none: int) -> list[tuple[int, int, int]]:
    cuts = [0, *(np.flatnonzero(np.diff(row)) + 1).tolist(), len(row)]
    runs = zip(cuts[:-1], cuts[1:], row[cuts[:-1]].tolist(), strict=True)
    return [run for run in runs if run[2] != none]


def _layers(places: NDArray[np.float64], columns: Columns) -> list[NDArray[np.float64]]:
    """Returns the heights on the grid, nan for none: the lowest places of all columns, the second lowest, ..."""
    flat = columns.flat_of(places[:, :2])
    # Places are ordered by column, then by height.
    first = np.flatnonzero(np.diff(flat, prepend=-1))
    layer = np.arange(len(flat)) - np.repeat(first, np.diff(first, append=len(flat)))
    found = []
    for k in range(layer.max(initial=-1) + 1):
        heights = np.full(columns.count, np.nan)
        heights[flat[layer == k]] = places[layer == k, 2]
        found.append(heights.reshape(columns.shape))
    return found


def _under_bodies(layers: list[NDArray[np.float64]], radius: float) -> list[NDArray[np.float64]]:
    """Spreads heights by a body's radius [cells], to where there is no floor at about that height already."""
    spread = [heights.copy() for heights in layers]
    for k, heights in enumerate(layers):
        gap, nearest = distance_transform_edt(np.isnan(heights), return_indices=True)
        near = heights[tuple(nearest)]
        free = (gap > 0) & (gap <= radius + 1e-9)
        for other in spread:
            free &= ~(np.abs(other - near) < APART_M)
        spread[k][free] = near[free]
    return spread
