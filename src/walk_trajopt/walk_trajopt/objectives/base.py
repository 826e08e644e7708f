# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What an objective is: a value, its gradient, and its curvature in one of two shapes.

An objective is defined in NumPy, by `evaluate` or `residuals`. That alone makes it work in every solver. A pointwise
one may add `write_pieces`, the same in compiled code and with more to tell: `docs/trajectory.md` describes it.

Sums over points approximate integrals along the path: a sum is multiplied by the spacing `h`, a first difference
divided by `h`, a second one by `h²`. So the objectives, and the balance of their weights, do not depend on the
number of points.
"""

from __future__ import annotations

import abc
import dataclasses
import functools

import numba
import numpy as np
from numpy.typing import NDArray

from walk_building.geometry import Geometry
from walk_building.surface import WalkableSurface
from walk_building.walker import Walker

Points = NDArray[np.float64]


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Setting:
    """All that objectives may refer to besides the points they are asked about."""

    start: NDArray[np.float64]  # (n, 3) the planned tour's points x⁰ [m]
    spacing_m: float  # h, the mean distance between neighbours of `start`
    keypoints: NDArray[np.float64]  # (M, 3) [m]
    keypoint_index: NDArray[np.int64]  # (M,) the point of each
    keypoint_radius_m: NDArray[np.float64]  # (M,) ρ of each
    geometry: Geometry
    surface: WalkableSurface
    walker: Walker
    clearance_m: float  # D
    clearance_of: str  # "body" or "eye"


class Objective(abc.ABC):
    """A term of the cost, never negative."""

    def __init__(self, setting: Setting) -> None:
        self.setting = setting

    @abc.abstractmethod
    def evaluate(self, x: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
        """Returns the value at points `x` (n, 3) and its gradient (n, 3)."""

    @abc.abstractmethod
    def terms(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Returns the terms (n,) whose sum is the value, each at the first of the neighbouring points it is about."""


class QuadraticObjective(Objective):
    """Σ over coordinates of (x − t)ᵀ A (x − t) with a constant pentadiagonal n × n matrix A."""

    target: NDArray[np.float64] | None = None  # (n, 3) t; None for zero
    bands: NDArray[np.float64]  # (3, n) lower bands of A: A[i, i], A[i + 1, i], A[i + 2, i]

    def evaluate(self, x: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
        """Returns the value (x − t)ᵀ A (x − t) and the gradient 2 A (x − t)."""
        offset = x if self.target is None else x - self.target
        product = banded_product(self.bands, offset)
        return float(np.vdot(offset, product)), 2.0 * product


class PointwiseObjective(Objective):
    """h Σ r_i², a residual per point that depends on this point alone.

    Attributes:
        pieces: P, how many functions the residual is the largest of; 1 for a residual that is smooth.
    """

    pieces: int = 1

    @abc.abstractmethod
    def residuals(self, x: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Returns the residuals r (n,) at points `x` (n, 3) and their gradients J (n, 3).

        The Gauss–Newton approximation of the Hessian is 2 h Jᵢ Jᵢᵀ per point.
        """

    def write_pieces(self, x: Points, values: Points, slopes: Points, bends: Points) -> None:
        """Writes, for points `x` (n, 3), smooth functions of which the residual is the largest.

        Where the largest changes the residual has a kink, and a solver that knows both sides of it does not have to
        find the other one by running into it. So a piece that could become the largest nearby is worth writing too.

        Args:
            x: (n, 3) [m].
            values: (n, P) out: each piece's value, −inf where there is none. The largest is the residual.
            slopes: (n, P, 3) out: its gradient, a vector of the same length everywhere.
            bends: (n, P) out: its second derivative across the gradient, where it is known to be above zero; else 0.
        """
        values[:, 0], slopes[:, 0] = self.residuals(x)
        bends[:, 0] = 0.0

    def learn_from(self, other: Objective) -> None:
        """May take over what an objective of the same kind has found out about the geometry."""

    def evaluate(self, x: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
        """Returns the value h Σ r² and the gradient 2 h r J."""
        r, jacobian = self.residuals(x)
        h = self.setting.spacing_m
        return h * float(r @ r), 2.0 * h * r[:, None] * jacobian

    def terms(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Returns h r² (n,)."""
        shape = len(x), self.pieces
        values, slopes, bends = np.empty(shape), np.empty((*shape, 3)), np.empty(shape)
        self.write_pieces(x, values, slopes, bends)
        largest = values.max(axis=1)
        return self.setting.spacing_m * np.where(largest > -np.inf, largest, 0.0) ** 2


@numba.njit(cache=True, nogil=True)
def banded_product(bands: Points, x: Points) -> Points:
    """Returns A x (n, k) for the symmetric pentadiagonal A with lower `bands` (3, n)."""
    n, width = x.shape
    out = np.empty((n, width))
    for i in range(n):
        for c in range(width):
            total = bands[0, i] * x[i, c]
            for k in (1, 2):
                if i + k < n:
                    total += bands[k, i] * x[i + k, c]
                if i >= k:
                    total += bands[k, i - k] * x[i - k, c]
            out[i, c] = total
    return out


@numba.njit(cache=True, nogil=True)
def difference_terms(x: Points, order: int, scale: float) -> Points:
    """Returns `scale` times the squared length (n,) of each first or second difference, at the first of its points."""
    out = np.zeros(len(x))
    for i in range(len(x) - order):
        for c in range(x.shape[1]):
            step = x[i + 1, c] - x[i, c]
            if order == 2:
                step = x[i + 2, c] - x[i + 1, c] - step
            out[i] += scale * step * step
    return out


@functools.lru_cache(maxsize=256)
def difference_bands(n: int, stencil: tuple[float, ...], scale: float) -> NDArray[np.float64]:
    """Returns the lower bands (3, n), read-only, of scale SᵀS; S applies the stencil (1 to 3 numbers) to neighbours."""
    bands = np.zeros((3, n))
    rows = max(n - len(stencil) + 1, 0)
    for i, a in enumerate(stencil):
        for j in range(i + 1):
            bands[i - j, j : j + rows] += scale * a * stencil[j]
    bands.setflags(write=False)
    return bands
