# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The direction of a path by arc length, smoothed so that it can be looked along."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

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
    count = int(np.ceil(arc_m[-1] / GRID_M)) + 1
    grid = np.linspace(0.0, arc_m[-1], max(count, _LEAST_CELLS))
    spacing = float(grid[1])
    knots, direction = _directions(points, arc_m)
    flat = np.hypot(direction[:, 0], direction[:, 1])
    yaw = np.arctan2(direction[:, 1], direction[:, 0])
    level = flat > 1e-3
    if not level.all():
        # Straight up or down there is no direction: the one before, or the first there is, goes on.
        known = np.flatnonzero(level)
        yaw = (
            yaw[known[np.maximum(np.searchsorted(known, np.arange(len(yaw)), side="right") - 1, 0)]]
            if len(known)
            else 0 * yaw
        )
    along = np.interp(grid, knots, np.unwrap(yaw))
    slope = np.interp(grid, knots, np.arctan2(direction[:, 2], flat))
    body = _BODY_M / spacing
    turned, tilted = (gaussian_filter1d(a, body, mode="nearest") for a in (along, slope))
    look = gaussian_filter1d(along, smoothing_m / spacing, mode="nearest")
    return Heading(
        spacing_m=spacing,
        arc_m=grid,
        yaw=turned,
        look=np.interp(grid + lookahead_m, grid, look),
        bend=np.hypot(np.gradient(turned, spacing) * np.cos(tilted), np.gradient(tilted, spacing)),
    )


def _directions(
    points: NDArray[np.float64], arc_m: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns arc lengths (k,) and there the directions (k, 3) of the smooth curve for which the polyline stands.

    Between them the direction goes on linearly: along each side it is that of the side, but for its ends, where it
    turns into the next one.
    """
    side = np.diff(arc_m)
    near = np.minimum(_CORNER_M, 0.5 * side)
    unit = np.diff(points, axis=0) / side[:, None]
    knots = np.column_stack([arc_m[:-1] + near, arc_m[1:] - near]).ravel()
    return knots, np.repeat(unit, 2, axis=0)
