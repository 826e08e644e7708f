# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Polylines by arc length."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from walk_building.errors import ParameterError


class Polyline:
    """A polyline that can be asked for its point at an arc length.

    Attributes:
        points: (L, 3) vertices [m].
        arc_m: (L,) arc length at each vertex, strictly rising from 0. After an edit a part of the polyline may be
            longer or shorter than its share of this parameter, which then keeps names of places stable.
    """

    def __init__(self, points: NDArray[np.float64], arc_m: NDArray[np.float64] | None = None) -> None:
        if arc_m is None:
            # Vertices on top of each other would have one arc length between them.
            points = points[np.concatenate([[True], np.linalg.norm(np.diff(points, axis=0), axis=1) > 1e-9])]
            arc_m = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
        self.points = points
        self.arc_m = arc_m

    @property
    def length_m(self) -> float:
        """Length of the whole polyline [m]."""
        return float(self.arc_m[-1])

    def at(self, arc_m: ArrayLike) -> NDArray[np.float64]:
        """Returns the points (N, 3) at arc lengths (N,), the ends beyond the ends."""
        return interpolate(np.asarray(arc_m, np.float64), self.arc_m, self.points)


def interpolate(
    where: NDArray[np.float64], knots: NDArray[np.float64], values: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Returns rows (N, k) of `values` (L, k), given at rising `knots` (L,), at `where` (N,), linear between them."""
    return np.column_stack([np.interp(where, knots, values[:, k]) for k in range(values.shape[1])])


def as_polyline_points(name: str, points: ArrayLike, at_least: int = 2) -> NDArray[np.float64]:
    """Returns `points` as a finite (N, 3) float64 array with at least so many rows.

    Raises:
        ParameterError: Another shape, too few points, or numbers that are not finite.
    """
    array = np.array(points, dtype=np.float64)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ParameterError(name, array.shape, "an array of shape (N, 3)")
    if len(array) < at_least:
        raise ParameterError(name, f"{len(array)} points", f"at least {at_least}")
    if not np.isfinite(array).all():
        raise ParameterError(name, "nan or inf", "finite coordinates in metres")
    return array
