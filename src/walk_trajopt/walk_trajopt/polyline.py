# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Polylines by arc length."""

from __future__ import annotations

import numba
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
            arc_m = arc_lengths(points)
        self.points = points
        self.arc_m = arc_m

    @property
    def length_m(self) -> float:
        """Length of the whole polyline [m]."""
        return float(self.arc_m[-1])

    def at(self, arc_m: ArrayLike) -> NDArray[np.float64]:
        """Returns the points (N, 3) at arc lengths (N,), the ends beyond the ends."""
        return np.asarray(interpolate(np.atleast_1d(np.asarray(arc_m, np.float64)), self.arc_m, self.points))


@numba.njit(cache=True, nogil=True)
def arc_lengths(points):
    """Returns the length along a polyline (n, 3) up to each of its points (n,)."""
    out = np.zeros(len(points))
    for i in range(1, len(points)):
        total = 0.0
        for c in range(points.shape[1]):
            total += (points[i, c] - points[i - 1, c]) ** 2
        out[i] = out[i - 1] + np.sqrt(total)
    return out


@numba.njit(cache=True, nogil=True)
def interpolate(where, knots, values):
    """Returns rows (N, k) of `values` (L, k), given at rising `knots` (L,), at `where` (N,), linear between them.

    Beyond the ends they are those at the ends. Fastest where `where` rises, too.
    """
    out = np.empty((len(where), values.shape[1]))
    cell, last = 0, len(knots) - 1
    for i in range(len(where)):
        if where[i] <= knots[0]:
            out[i] = values[0]
        elif where[i] >= knots[last]:
            out[i] = values[last]
        else:
            if where[i] < knots[cell]:
                cell = np.searchsorted(knots, where[i], side="right") - 1
            while knots[cell + 1] <= where[i]:
                cell += 1
            share = (where[i] - knots[cell]) / (knots[cell + 1] - knots[cell])
            for c in range(values.shape[1]):
                out[i, c] = values[cell, c] + share * (values[cell + 1, c] - values[cell, c])
    return out


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


def tour_of(points: ArrayLike) -> Polyline:
    """Returns a planned tour (L, 3) as a polyline.

    Raises:
        ParameterError: No such array, numbers that are not finite, or no length.
    """
    tour = Polyline(as_polyline_points("polyline", points))
    if len(tour.points) < 2:
        raise ParameterError("polyline", "all points at one place", "a tour of some length")
    return tour
