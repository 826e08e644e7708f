# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A stretch of a way blended towards the planned tour, in compiled code: a repair tries several."""

from __future__ import annotations

import numba
import numpy as np

from walk_trajopt.curve import rounded
from walk_trajopt.polyline import interpolate

_STEP_M = 0.1  # spacing of the points of a mended stretch
_SHIFT_M = 1.5  # farthest that the optimiser moves a point along the tour
_SHIFTS = 61  # places of the tour that are looked at for each point of the way
_DIGITS = 1e6  # arc lengths are rounded to micrometres, so that no two points are nearly one


@numba.njit(cache=True, nogil=True)
def blended(way, tour, keep_m, pins, core_m, ramp_m, amount):
    """Returns points (m, 3) and arc lengths (m,) of a stretch, its core drawn towards the tour.

    Args:
        way: Its points (n, 3) and for each the arc length on the tour (n,).
        tour: The planned tour's vertices (L, 3) and their arc lengths (L,).
        keep_m: (M,) arc lengths that must stay points of the way.
        pins: Points (P, 3) that the way passes exactly, and their arc lengths (P,).
        core_m: Where the stretch is drawn in full.
        ramp_m: Over which it goes over into the way on both sides.
        amount: The share of the way to the tour, and the radius over which the tour's corners are rounded.
    """
    points, way_m = way
    vertices, tour_m = tour
    share, radius = amount
    low, high = max(core_m[0] - ramp_m, 0.0), min(core_m[1] + ramp_m, tour_m[-1])
    grid = np.linspace(low, high, int(np.ceil((high - low) / _STEP_M)) + 1)
    beside = _beside(interpolate(grid, way_m, points), grid, vertices, tour_m)
    # The tour's own vertices must be among the points, or corners would be cut.
    corners = np.interp(tour_m[(tour_m > beside[0]) & (tour_m < beside[-1])], beside, grid)
    marks = np.concatenate((grid, corners, way_m, keep_m))
    marks = marks[(marks >= low) & (marks <= high)]
    arc = np.unique(np.rint(marks * _DIGITS) / _DIGITS)
    along = np.interp(arc, grid, beside)
    target = rounded(along, tour_m, vertices, radius) if radius > 0.0 else interpolate(along, tour_m, vertices)
    out = interpolate(arc, way_m, points)
    for i in range(len(arc)):
        # The ends of the tour are ends of the way: there is nothing to go over into.
        rise = (arc[i] - low) / max(core_m[0] - low, 1e-9) if low > 0.0 else 1.0
        fall = (high - arc[i]) / max(high - core_m[1], 1e-9) if high < tour_m[-1] else 1.0
        u = min(max(min(rise, fall), 0.0), 1.0)
        part = share * u * u * (3.0 - 2.0 * u)
        for c in range(3):
            out[i, c] += part * (target[i, c] - out[i, c])
    pin_points, pin_m = pins
    for k in range(len(pin_m)):
        if low <= pin_m[k] <= high:
            out[np.abs(arc - pin_m[k]).argmin()] = pin_points[k]
    return out, arc


@numba.njit(cache=True, nogil=True)
def _beside(points, arc_m, vertices, tour_m):
    """Returns the arc lengths (m,), strictly rising, at which the tour is beside the points (m, 3) of the way.

    The optimiser moves points along the tour, too; a blend of places that are not beside each other would lead
    through walls.
    """
    last, length = len(arc_m) - 1, tour_m[-1]
    nearest = np.empty(len(arc_m))
    shifts = np.linspace(-_SHIFT_M, _SHIFT_M, _SHIFTS)
    for i in range(len(arc_m)):
        candidates = np.minimum(np.maximum(arc_m[i] + shifts, 0.0), length)
        places = interpolate(candidates, tour_m, vertices)
        least = np.inf
        for k in range(_SHIFTS):
            apart = 0.01 * shifts[k] ** 2
            for c in range(3):
                apart += (places[k, c] - points[i, c]) ** 2
            if apart < least:
                least, nearest[i] = apart, candidates[k]
    if arc_m[0] <= 0.0:
        nearest[0] = 0.0
    if arc_m[-1] >= length:
        nearest[-1] = length
    falling = nearest.copy()
    for i in range(1, last + 1):
        nearest[i] = max(nearest[i], nearest[i - 1])
        falling[last - i] = min(falling[last - i], falling[last - i + 1])
    # Where the way turns back before the tour does, many points share a place: a hair apart they stay in order.
    hair = 1e-6 / max(arc_m[-1] - arc_m[0], 1e-9)
    return 0.5 * (nearest + falling) + hair * (arc_m - arc_m[0])
