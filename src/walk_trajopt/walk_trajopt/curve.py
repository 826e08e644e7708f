# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Smooth curves through points, as polylines fine enough to stand for them."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from walk_trajopt.polyline import interpolate

_OFFSETS = 11  # places of a polyline that a rounded corner is the mean of


@numba.njit(cache=True, nogil=True)
def tangents(points, knots):
    """Returns derivatives (n, k) of the curve through `points` (n, k) at rising `knots` (n,).

    They are those of the parabola through each point and its two neighbours, so a moved point changes the curve no
    farther than two spans away.
    """
    last = len(points) - 1
    out = np.empty(points.shape)
    slope = (points[1] - points[0]) / (knots[1] - knots[0])
    if last == 1:
        out[0] = out[1] = slope
        return out
    first = slope
    for i in range(1, last):
        before, ahead = knots[i] - knots[i - 1], knots[i + 1] - knots[i]
        following = (points[i + 1] - points[i]) / ahead
        out[i] = (slope * ahead + following * before) / (before + ahead)
        slope = following
    out[0] = 1.5 * first - 0.5 * out[1]
    out[last] = 1.5 * slope - 0.5 * out[last - 1]
    return out


@numba.njit(cache=True, nogil=True)
def slopes(t, values):
    """Returns the derivative (m, k) of `values` (m, k) at rising times (m,), from parabolas; lines at the ends."""
    out = np.empty(values.shape)
    out[0] = (values[1] - values[0]) / (t[1] - t[0])
    out[-1] = (values[-1] - values[-2]) / (t[-1] - t[-2])
    for i in range(1, len(t) - 1):
        before, ahead = t[i] - t[i - 1], t[i + 1] - t[i]
        for c in range(values.shape[1]):
            up, down = (values[i + 1, c] - values[i, c]) / ahead, (values[i, c] - values[i - 1, c]) / before
            out[i, c] = (up * before + down * ahead) / (before + ahead)
    return out


def refine(
    points: NDArray[np.float64], chord_error_m: float, exponent: float = 1.0
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns a polyline that is nowhere farther from the cubic Hermite curve through `points` than `chord_error_m`.

    Args:
        points: (n, 3), n >= 2; neighbours may be at the same place [m].
        chord_error_m: Largest distance [m].
        exponent: Of the chord length in the parameter of the curve: 1 chordal, 0.5 centripetal.

    Returns:
        The polyline (m, 3), which has all of `points` in it, and for each of its vertices the place among the points
        as a rising number (m,): 2.5 is halfway between points[2] and points[3].
    """
    curve, place = refined(np.ascontiguousarray(points), chord_error_m, exponent)
    return curve, place


@numba.njit(cache=True, nogil=True)
def refined(points, chord_error, exponent):
    """Returns what `refine` does, in compiled code."""
    n = len(points)
    knots = np.zeros(n)
    for i in range(n - 1):
        knots[i + 1] = knots[i] + max(np.sqrt(((points[i + 1] - points[i]) ** 2).sum()), 1e-6) ** exponent
    derivative = tangents(points, knots)
    pieces = np.empty(n - 1, np.int64)
    for i in range(n - 1):
        bend = _bend(points[i], points[i + 1], derivative[i], derivative[i + 1], knots[i + 1] - knots[i])
        pieces[i] = max(np.ceil(np.sqrt(bend / (8.0 * chord_error))), 1.0)
    curve, place = np.empty((pieces.sum() + 1, 3)), np.empty(pieces.sum() + 1)
    row = 0
    for i in range(n - 1):
        chord = knots[i + 1] - knots[i]
        for k in range(pieces[i]):
            t = k / pieces[i]
            a, b = (1 + 2 * t) * (1 - t) ** 2, t * (1 - t) ** 2 * chord
            c, d = t * t * (3 - 2 * t), t * t * (t - 1) * chord
            for e in range(3):
                ends = a * points[i, e] + c * points[i + 1, e]
                curve[row, e] = ends + b * derivative[i, e] + d * derivative[i + 1, e]
            place[row] = i + t
            row += 1
    curve[row], place[row] = points[-1], n - 1.0
    return curve, place


@numba.njit(cache=True, nogil=True)
def _bend(p0, p1, d0, d1, chord):
    """Returns a bound of a cubic's second derivative across its chord: it is linear, so its ends bound it."""
    side = p1 - p0
    along = side / max(np.sqrt((side**2).sum()), 1e-9)
    bend = 0.0
    for near, far in ((d0, d1), (d1, d0)):
        second = 6.0 * side - 4.0 * chord * near - 2.0 * chord * far
        # What lies along the chord bends nothing.
        across = second - (second * along).sum() * along
        bend = max(bend, np.sqrt((across**2).sum()))
    return bend


@numba.njit(cache=True, nogil=True)
def rounded(arc_m, knots_m, points, radius_m):
    """Returns the mean (n, 3) of a polyline over `radius_m` to both sides of each arc length: its corners rounded.

    Within `radius_m` of an end the mean is over less, so that the ends stay where they are.

    Args:
        arc_m: (n,) rising.
        knots_m: (L,) the polyline's parameter at each vertex.
        points: (L, 3) its vertices.
        radius_m: How far the mean reaches.
    """
    reach = np.empty(len(arc_m))
    for i in range(len(arc_m)):
        reach[i] = max(min(radius_m, arc_m[i] - knots_m[0], knots_m[-1] - arc_m[i]), 0.0)
    out, total = np.zeros((len(arc_m), 3)), 0.0
    for k in range(_OFFSETS):
        offset = 2.0 * k / (_OFFSETS - 1) - 1.0
        # A window of parabolic weight: the mean is then a smooth function of the arc length.
        weight = 1.0 - 0.96 * offset * offset
        out += weight * interpolate(arc_m + offset * reach, knots_m, points)
        total += weight
    return out / total
