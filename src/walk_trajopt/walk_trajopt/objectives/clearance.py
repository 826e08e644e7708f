# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""O_c: how far the path comes nearer to the building than wished."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from walk_trajopt.objectives.base import Objective, Points, PointwiseObjective, Setting
from walk_trajopt.objectives.clearance_kernels import write_clearance

_AXIS_STEP_M = 0.35  # between looked-at points of the body's axis: less than the height of a railing's bar or a table


class Clearance(PointwiseObjective):
    """h Σ (D − |x_i − c_i|)² where the distance is below D, else 0; c_i closest on the exact geometry [m³].

    The closest points are found anew in every evaluation. For the body (our own), c_i is looked for from several
    heights of the body's axis and the largest shortfall counts; D is there limited to the distance that this height
    has from the steepest floor the walker walks on, so that the floor does not repel. For the eye alone it is the
    source's formula.
    """

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        walker, wish = setting.walker, setting.clearance_m
        if setting.clearance_of == "eye":
            above = np.array([walker.eye_height_m])
        else:
            count = int(np.ceil((walker.axis_high_m - walker.axis_low_m) / _AXIS_STEP_M)) + 1
            above = np.linspace(walker.axis_low_m, walker.axis_high_m, count)
        self._below_eye = above - walker.eye_height_m  # (K,)
        floor = above * np.cos(np.radians(walker.max_slope_deg))
        self._wish = np.full(len(above), wish) if setting.clearance_of == "eye" else np.minimum(wish, floor)
        self.pieces = 2 * len(above) + 1
        self._far = np.full((len(setting.start), 4), -np.inf)
        self._known = np.full((len(setting.start), 2 * len(above), 8), np.inf)
        self._known[:, :, 3] = -np.inf

    def learn_from(self, other: Objective) -> None:
        """Takes over what is known about places: it holds whichever points asked for it, and helps those near by."""
        if isinstance(other, Clearance) and other._known.shape == self._known.shape:
            self._far, self._known = other._far, other._known

    def residuals(self, x: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Returns the shortfalls max(D − d, 0) (n,) and their gradients (n, 3), unit vectors towards the geometry."""
        heights = len(self._below_eye)
        query = np.repeat(x[None], heights, axis=0)
        query[:, :, 2] += self._below_eye[:, None]
        found = self.setting.geometry.closest(query.reshape(-1, 3), float(self._wish.max()))
        short = np.maximum(self._wish[:, None] - found.distance_m.reshape(heights, -1), 0.0)
        worst = short.argmax(axis=0), np.arange(len(x))
        residual = short[worst]
        distance = found.distance_m.reshape(heights, -1)[worst]
        jacobian = np.zeros_like(x)
        # On the geometry itself there is no direction away from it.
        near = (residual > 0.0) & (distance > 1e-9)
        towards = found.points.reshape(heights, -1, 3)[worst][near] - query[worst][near]
        jacobian[near] = towards / distance[near, None]
        return residual, jacobian

    def write_pieces(self, x: Points, values: Points, slopes: Points, bends: Points) -> None:
        """Writes 0 and the shortfalls towards the nearest and the next wall, seen from each height."""
        bvh = self.setting.geometry.bvh
        write_clearance(bvh, x, self._below_eye, self._wish, self._far, self._known, values, slopes)
        bends[:] = 0.0
