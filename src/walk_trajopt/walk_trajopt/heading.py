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
_BODY_M = 0.2  # over which a bend is averaged: nobody's hips follow a polyline's corners


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
    step = np.diff(points, axis=0)
    flat = np.hypot(step[:, 0], step[:, 1])
    yaw = np.arctan2(step[:, 1], step[:, 0])
    level = flat > 1e-3 * np.diff(arc_m)
    if not level.all():
        # Straight up or down there is no direction: the one before, or the first there is, goes on.
        known = np.flatnonzero(level)
        yaw = (
            yaw[known[np.maximum(np.searchsorted(known, np.arange(len(yaw)), side="right") - 1, 0)]]
            if len(known)
            else 0 * yaw
        )
    pitch = np.arctan2(step[:, 2], flat)
    segment = np.clip(np.searchsorted(arc_m, grid, side="right") - 1, 0, len(yaw) - 1)
    along, slope = np.unwrap(yaw)[segment], pitch[segment]
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
