# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The trajectory problem: weighted objectives over points of which some may be fixed."""

from __future__ import annotations

import dataclasses
import functools
import itertools

import numba
import numpy as np
from numpy.typing import NDArray

from walk_trajopt.config import TrajoptConfig
from walk_trajopt.objectives import OBJECTIVES, Objective, PointwiseObjective, QuadraticObjective, Setting
from walk_trajopt.objectives.base import banded_product
from walk_trajopt.objectives.clearance import Clearance


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Local:
    """The problem around one set of points: everything a second-order step needs.

    The cost there is a quadratic function with the constant Hessian, plus for each pointwise objective k
    Σ_i scale[i, k] (max_j values[i, j])² with j from first[k] up to first[k + 1].
    """

    x: NDArray[np.float64]  # (n, 3) the points
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
        hessian: (7, 3 n) lower bands of that Hessian, fixed points cut loose with a 1.
        stiffness: The median of its diagonal.
        first: (G + 1,) where each pointwise objective's pieces begin.
        scale: (n, G) each pointwise objective's weight times the spacing, at each point.
    """

    def __init__(
        self,
        setting: Setting,
        config: TrajoptConfig,
        fixed: NDArray[np.bool_],
        firmness: NDArray[np.float64] | None = None,
        before: Problem | None = None,
    ) -> None:
        """Puts the objectives together.

        Args:
            setting: What they refer to.
            config: Their weights.
            fixed: (n,) points that stay where they are.
            firmness: (n,) how many times as much the clearance counts at each point; None for once.
            before: A problem about much the same points, no longer in use: what it knows of the geometry is kept.
        """
        self.setting = setting
        self.fixed = fixed
        self._objectives: dict[str, tuple[float, Objective]] = {}
        self._pointwise: list[tuple[str, float, PointwiseObjective]] = []
        self._quadratic: list[tuple[float, QuadraticObjective]] = []
        known = {} if before is None else before._objectives
        for name, weight, kind in _that_count(config):
            objective = kind(setting)
            self._objectives[name] = weight, objective
            if isinstance(objective, QuadraticObjective):
                self._quadratic.append((weight, objective))
            elif isinstance(objective, PointwiseObjective):
                self._pointwise.append((name, weight, objective))
                if name in known:
                    objective.learn_from(known[name][1])
        self.first, self._spans = _firsts(tuple([o.pieces for _, _, o in self._pointwise]))
        self.scale = np.empty((len(setting.start), len(self._pointwise)))
        for k, (_, weight, objective) in enumerate(self._pointwise):
            self.scale[:, k] = weight * setting.spacing_m
            if firmness is not None and isinstance(objective, Clearance):
                self.scale[:, k] *= firmness
        self._sum_up(before)

    def _sum_up(self, before: Problem | None) -> None:
        """Sums the quadratic objectives; what depends on their matrices alone is taken from a problem that has them."""
        self.bands: NDArray[np.float64]
        self.hessian: NDArray[np.float64]
        self.stiffness: float
        self._linear = np.zeros_like(self.setting.start)
        self._constant = 0.0
        for weight, objective in self._quadratic:
            if objective.target is not None:
                product = banded_product(objective.bands, objective.target)
                self._linear += weight * product
                self._constant += weight * float(np.vdot(objective.target, product))
        if before is not None and before._has_matrices_of(self):
            self.bands = before.bands
            if np.array_equal(before.fixed, self.fixed):
                self.hessian, self.stiffness = before.hessian, before.stiffness
                return
        else:
            self.bands = np.zeros((3, len(self.setting.start)))
            for weight, objective in self._quadratic:
                self.bands += weight * objective.bands
        self.hessian = _cut_loose(self.bands, self.fixed)
        self.stiffness = max(float(np.median(self.hessian[0])), 1e-9)

    def _has_matrices_of(self, other: Problem) -> bool:
        """Whether the sum of the matrices is the same, which is told by their identity."""
        mine, others = ([(w, id(o.bands)) for w, o in one._quadratic] for one in (self, other))
        return mine == others

    def evaluate(self, x: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
        """Returns the cost at points `x` (n, 3) and its gradient (n, 3), which is zero at fixed points."""
        value, gradient = self._evaluate_quadratic(x)
        for scale, (_, _, objective) in zip(self.scale.T, self._pointwise, strict=True):
            residual, jacobian = objective.residuals(x)
            value += float(scale @ residual**2)
            gradient += 2.0 * (scale * residual)[:, None] * jacobian
        gradient[self.fixed] = 0.0
        return value, gradient

    def linearise(self, x: NDArray[np.float64]) -> Local:
        """Returns the cost at points `x` (n, 3), and what it is made of."""
        value, gradient = self._evaluate_quadratic(x)
        shape = len(x), self._spans[-1][1] if self._spans else 0
        values, slopes, bends = np.empty(shape), np.empty((*shape, 3)), np.empty(shape)
        for (_, _, objective), (a, b) in zip(self._pointwise, self._spans, strict=True):
            objective.write_pieces(x, values[:, a:b], slopes[:, a:b], bends[:, a:b])
        value += sum_of_squares(values, self.first, self.scale)
        return Local(x=x, value=value, gradient=gradient, values=values, slopes=slopes, bends=bends)

    def terms(self, x: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        """Returns the weighted terms (n,) of each objective at points `x` (n, 3), by name; no firmness is in them."""
        return {name: weight * objective.terms(x) for name, (weight, objective) in self._objectives.items()}

    def terms_of(self, local: Local) -> dict[str, NDArray[np.float64]]:
        """Returns what `terms` returns at the points of `local`, the pointwise ones from what is known there."""
        out = {
            name: weight * objective.terms(local.x)
            for name, (weight, objective) in self._objectives.items()
            if isinstance(objective, QuadraticObjective)
        }
        h = self.setting.spacing_m
        for (name, weight, _), (a, b) in zip(self._pointwise, self._spans, strict=True):
            largest = local.values[:, a:b].max(axis=1)
            out[name] = weight * h * np.where(largest > -np.inf, largest, 0.0) ** 2
        return out

    def _evaluate_quadratic(self, x: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
        value, gradient = _quadratic_form(self.bands, self._linear, x)
        return value + self._constant, gradient


@functools.lru_cache(maxsize=16)
def _that_count(config: TrajoptConfig) -> tuple[tuple[str, float, type[Objective]], ...]:
    """Returns the objectives that have a weight: names, weights and kinds."""
    weighted = ((name, config.weight(name), kind) for name, kind in OBJECTIVES.items())
    return tuple(entry for entry in weighted if entry[1] > 0.0)


@functools.lru_cache(maxsize=16)
def _firsts(pieces: tuple[int, ...]) -> tuple[NDArray[np.int64], list[tuple[int, int]]]:
    """Returns where each objective's pieces begin (G + 1,), and where they begin and end."""
    first = np.cumsum([0, *pieces])
    return first, list(itertools.pairwise(first.tolist()))


@numba.njit(cache=True, nogil=True)
def _cut_loose(own, fixed):
    """Returns the lower bands (7, 3 n) of the quadratic objectives' Hessian, fixed points cut loose with a 1.

    Args:
        own: (3, n) lower bands of half of it, per coordinate.
        fixed: (n,).
    """
    n = len(fixed)
    bands = np.zeros((7, 3 * n))
    for k in range(3):
        for i in range(n - k):
            loose = fixed[i] or fixed[i + k]
            for c in range(3):
                bands[3 * k, 3 * i + c] = 0.0 if loose else 2.0 * own[k, i]
    for i in range(n):
        if fixed[i]:
            bands[0, 3 * i : 3 * i + 3] = 1.0
    return bands


@numba.njit(cache=True, nogil=True)
def _quadratic_form(bands, linear, x):
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
    """Returns Σ_i Σ_k scale[i, k] (largest of point i's pieces of objective k)²."""
    total = 0.0
    for k in range(scale.shape[1]):
        for i in range(len(values)):
            largest = -np.inf
            for j in range(first[k], first[k + 1]):
                largest = max(largest, values[i, j])
            if largest > -np.inf:
                total += scale[i, k] * largest * largest
    return total
