# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A piece of a way drawn anew, in compiled code. A way is its points (m, 3) and their arc lengths on the tour (m,)."""

from __future__ import annotations

import numba
import numpy as np

from walk_trajopt.curve import refined

SAME_M = 2e-6
"""Arc lengths are rounded to micrometres, so that no two points are nearly one."""

_TANGENT = 2  # more points on both sides give a drawn piece the tangents that it has within the whole


@numba.njit(cache=True, nogil=True)
def redrawn(way, x, arc_m, ends, chord_error):
    """Returns the points and the arc lengths of a way that is drawn anew between two optimised points.

    Args:
        way: The one there is.
        x: (n, 3) the optimised points.
        arc_m: (n,) of each on the tour, rising.
        ends: Indices of the two.
        chord_error: Largest distance from the smooth curve.
    """
    first, last = max(ends[0] - _TANGENT, 0), min(ends[1] + _TANGENT, len(x) - 1)
    points, place = refined(np.ascontiguousarray(x[first : last + 1]), chord_error, 1.0)
    tour_m = np.empty(len(place))
    for k in range(len(place)):
        at = min(first + int(place[k]), last - 1)
        share = place[k] + first - at
        tour_m[k] = arc_m[at] + share * (arc_m[at + 1] - arc_m[at])
    begin = np.searchsorted(tour_m, arc_m[ends[0]] - SAME_M)
    end = np.searchsorted(tour_m, arc_m[ends[1]] + SAME_M, side="right")
    return replaced(way, (points[begin:end], tour_m[begin:end]))


@numba.njit(cache=True, nogil=True)
def replaced(way, piece):
    """Returns the points and the arc lengths of a way with what lies between the ends of `piece` replaced by it."""
    (points, tour_m), (new, new_m) = way, piece
    before = np.searchsorted(tour_m, new_m[0] - SAME_M)
    after = np.searchsorted(tour_m, new_m[-1] + SAME_M, side="right")
    out = np.concatenate((points[:before], new, points[after:]))
    return out, np.concatenate((tour_m[:before], new_m, tour_m[after:]))
