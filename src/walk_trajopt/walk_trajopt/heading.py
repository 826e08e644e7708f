# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The direction of a path by arc length, smoothed so that it can be looked along."""

from __future__ import annotations

import dataclasses

import numba
import numpy as np
from numpy.typing import NDArray

from walk_trajopt.smoothing import gaussian

GRID_M = 0.02  # between two values; a hundredth of a second at walking speed


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Heading:
    """Directions on an even grid of arc length, `spacing_m` apart, from 0 to the length of the path."""

    spacing_m: float
    arc_m: NDArray[np.float64]  # (g,)
    yaw: NDArray[np.float64]  # (g,) of the path itself, unwrapped [rad]
    look: NDArray[np.float64]  # (g,) of the walker's eyes, unwrapped, ahead of the path and smoother [rad]
    bend: NDArray[np.float64]  # (g,) curvature of the path, vertical bends included [1/m]


_LEAST_CELLS = 9  # a path of centimetres still has somewhere to speed up and slow down
_BODY_M = 0.03  # over which a bend is averaged, so that the grid sees every corner
_CORNER_M = 0.06  # a polyline's corner is taken as a bend over so much of its sides, or over half a shorter side
_LEVEL = 1e-3  # slope [rad] of what is level, and horizontal share of a direction that is straight up or down


def heading_of(
    points: NDArray[np.float64], arc_m: NDArray[np.float64], lookahead_m: float, smoothing_m: float
) -> Heading:
    """Returns the directions of a path.

    Args:
        points: (n, 3), neighbours at different places [m].
        arc_m: (n,) arc length at each.
        lookahead_m: How far ahead of the walker the look direction is taken.
        smoothing_m: Standard deviation of the Gaussian that smooths the look direction.
    """
    grid, yaw, look, bend = _on_grid(points, arc_m, lookahead_m, smoothing_m)
    return Heading(spacing_m=float(grid[1]), arc_m=grid, yaw=yaw, look=look, bend=bend)


@numba.njit(cache=True, nogil=True)
def _on_grid(points, arc_m, lookahead, smoothing):
    """Returns the grid (g,) and on it yaw, look and bend (g,)."""
    grid = np.linspace(0.0, arc_m[-1], max(int(np.ceil(arc_m[-1] / GRID_M)) + 1, _LEAST_CELLS))
    spacing = grid[1]
    knots, direction, slope = _directions(points, arc_m)
    along, rise = _spread(grid, knots, direction, slope)
    turned, tilted = gaussian(along, _BODY_M / spacing), gaussian(rise, _BODY_M / spacing)
    smooth = gaussian(along, smoothing / spacing)
    turning, tilting = gradient(turned, spacing), gradient(tilted, spacing)
    look, bend = np.empty(len(grid)), np.empty(len(grid))
    for i in range(len(grid)):
        look[i] = on_even_grid(grid[i] + lookahead, spacing, smooth)
        across = turning[i] * np.cos(tilted[i]) if abs(tilted[i]) > _LEVEL else turning[i]
        bend[i] = np.sqrt(across * across + tilting[i] * tilting[i])
    return grid, turned, look, bend


@numba.njit(cache=True, nogil=True)
def _spread(grid, knots, a, b):
    """Returns two sequences given at rising knots on the rising grid, both at once; the ends go on beyond the ends."""
    out_a, out_b = np.empty(len(grid)), np.empty(len(grid))
    cell, last = 0, len(knots) - 1
    for i in range(len(grid)):
        while cell < last - 1 and knots[cell + 1] <= grid[i]:
            cell += 1
        gap = knots[cell + 1] - knots[cell]
        share = min(max((grid[i] - knots[cell]) / gap, 0.0), 1.0) if gap > 0.0 else 1.0
        out_a[i] = a[cell] + share * (a[cell + 1] - a[cell])
        out_b[i] = b[cell] + share * (b[cell + 1] - b[cell])
    return out_a, out_b


@numba.njit(cache=True, nogil=True)
def on_even_grid(where, spacing, values):
    """Returns a sequence given every `spacing` from 0 on, at one place; the ends go on beyond the ends."""
    place = min(max(where / spacing, 0.0), len(values) - 1.0)
    cell = min(int(place), len(values) - 2)
    return values[cell] + (place - cell) * (values[cell + 1] - values[cell])


@numba.njit(cache=True, nogil=True)
def _directions(points, arc_m):
    """Returns arc lengths (k,) and there yaw, unwrapped, and slope of the smooth curve for which the polyline stands.

    Between them the direction goes on linearly: along each side it is that of the side, but for its ends, where it
    turns into the next one. Straight up or down there is no yaw: the one before, or the first there is, goes on.
    """
    sides = len(arc_m) - 1
    knots, yaw, slope = np.empty(2 * sides), np.empty(2 * sides), np.empty(2 * sides)
    last, first = 0.0, -1
    for i in range(sides):
        side = arc_m[i + 1] - arc_m[i]
        near = min(_CORNER_M, 0.5 * side)
        x, y, z = (points[i + 1] - points[i]) / side
        flat = np.hypot(x, y)
        if flat > _LEVEL:
            turn = np.arctan2(y, x) - last
            last += turn - 2.0 * np.pi * np.rint(turn / (2.0 * np.pi)) if first >= 0 else turn
            first = i if first < 0 else first
        knots[2 * i], knots[2 * i + 1] = arc_m[i] + near, arc_m[i + 1] - near
        yaw[2 * i : 2 * i + 2] = last
        slope[2 * i : 2 * i + 2] = np.arctan2(z, flat)
    if first > 0:
        yaw[: 2 * first] = yaw[2 * first]
    return knots, yaw, slope


@numba.njit(cache=True, nogil=True)
def gradient(values, spacing):
    """Returns central differences (n,), one-sided at the ends; n is at least 2."""
    out = np.empty(len(values))
    out[0], out[-1] = (values[1] - values[0]) / spacing, (values[-1] - values[-2]) / spacing
    for i in range(1, len(values) - 1):
        out[i] = (values[i + 1] - values[i - 1]) / (2.0 * spacing)
    return out
