# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""O_c: how far the path comes nearer to the building than wished."""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import NDArray

from walk_building.walker import Walker
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
        self._below_eye, self._wish = _heights(setting.walker, setting.clearance_m, setting.clearance_of)
        self.pieces = 2 * len(self._below_eye) + 1
        self._memory: tuple[Points, Points] | None = None

    def learn_from(self, other: Objective) -> None:
        """Takes over what is known about places: it holds whichever points asked for it, and helps those near by."""
        if isinstance(other, Clearance) and other.pieces == self.pieces and other._memory is not None:
            self._memory = other._memory if len(other._memory[0]) == len(self.setting.start) else None

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
        if self._memory is None:
            self._memory = np.full((len(x), 4), -np.inf), np.full((len(x), self.pieces - 1, 8), np.inf)
            self._memory[1][:, :, 3] = -np.inf
        bvh = self.setting.geometry.bvh
        write_clearance(bvh, x, self._below_eye, self._wish, *self._memory, values, slopes)
        bends[:] = 0.0


@functools.lru_cache(maxsize=8)
def _heights(walker: Walker, wish_m: float, of: str) -> tuple[Points, Points]:
    """Returns the heights (K,) of the looked-at points of the axis relative to the eye, and the wish (K,) at each."""
    if of == "eye":
        return np.zeros(1), np.full(1, wish_m)
    count = int(np.ceil((walker.axis_high_m - walker.axis_low_m) / _AXIS_STEP_M)) + 1
    above = np.linspace(walker.axis_low_m, walker.axis_high_m, count)
    return above - walker.eye_height_m, np.minimum(wish_m, above * np.cos(np.radians(walker.max_slope_deg)))
