# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The walkable surface laid out for compiled kernels, and straight walks over it."""

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray
from walk_building.surface import WalkableSurface

# Lengths follow the floor in pieces of at least this [m]: shorter ones would add up the steps of the grid.
_PIECE_M = 0.4
# What counts as on a line of the grid, in cells and in shares of a line.
_ON_LINE = 1e-9


class Ground(NamedTuple):
    """The places of one walkable part, with direct steps to the eight neighbours.

    `step[p, 3 * (di + 1) + (dj + 1)]` is the place one column further in direction (di, dj), or -1.
    """

    cell_m: float
    origin: NDArray[np.float64]  # (2,) x, y of the centre of column (0, 0) [m]
    xyz: NDArray[np.float64]  # (N, 3) column centres, floor height smooth over steps [m]
    column: NDArray[np.int32]  # (N, 2)
    step: NDArray[np.int32]  # (N, 9)
    price: NDArray[np.float64]  # (N,) cost of a metre walked here, 1 where there is room


def lay_ground(
    surface: WalkableSurface, mask: NDArray[np.bool_], eye_height_m: float, comfort_m: float, comfort_weight: float
) -> tuple[Ground, NDArray[np.int64]]:
    """Returns the masked places as a `Ground`, and their indices into the surface.

    A metre at clearance `c` costs `1 + comfort_weight * max(0, 1 - c / comfort_m)` (our own).
    """
    kept = np.flatnonzero(mask)
    xyz = np.array(surface.places[kept], dtype=np.float64)
    smooth = surface.floor_z(xyz + [0.0, 0.0, eye_height_m], eye_height_m)
    xyz[:, 2] = np.where(np.isfinite(smooth), smooth, xyz[:, 2])
    origin = np.asarray(surface.columns.origin, dtype=np.float64)
    column = np.rint((surface.places[:, :2] - origin) / surface.cell_m).astype(np.int32)
    local = np.full(len(surface.places), -1, dtype=np.int32)
    local[kept] = np.arange(len(kept), dtype=np.int32)
    step = _steps(
        kept, local, column, surface.places, np.asarray(surface.indptr), np.asarray(surface.neighbours)
    )
    narrow = np.zeros(len(kept))
    if comfort_m > 0:
        narrow = np.maximum(0.0, 1.0 - surface.clearance_m[kept] / comfort_m)
    price = 1.0 + comfort_weight * narrow
    return Ground(float(surface.cell_m), origin, xyz, np.ascontiguousarray(column[kept]), step, price), kept


@numba.njit(cache=True, nogil=True)
def _steps(kept, local, column, places, indptr, neighbours):  # type: ignore[no-untyped-def]
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
def _corner(ground, square, u, v):  # type: ignore[no-untyped-def]
    """Place at corner (u, v) of the square: the anchor's own, or one step from it; -1 for none."""
    p, au, av = square
    return p if u == au and v == av else ground.step[p, 3 * (u - au + 1) + (v - av + 1)]


@numba.njit(cache=True, nogil=True)
def _square_price(ground, square, in_row, in_column):  # type: ignore[no-untyped-def]
    """Mean price of the square's corners that the line comes near; negative if one is not standable."""
    total, n = 0.0, 0
    for u in range(2):
        for v in range(2):
            if (in_row and v != square[2]) or (in_column and u != square[1]):
                continue
            q = _corner(ground, square, u, v)
            if q < 0:
                return -1.0
            total += ground.price[q]
            n += 1
    return total / n


@numba.njit(cache=True, nogil=True)
def _square_height(ground, square, x, y, in_row, in_column):  # type: ignore[no-untyped-def]
    """Height of the ground at (x, y) [cells] in the square, bilinear between its corners."""
    p, au, av = square
    fu = abs(x - ground.column[p, 0])
    fv = abs(y - ground.column[p, 1])
    near = ground.xyz[p, 2]
    z = near
    if not in_column:
        z += min(fu, 1.0) * (ground.xyz[_corner(ground, square, 1 - au, av), 2] - near)
    if not in_row:
        z += min(fv, 1.0) * (ground.xyz[_corner(ground, square, au, 1 - av), 2] - near)
    if not (in_row or in_column):
        far = ground.xyz[_corner(ground, square, 1 - au, 1 - av), 2] + near
        far -= ground.xyz[_corner(ground, square, 1 - au, av), 2] + ground.xyz[_corner(ground, square, au, 1 - av), 2]
        z += min(fu, 1.0) * min(fv, 1.0) * far
    return z


@numba.njit(cache=True, nogil=True)
def walk_line(ground, a, ax, ay, b, bx, by, profile):  # type: ignore[no-untyped-def]
    """Returns (cost, length [m], samples) of the straight walk from (ax, ay) at place `a` to (bx, by) at `b`.

    The line is followed through the squares between four columns each. A square is walkable if its corners are
    standable and a step apart, which keeps the body free all over it; a line along a row of columns needs that row
    only. So a line changes storeys only where a walker can. Cost and length are inf where it leaves the ground.

    Args:
        ground: The ground.
        a: Place at a corner of the square that holds (ax, ay).
        ax, ay: Start [m].
        b: Place at a corner of the square that holds (bx, by).
        bx, by: End [m].
        profile: (n, 2) or None: gets the share of the line and the height [m] at each square crossed.
    """
    x, y = (ax - ground.origin[0]) / ground.cell_m, (ay - ground.origin[1]) / ground.cell_m
    dx, dy = (bx - ax) / ground.cell_m, (by - ay) / ground.cell_m
    flat = np.sqrt(dx * dx + dy * dy) * ground.cell_m
    i, j = ground.column[a, 0], ground.column[a, 1]
    in_row = abs(dy) < _ON_LINE and abs(y - j) < _ON_LINE
    in_column = abs(dx) < _ON_LINE and abs(x - i) < _ON_LINE
    si, sj = (1 if dx > 0 else -1), (1 if dy > 0 else -1)
    # The square that the line enters first: a start on its border belongs to the one ahead.
    left = i if (x - i > _ON_LINE or (abs(x - i) <= _ON_LINE and si > 0)) else i - 1
    low = j if (y - j > _ON_LINE or (abs(y - j) <= _ON_LINE and sj > 0)) else j - 1
    square = (a, i - left, j - low)
    next_x = (left + (si > 0) - x) / dx if abs(dx) >= _ON_LINE else np.inf
    next_y = (low + (sj > 0) - y) / dy if abs(dy) >= _ON_LINE else np.inf
    t, cost, length, samples = 0.0, 0.0, 0.0, 0
    t_piece, z_piece = 0.0, 0.0
    while True:
        price = _square_price(ground, square, in_row, in_column)
        if price < 0:
            return np.inf, np.inf, 0
        if t == 0.0:
            z_piece = _square_height(ground, square, x, y, in_row, in_column)
        t_next = min(next_x, next_y, 1.0)
        cost += price * (t_next - t) * flat
        t = t_next
        last = t > 1.0 - _ON_LINE
        if last or (t - t_piece) * flat > _PIECE_M or profile is not None:
            z = _square_height(ground, square, x + t * dx, y + t * dy, in_row, in_column)
            if profile is not None:
                profile[samples, 0], profile[samples, 1] = t, z
                samples += 1
            if last or (t - t_piece) * flat > _PIECE_M:
                length += np.sqrt(((t - t_piece) * flat) ** 2 + (z - z_piece) ** 2)
                t_piece, z_piece = t, z
        if last:
            break
        u, v, au, av = square[1], square[2], square[1], square[2]
        if next_x <= t + _ON_LINE:
            u = 1 if si > 0 else 0
            au = 1 - u
            next_x += 1.0 / abs(dx)
        if next_y <= t + _ON_LINE:
            v = 1 if sj > 0 else 0
            av = 1 - v
            next_y += 1.0 / abs(dy)
        square = (_corner(ground, square, u, v), au, av)
    for u in range(2):
        for v in range(2):
            if not (in_row and v != square[2]) and not (in_column and u != square[1]):
                if _corner(ground, square, u, v) == b:
                    return (cost * length / flat if flat > 0 else 0.0), length, samples
    return np.inf, np.inf, 0


@numba.njit(cache=True, nogil=True)
def walk_between(ground, a, b):  # type: ignore[no-untyped-def]
    """Returns the cost of the straight walk between the centres of two places; inf where it leaves the ground."""
    ax, ay, bx, by = ground.xyz[a, 0], ground.xyz[a, 1], ground.xyz[b, 0], ground.xyz[b, 1]
    return walk_line(ground, a, ax, ay, b, bx, by, None)[0]


@numba.njit(cache=True, nogil=True)
def walk_lines(ground, tails, heads):  # type: ignore[no-untyped-def]
    """Returns the cost (n,) of the straight walks between the centres of places `tails` and `heads`."""
    cost = np.empty(len(tails))
    for k in range(len(tails)):
        cost[k] = walk_between(ground, tails[k], heads[k])
    return cost
