# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""How the legs beside a moved keypoint bend, in compiled code: a hand moves one ninety times a second."""

from __future__ import annotations

import numba
import numpy as np

from walk_trajopt.polyline import interpolate

FIRM = 10.0
"""How many times as much the clearance counts where the path collided without."""

_NO_LENGTH_M = 1e-9
"""A leg no longer than this is none: the first keypoint has none before it, the last none behind."""

_UNEVEN = 1.5  # a leg whose points are so much farther apart, or nearer, than the mean gets another number of them
_VERTEX_M = 0.25  # between the vertices of a bent leg, so that each can find its own floor


@numba.njit(cache=True, nogil=True)
def _bent_leg(points, arc_m, a, b, window, shift):
    """Returns arc lengths (k,) and vertices (k, 3) of a tour's leg from `a` to `b`, bent.

    Args:
        points: (L, 3) the tour.
        arc_m: (L,) its parameter at each vertex.
        a: Where the leg begins.
        b: Where it ends.
        window: Where the bend begins, is whole, and ends.
        shift: (3,) of the keypoint.
    """
    low, high = np.searchsorted(arc_m, a, side="right"), np.searchsorted(arc_m, b)
    even = int(np.ceil((b - a) / _VERTEX_M)) + 1
    arc = np.empty(even + max(high - low, 0))
    for k in range(even):
        arc[k] = a + (b - a) * k / (even - 1)
    arc[even - 1] = b
    arc[even:] = arc_m[low:high]
    arc.sort()
    bent = interpolate(arc, arc_m, points)
    for k in range(len(arc)):
        share = _hat(arc[k], window)
        for c in range(3):
            bent[k, c] += share * shift[c]
    return arc, bent


@numba.njit(cache=True, nogil=True)
def bent_tour(points, arc_m, window, shift, legs):
    """Returns the vertices (k, 3) and the parameter (k,) of a tour with the legs beside a keypoint bent, or replaced.

    Args:
        points: (L, 3) the tour.
        arc_m: (L,) its parameter at each vertex.
        window: Where the bend begins, is whole, and ends.
        shift: (3,) of the keypoint.
        legs: For the leg before and the one behind, the parameter (n,) and the vertices (n, 3) of what takes its
            place; empty where it is bent.
    """
    low, high = window[0], window[2]
    before, after = np.searchsorted(arc_m, low), np.searchsorted(arc_m, high, side="right")
    arcs, lines = arc_m[:before].copy(), points[:before].copy()
    for k in range(2):
        a, b = window[k], window[k + 1]
        if b - a < _NO_LENGTH_M:
            continue
        arc, line = legs[k]
        if len(arc) == 0:
            arc, line = _bent_leg(points, arc_m, a, b, window, shift)
        arcs, lines = np.concatenate((arcs, arc)), np.concatenate((lines, line))
    arcs, lines = np.concatenate((arcs, arc_m[after:])), np.concatenate((lines, points[after:]))
    rising = np.ones(len(arcs), np.bool_)
    rising[1:] = np.diff(arcs) > _NO_LENGTH_M
    return lines[rising], arcs[rising]


@numba.njit(cache=True, nogil=True)
def bent_arcs(points, arc_m, old, here, spacing):
    """Returns the parameters of a window's points: the old ones, unless a leg has become much longer or shorter.

    Args:
        points: (L, 3) the bent tour.
        arc_m: (L,) its parameter.
        old: (k,) parameters of the window's points so far.
        here: That of the keypoint.
        spacing: Wished between points.
    """
    before = _side(points, arc_m, old, old[0], here, spacing)
    after = _side(points, arc_m, old, here, old[-1], spacing)
    if len(before) == 0:
        return after
    return np.concatenate((before, after[1:]))


@numba.njit(cache=True, nogil=True)
def _side(points, arc_m, old, a, b, spacing):
    if b - a < _NO_LENGTH_M:
        return np.empty(0)
    begin, end = np.searchsorted(old, a - _NO_LENGTH_M), np.searchsorted(old, b + _NO_LENGTH_M, side="right")
    low, high = np.searchsorted(arc_m, a, side="right"), np.searchsorted(arc_m, b)
    marks = np.empty(max(high - low, 0) + 2)
    marks[0], marks[-1] = a, b
    marks[1:-1] = arc_m[low:high]
    line = interpolate(marks, arc_m, points)
    length = 0.0
    for k in range(1, len(line)):
        length += np.sqrt(((line[k] - line[k - 1]) ** 2).sum())
    apart = length / max(end - begin - 1, 1)
    if end - begin > 1 and spacing / _UNEVEN <= apart <= spacing * _UNEVEN:
        return old[begin:end].copy()
    return np.linspace(a, b, max(int(np.rint(length / spacing)), 1) + 1)


@numba.njit(cache=True, nogil=True)
def bent_points(x, firmness, old, arc, window, shift):
    """Returns a window's points (n, 3), bent, and their firmness (n,), at the parameters `arc` (n,), from the old."""
    out = interpolate(arc, old, x)
    firm = np.ones(len(arc))
    for k in range(len(arc)):
        share = _hat(arc[k], window)
        for c in range(3):
            out[k, c] += share * shift[c]
        after = min(max(np.searchsorted(old, arc[k]), 0), len(old) - 1)
        before = after if old[after] <= arc[k] else max(after - 1, 0)
        if firmness[before] > 1.0 or firmness[after] > 1.0:
            firm[k] = FIRM
    return out, firm


@numba.njit(cache=True, nogil=True)
def spliced(old, new, first, last):
    """Returns sequences over the points with what is from `first` to `last` replaced: start, arc, x, firmness.

    Args:
        old: (n, 3), (n,), (n, 3), (n,).
        new: (k, 3), (k,), (k, 3), (k,).
        first: Index of the first that is replaced.
        last: Of the last.
    """
    start = np.concatenate((old[0][:first], new[0], old[0][last + 1 :]))
    arc = np.concatenate((old[1][:first], new[1], old[1][last + 1 :]))
    x = np.concatenate((old[2][:first], new[2], old[2][last + 1 :]))
    return start, arc, x, np.concatenate((old[3][:first], new[3], old[3][last + 1 :]))


@numba.njit(cache=True, nogil=True)
def _hat(at, window):
    """Returns 1 at the keypoint, falling to 0 at both ends of the window; 1 on a side that has no length."""
    low, here, high = window
    if at <= here:
        share = (at - low) / (here - low) if here > low else 1.0
    else:
        share = (high - at) / (high - here) if high > here else 1.0
    return min(max(share, 0.0), 1.0)
