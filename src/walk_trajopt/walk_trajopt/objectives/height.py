# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""O_h: how far the eye is from its height above the floor."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from walk_trajopt.objectives.base import PointwiseObjective


class Height(PointwiseObjective):
    """h Σ (f(x_i) − H)², f the height above the walkable floor, smooth over steps; zero at eye height. [m³]

    The gradient takes the floor around the point as the plane that fits it best. Points without a floor below count
    as zero: the sweep decides about them.
    """

    def residuals(self, x: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Returns f − H (n,) and its gradients (n, 3)."""
        eye = self.setting.walker.eye_height_m
        plane = self.setting.surface.floor_plane(x, eye)
        known = np.isfinite(plane[:, 0])
        residual = np.where(known, x[:, 2] - plane[:, 0] - eye, 0.0)
        jacobian = np.column_stack([-plane[:, 1], -plane[:, 2], np.ones(len(x))])
        jacobian[~known] = 0.0
        return residual, jacobian
