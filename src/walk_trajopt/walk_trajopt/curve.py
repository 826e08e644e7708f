# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Smooth curves through points, as polylines fine enough to stand for them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from walk_trajopt.polyline import interpolate


def tangents(points: NDArray[np.float64], knots: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns derivatives (n, k) of the curve through `points` (n, k) at rising `knots` (n,).

    They are those of the parabola through each point and its two neighbours, so a moved point changes the curve no
    farther than two spans away.
    """
    if len(points) < 3:
        return np.repeat((points[-1:] - points[:1]) / (knots[-1] - knots[0]), len(points), axis=0)
    h = np.diff(knots)[:, None]
    slope = np.diff(points, axis=0) / h
    inner = (slope[:-1] * h[1:] + slope[1:] * h[:-1]) / (h[:-1] + h[1:])
    first = 1.5 * slope[:1] - 0.5 * inner[:1]
    last = 1.5 * slope[-1:] - 0.5 * inner[-1:]
    return np.concatenate([first, inner, last])


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
    chord = np.maximum(np.linalg.norm(np.diff(points, axis=0), axis=1), 1e-6) ** exponent
    knots = np.concatenate([[0.0], np.cumsum(chord)])
    derivative = tangents(points, knots)
    p0, p1 = points[:-1], points[1:]
    m0, m1 = derivative[:-1] * chord[:, None], derivative[1:] * chord[:, None]
    # The second derivative of a cubic is linear, so its ends bound it; what lies along the chord bends nothing.
    along = (p1 - p0) / np.maximum(np.linalg.norm(p1 - p0, axis=1), 1e-9)[:, None]
    bend = np.zeros(len(p0))
    for second in (6 * (p1 - p0) - 4 * m0 - 2 * m1, -6 * (p1 - p0) + 2 * m0 + 4 * m1):
        across = second - (second * along).sum(axis=1)[:, None] * along
        bend = np.maximum(bend, np.linalg.norm(across, axis=1))
    pieces = np.maximum(np.ceil(np.sqrt(bend / (8.0 * chord_error_m))), 1.0).astype(np.int64)
    span = np.repeat(np.arange(len(pieces)), pieces)
    u = (np.arange(len(span)) - np.repeat(np.cumsum(pieces) - pieces, pieces)) / pieces[span]
    t = u[:, None]
    curve = (
        p0[span] * (1 + 2 * t) * (1 - t) ** 2
        + m0[span] * t * (1 - t) ** 2
        + p1[span] * t * t * (3 - 2 * t)
        + m1[span] * t * t * (t - 1)
    )
    return np.concatenate([curve, points[-1:]]), np.append(span + u, len(points) - 1.0)


def rounded(
    arc_m: NDArray[np.float64], knots_m: NDArray[np.float64], points: NDArray[np.float64], radius_m: float
) -> NDArray[np.float64]:
    """Returns the mean of a polyline over `radius_m` to both sides of each arc length: its corners rounded.

    Within `radius_m` of an end the mean is over less, so that the ends stay where they are.
    """
    reach = np.minimum(radius_m, np.minimum(arc_m - knots_m[0], knots_m[-1] - arc_m))
    # A window of parabolic weight: the mean is then a smooth function of the arc length.
    offsets = np.linspace(-1.0, 1.0, 11)
    weight = 1.0 - 0.96 * offsets**2
    out = np.zeros((len(arc_m), points.shape[1]))
    for offset, w in zip(offsets, weight / weight.sum(), strict=True):
        out += w * interpolate(arc_m + offset * np.maximum(reach, 0.0), knots_m, points)
    return out
