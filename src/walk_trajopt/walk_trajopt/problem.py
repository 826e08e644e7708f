# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The trajectory problem: weighted objectives over points of which some may be fixed."""

from __future__ import annotations

import dataclasses

import numba
import numpy as np
from numpy.typing import NDArray

from walk_trajopt.config import TrajoptConfig
from walk_trajopt.objectives import OBJECTIVES, Objective, PointwiseObjective, QuadraticObjective, Setting
from walk_trajopt.objectives.base import banded_product


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Local:
    """The problem around one set of points: everything a second-order step needs.

    The cost there is a quadratic function with the constant Hessian, plus for each pointwise objective k
    scale[k] Σ_i (max_j values[i, j])² with j from first[k] up to first[k + 1].
    """

    value: float
    gradient: NDArray[np.float64]  # (n, 3) of the quadratic objectives
    values: NDArray[np.float64]  # (n, P) of the pointwise objectives' pieces, −inf where there is none
    slopes: NDArray[np.float64]  # (n, P, 3)
    bends: NDArray[np.float64]  # (n, P)


class Problem:
    """minimise Σ λ O(x) over points x (n, 3), where fixed points keep the place they have in the start.

    The quadratic objectives are summed into one pentadiagonal matrix beforehand: it never changes.

    Attributes:
        setting: What the objectives refer to.
        fixed: (n,) bool.
        bands: (3, n) lower bands of half the constant Hessian of the quadratic objectives, per coordinate.
        first: (G + 1,) where each pointwise objective's pieces begin.
        scale: (G,) each pointwise objective's weight times the spacing.
    """

    def __init__(self, setting: Setting, config: TrajoptConfig, fixed: NDArray[np.bool_]) -> None:
        self.setting = setting
        self.fixed = fixed
        self._objectives: dict[str, tuple[float, Objective]] = {
            name: (config.weight(name), kind(setting)) for name, kind in OBJECTIVES.items() if config.weight(name) > 0.0
        }
        self._pointwise = [(w, o) for w, o in self._objectives.values() if isinstance(o, PointwiseObjective)]
        self.first = np.cumsum([0, *(o.pieces for _, o in self._pointwise)])
        self.scale = np.array([w * setting.spacing_m for w, _ in self._pointwise])
        self.bands = np.zeros((3, len(setting.start)))
        self._linear = np.zeros_like(setting.start)
        self._constant = 0.0
        for weight, objective in self._objectives.values():
            if not isinstance(objective, QuadraticObjective):
                continue
            self.bands += weight * objective.bands
            if objective.target is None:
                continue
            product = banded_product(objective.bands, objective.target)
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
        """Returns the cost at points `x` (n, 3), and what it is made of."""
        value, gradient = self._evaluate_quadratic(x)
        shape = len(x), int(self.first[-1])
        values, slopes, bends = np.empty(shape), np.empty((*shape, 3)), np.empty(shape)
        for (_, objective), a, b in zip(self._pointwise, self.first[:-1], self.first[1:], strict=True):
            objective.write_pieces(x, values[:, a:b], slopes[:, a:b], bends[:, a:b])
        value += sum_of_squares(values, self.first, self.scale)
        return Local(value=value, gradient=gradient, values=values, slopes=slopes, bends=bends)

    def terms(self, x: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        """Returns the weighted terms (n,) of each objective at points `x` (n, 3), by name."""
        return {name: weight * objective.terms(x) for name, (weight, objective) in self._objectives.items()}

    def _evaluate_quadratic(self, x: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
        value, gradient = _quadratic(self.bands, self._linear, x)
        return value + self._constant, gradient


@numba.njit(cache=True, nogil=True)
def _quadratic(bands, linear, x):
    """Returns xᵀ A x − 2 bᵀ x and its gradient 2 (A x − b), for A with lower `bands` and b `linear` (n, 3)."""
    gradient = banded_product(bands, x)
    value = 0.0
    for i in range(len(x)):
        for c in range(3):
            value += x[i, c] * (gradient[i, c] - 2.0 * linear[i, c])
            gradient[i, c] = 2.0 * (gradient[i, c] - linear[i, c])
    return value, gradient


@numba.njit(cache=True, nogil=True)
def sum_of_squares(values, first, scale):
    """Returns Σ_k scale_k Σ_i (largest of point i's pieces of objective k)²."""
    total = 0.0
    for k in range(len(scale)):
        for i in range(len(values)):
            largest = -np.inf
            for j in range(first[k], first[k + 1]):
                largest = max(largest, values[i, j])
            if largest > -np.inf:
                total += scale[k] * largest * largest
    return total
