# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""How far from its keypoints the path passes. Our own: the source's deviation term alone lets keypoints be cut off."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from walk_trajopt.objectives.base import Points, PointwiseObjective


class Keypoints(PointwiseObjective):
    """Σ_k max(|x_{i_k} − p_k| − ρ, 0)², a sum over keypoints and so not multiplied by the spacing [m²].

    Zero where each keypoint's point is within the radius ρ of it: a walker need not step on the very spot.
    """

    def residuals(self, x: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Returns the distances beyond ρ and their gradients, over √h since the sum of the base class is times h."""
        setting = self.setting
        residual, jacobian = np.zeros(len(x)), np.zeros_like(x)
        offset = x[setting.keypoint_index] - setting.keypoints
        distance = np.linalg.norm(offset, axis=1)
        excess = np.maximum(distance - setting.keypoint_radius_m, 0.0)
        # Several keypoints may be one point's; the one that is missed the most counts.
        for k in np.argsort(excess):
            if excess[k] > 0.0:
                i = setting.keypoint_index[k]
                residual[i], jacobian[i] = excess[k], offset[k] / distance[k]
        scale = 1.0 / np.sqrt(setting.spacing_m)
        return scale * residual, scale * jacobian

    def write_pieces(self, x: Points, values: Points, slopes: Points, bends: Points) -> None:
        """Writes the one piece there is."""
        setting = self.setting
        radius, scale = setting.keypoint_radius_m, 1.0 / np.sqrt(setting.spacing_m)
        _write(x, setting.keypoint_index, setting.keypoints, radius, scale, values[:, 0], slopes[:, 0], bends[:, 0])


@numba.njit(cache=True, nogil=True)
def _write(x, index, keypoints, radius, scale, values, slopes, bends):
    values[:] = 0.0
    slopes[:] = 0.0
    bends[:] = 0.0
    for k in range(len(index)):
        i = index[k]
        away = x[i] - keypoints[k]
        distance = np.sqrt(away[0] ** 2 + away[1] ** 2 + away[2] ** 2)
        excess = scale * (distance - radius[k])
        if excess > values[i]:
            values[i] = excess
            slopes[i] = scale / distance * away
            bends[i] = scale / distance
