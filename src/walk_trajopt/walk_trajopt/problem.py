# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The trajectory problem: weighted objectives over points of which some may be fixed."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from walk_trajopt.config import TrajoptConfig
from walk_trajopt.objectives import OBJECTIVES, Objective, PointwiseObjective, QuadraticObjective, Setting
from walk_trajopt.objectives.base import banded_product


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Local:
    """The problem around one set of points: everything a second-order step needs."""

    value: float
    gradient: NDArray[np.float64]  # (n, 3), zero at fixed points
    push: NDArray[np.float64]  # (n, 3) the pointwise objectives' part of the gradient
    blocks: NDArray[np.float64]  # (n, 3, 3) Gauss–Newton Hessian of the pointwise objectives, zero at fixed points


class Problem:
    """minimise Σ λ O(x) over points x (n, 3), where fixed points keep the place they have in the start.

    The quadratic objectives are summed into one pentadiagonal matrix beforehand: it never changes.

    Attributes:
        setting: What the objectives refer to.
        fixed: (n,) bool.
        bands: (3, n) lower bands of half the constant Hessian of the quadratic objectives, per coordinate.
    """

    def __init__(self, setting: Setting, config: TrajoptConfig, fixed: NDArray[np.bool_]) -> None:
        self.setting = setting
        self.fixed = fixed
        self._objectives: dict[str, tuple[float, Objective]] = {
            name: (config.weight(name), kind(setting)) for name, kind in OBJECTIVES.items() if config.weight(name) > 0.0
        }
        self._pointwise = [(w, o) for w, o in self._objectives.values() if isinstance(o, PointwiseObjective)]
        self.bands = np.zeros((3, len(setting.start)))
        self._linear = np.zeros_like(setting.start)
        self._constant = 0.0
        for weight, objective in self._objectives.values():
            if not isinstance(objective, QuadraticObjective):
                continue
            product = banded_product(objective.bands, objective.target)
            self.bands += weight * objective.bands
            self._linear += weight * product
            self._constant += weight * float(np.vdot(objective.target, product))

    def evaluate(self, x: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
        """Returns the cost at points `x` (n, 3) and its gradient (n, 3), which is zero at fixed points."""
        value, gradient = self._evaluate_quadratic(x)
        for weight, objective in self._pointwise:
            term, slope = objective.evaluate(x)
            value += weight * term
            gradient += weight * slope
        gradient[self.fixed] = 0.0
        return value, gradient

    def linearise(self, x: NDArray[np.float64]) -> Local:
        """Returns cost, gradient and Gauss–Newton blocks at points `x` (n, 3)."""
        value, gradient = self._evaluate_quadratic(x)
        push, blocks = np.zeros_like(x), np.zeros((len(x), 3, 3))
        for weight, objective in self._pointwise:
            scale = weight * self.setting.spacing_m
            r, jacobian = objective.residuals(x)
            value += scale * float(r @ r)
            push += (2.0 * scale * r)[:, None] * jacobian
            # Where nothing pushes, nothing stiffens either.
            active = np.where(r != 0.0, 2.0 * scale, 0.0)[:, None, None]
            blocks += active * jacobian[:, :, None] * jacobian[:, None, :]
        gradient += push
        for array in (gradient, push, blocks):
            array[self.fixed] = 0.0
        return Local(value=value, gradient=gradient, push=push, blocks=blocks)

    def costs(self, x: NDArray[np.float64]) -> dict[str, float]:
        """Returns the weighted value of each objective at points `x` (n, 3), by name."""
        return {name: weight * objective.evaluate(x)[0] for name, (weight, objective) in self._objectives.items()}

    def _evaluate_quadratic(self, x: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
        product = banded_product(self.bands, x)
        value = float(np.vdot(x, product - 2.0 * self._linear)) + self._constant
        return value, 2.0 * (product - self._linear)
