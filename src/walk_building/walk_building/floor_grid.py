# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The walkable surface laid out for compiled kernels, and straight walks over it."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray

from walk_building.surface import WalkableSurface

# Lengths follow the floor in pieces of at least this [m]: shorter ones would add up the steps of the grid.
_PIECE_M = 0.4
# What counts as on a line of the grid, in cells and in shares of a line.
_ON_LINE = 1e-9
_THREADS = 2
# Directions in `FloorGrid.step`: x is east, y is north.
_EAST, _NORTH, _NORTH_EAST = 7, 5, 8


class FloorGrid(NamedTuple):
    """The places of one walkable part, with direct steps to the eight neighbours.

    `step[p, 3 * (di + 1) + (dj + 1)]` is the place one column further in direction (di, dj), or -1.
    """

    cell_m: float
    origin: NDArray[np.float64]  # (2,) x, y of the centre of column (0, 0) [m]
    xyz: NDArray[np.float64]  # (N, 3) column centres, floor height smooth over steps [m]
    column: NDArray[np.int32]  # (N, 2)
    step: NDArray[np.int32]  # (N, 9)
    price: NDArray[np.float64]  # (N,) cost of a metre walked here, 1 where there is room
    square: NDArray[np.float64]  # (N,) the same, mean over the square with its south-west corner here; inf: blocked


def lay_floor(
    surface: WalkableSurface, mask: NDArray[np.bool_], eye_height_m: float, comfort_m: float, comfort_weight: float
) -> tuple[FloorGrid, NDArray[np.int64]]:
    """Returns the masked places as a `FloorGrid`, and their indices into the surface.

    A metre at clearance `c` costs `1 + comfort_weight * max(0, 1 - c / comfort_m)` (our own).
    """
    kept = np.flatnonzero(mask)
    xyz = np.array(surface.places[kept], dtype=np.float64)
    eyes = np.array_split(xyz + [0.0, 0.0, eye_height_m], _THREADS)
    with ThreadPoolExecutor(_THREADS) as pool:
        smooth = np.concatenate(list(pool.map(lambda part: surface.floor_z(part, eye_height_m), eyes)))
    xyz[:, 2] = np.where(np.isfinite(smooth), smooth, xyz[:, 2])
    origin = np.asarray(surface.columns.origin, dtype=np.float64)
    column = np.rint((surface.places[:, :2] - origin) / surface.cell_m).astype(np.int32)
    local = np.full(len(surface.places), -1, dtype=np.int32)
    local[kept] = np.arange(len(kept), dtype=np.int32)
    step = _steps(kept, local, column, surface.places, np.asarray(surface.indptr), np.asarray(surface.neighbours))
    narrow = np.zeros(len(kept))
    if comfort_m > 0:
        narrow = np.maximum(0.0, 1.0 - surface.clearance_m[kept] / comfort_m)
    price = 1.0 + comfort_weight * narrow
    return FloorGrid(
        float(surface.cell_m), origin, xyz, np.ascontiguousarray(column[kept]), step, price, _squares(step, price)
    ), kept


@numba.njit(cache=True, nogil=True)
def _steps(kept, local, column, places, indptr, neighbours):
    step = np.full((len(kept), 9), -1, dtype=np.int32)
    for p in range(len(kept)):
        here = kept[p]
        for e in range(indptr[here], indptr[here + 1]):
            there = neighbours[e]
            q = local[there]
            if q < 0:
                continue
            k = 3 * (column[there, 0] - column[here, 0] + 1) + (column[there, 1] - column[here, 1] + 1)
            other = step[p, k]
            # Two floors one above the other may both be a step away: the level one is meant.
            if other < 0 or abs(places[there, 2] - places[here, 2]) < abs(places[kept[other], 2] - places[here, 2]):
                step[p, k] = q
    return step


@numba.njit(cache=True, nogil=True)
def _squares(step, price):
    square = np.full(len(step), np.inf)
    for p in range(len(step)):
        q, r, s = step[p, _EAST], step[p, _NORTH], step[p, _NORTH_EAST]
        if q >= 0 and r >= 0 and s >= 0:
            square[p] = 0.25 * (price[p] + price[q] + price[r] + price[s])
    return square


@numba.njit(cache=True, nogil=True)
def _price(ground, p, in_row, in_column):
    """Price of the square north-east of place p, or of the row or column between p and the next; inf: blocked."""
    if in_row or in_column:
        q = ground.step[p, _EAST if in_row else _NORTH]
        return 0.5 * (ground.price[p] + ground.price[q]) if q >= 0 else np.inf
    return ground.square[p]


@numba.njit(cache=True, nogil=True)
def _height(ground, p, x, y, in_row, in_column):
    """Height of the ground at (x, y) [cells] in the square north-east of place p, bilinear between its corners."""
    u = min(max(x - ground.column[p, 0], 0.0), 1.0)
    v = min(max(y - ground.column[p, 1], 0.0), 1.0)
    z = ground.xyz[p, 2]
    east = z if in_column else ground.xyz[ground.step[p, _EAST], 2]
    north = z if in_row else ground.xyz[ground.step[p, _NORTH], 2]
    both = east + north - z if in_row or in_column else ground.xyz[ground.step[p, _NORTH_EAST], 2]
    return (1 - v) * ((1 - u) * z + u * east) + v * ((1 - u) * north + u * both)


@numba.njit(cache=True, nogil=True)
def _ahead(offset, sign):
    """Which square a line enters first, 0 or -1, from a place's offset: on the border, the one ahead."""
    if abs(offset) <= _ON_LINE:
        return 0 if sign > 0 else -1
    return 0 if offset > 0 else -1


@numba.njit(cache=True, nogil=True)
def walk_line(ground, a, ax, ay, b, bx, by, profile):
    """Returns (cost, length [m], samples) of the straight walk from (ax, ay) at place `a` to (bx, by) at `b`.

    The line is followed through the squares between four columns each. A square is walkable if its corners are
    standable and a step apart, which keeps the body free all over it; a line along a row of columns needs that row
    only. So a line changes storeys only where a walker can. Cost and length are inf where it leaves the ground.

    Args:
        ground: The ground.
        a: Place at a corner of the square that holds the start.
        ax: Start, x [m].
        ay: Start, y [m].
        b: Place at a corner of the square that holds the end.
        bx: End, x [m].
        by: End, y [m].
        profile: (n, 2) or None: gets the share of the line and the height [m] at each square crossed.
    """
    x, y = (ax - ground.origin[0]) / ground.cell_m, (ay - ground.origin[1]) / ground.cell_m
    dx, dy = (bx - ax) / ground.cell_m, (by - ay) / ground.cell_m
    flat = np.sqrt(dx * dx + dy * dy) * ground.cell_m
    if flat < _ON_LINE:
        return (0.0, 0.0, 0) if a == b else (np.inf, np.inf, 0)
    i, j = ground.column[a, 0], ground.column[a, 1]
    in_row = abs(dy) < _ON_LINE and abs(y - j) < _ON_LINE
    in_column = abs(dx) < _ON_LINE and abs(x - i) < _ON_LINE
    si, sj = (1 if dx > 0 else -1), (1 if dy > 0 else -1)
    di, dj = (0 if in_column else _ahead(x - i, si)), (0 if in_row else _ahead(y - j, sj))
    p = a if di == 0 and dj == 0 else ground.step[a, 3 * (di + 1) + (dj + 1)]
    next_x = (i + di + (si > 0) - x) / dx if abs(dx) >= _ON_LINE else np.inf
    next_y = (j + dj + (sj > 0) - y) / dy if abs(dy) >= _ON_LINE else np.inf
    t, cost, length, samples = 0.0, 0.0, 0.0, 0
    t_piece, z_piece = 0.0, 0.0
    while True:
        price = _price(ground, p, in_row, in_column) if p >= 0 else np.inf
        if price == np.inf:
            return np.inf, np.inf, 0
        if t == 0.0:
            z_piece = _height(ground, p, x, y, in_row, in_column)
        t_next = min(next_x, next_y, 1.0)
        cost += price * (t_next - t) * flat
        t = t_next
        last = t > 1.0 - _ON_LINE
        piece = last or (t - t_piece) * flat > _PIECE_M
        if piece or profile is not None:
            z = _height(ground, p, x + t * dx, y + t * dy, in_row, in_column)
            if profile is not None:
                profile[samples, 0], profile[samples, 1] = t, z
                samples += 1
            if piece:
                length += np.sqrt(((t - t_piece) * flat) ** 2 + (z - z_piece) ** 2)
                t_piece, z_piece = t, z
        if last:
            break
        di, dj = 0, 0
        if next_x <= t + _ON_LINE:
            di = si
            next_x += 1.0 / abs(dx)
        if next_y <= t + _ON_LINE:
            dj = sj
            next_y += 1.0 / abs(dy)
        p = ground.step[p, 3 * (di + 1) + (dj + 1)]
    arrived = (
        p == b
        or (not in_column and ground.step[p, _EAST] == b)
        or (not in_row and ground.step[p, _NORTH] == b)
        or (not (in_row or in_column) and ground.step[p, _NORTH_EAST] == b)
    )
    return (cost * length / flat, length, samples) if arrived else (np.inf, np.inf, 0)


@numba.njit(cache=True, nogil=True)
def walk_between(ground, a, b):
    """Returns the cost of the straight walk between the centres of two places; inf where it leaves the ground."""
    ax, ay, bx, by = ground.xyz[a, 0], ground.xyz[a, 1], ground.xyz[b, 0], ground.xyz[b, 1]
    return walk_line(ground, a, ax, ay, b, bx, by, None)[0]


@numba.njit(cache=True, nogil=True)
def step_cost(ground, p, q):
    """Returns the cost of the step from place p to its neighbour q."""
    x = ground.xyz[q, 0] - ground.xyz[p, 0]
    y = ground.xyz[q, 1] - ground.xyz[p, 1]
    z = ground.xyz[q, 2] - ground.xyz[p, 2]
    return np.sqrt(x * x + y * y + z * z) * 0.5 * (ground.price[p] + ground.price[q])
