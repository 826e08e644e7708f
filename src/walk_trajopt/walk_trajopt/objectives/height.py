# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""O_h: how far the eye is from its height above the floor."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from walk_building.surface_kernels import floor_planes
from walk_trajopt.objectives.base import Points, PointwiseObjective


class Height(PointwiseObjective):
    """h Σ (f(x_i) − H)², f the height above the walkable floor, smooth over steps; zero at eye height [m³].

    The gradient takes the floor around the point as the plane that fits it best. Where there is no floor below a
    point, it is wished back to the height of its start: otherwise there would be a way out of this objective.
    """

    def residuals(self, x: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Returns f − H (n,) and its gradients (n, 3)."""
        eye = self.setting.walker.eye_height_m
        plane = self.setting.surface.floor_plane(x, eye)
        known = np.isfinite(plane[:, 0])
        residual = np.where(known, x[:, 2] - plane[:, 0] - eye, x[:, 2] - self.setting.start[:, 2])
        jacobian = np.column_stack([-plane[:, 1], -plane[:, 2], np.ones(len(x))])
        jacobian[~known] = (0.0, 0.0, 1.0)
        return residual, jacobian

    def write_pieces(self, x: Points, values: Points, slopes: Points, bends: Points) -> None:
        """Writes the one piece there is."""
        surface = self.setting.surface
        eye, start = self.setting.walker.eye_height_m, self.setting.start
        _write(surface.grid, x, eye, 2 * surface.step_m, start, values[:, 0], slopes[:, 0])
        bends[:, 0] = 0.0


@numba.njit(cache=True, nogil=True)
def _write(grid, x, eye, reach, start, values, slopes):
    plane = np.empty((len(x), 3))
    floor_planes(grid, x, eye, reach, plane)
    for i in range(len(x)):
        known = np.isfinite(plane[i, 0])
        values[i] = x[i, 2] - (plane[i, 0] + eye if known else start[i, 2])
        slopes[i, 0] = -plane[i, 1] if known else 0.0
        slopes[i, 1] = -plane[i, 2] if known else 0.0
        slopes[i, 2] = 1.0
