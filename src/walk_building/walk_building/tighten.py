# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From the way over the roadmap to a short one with few corners: shortcuts, then each corner pulled tight."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from walk_building.floor_grid import FloorGrid, walk_line

_EQUAL = 1e-9
_STRAIGHT = 1.01
_LEAST_GAIN = 1e-3  # [m] of cost; what is less is not worth a walk
_PASSES = 2  # a third gains less than 0.1 % of the length


@numba.njit(cache=True, nogil=True)
def _hop(ground, way, a, b):
    """Cost of the straight walk from vertex a to vertex b of the way, or of the one step between two places."""
    p, q = int(way[a, 0]), int(way[b, 0])
    cost = walk_line(ground, p, way[a, 1], way[a, 2], q, way[b, 1], way[b, 2], None)[0]
    if cost == np.inf:
        di, dj = ground.column[q, 0] - ground.column[p, 0], ground.column[q, 1] - ground.column[p, 1]
        if abs(di) <= 1 and abs(dj) <= 1 and ground.step[p, 3 * (di + 1) + (dj + 1)] == q:
            # Two places a step apart are joined even where the squares beside them are not standable.
            x, y = way[b, 1] - way[a, 1], way[b, 2] - way[a, 2]
            z = ground.xyz[q, 2] - ground.xyz[p, 2]
            cost = np.sqrt(x * x + y * y + z * z) * 0.5 * (ground.price[p] + ground.price[q])
    return cost


@numba.njit(cache=True, nogil=True)
def _skip(ground, way, n):
    """Leaves out vertices between which a straight walk costs no more; returns how many are left."""
    so_far = np.zeros(n)
    for k in range(1, n):
        so_far[k] = so_far[k - 1] + _hop(ground, way, k - 1, k)
    at, out = 0, 1
    while at < n - 1:
        best, reach = at + 1, 2
        while at + reach < n:
            if not _hop(ground, way, at, at + reach) <= so_far[at + reach] - so_far[at] + _EQUAL:
                break
            best = at + reach
            reach *= 2
        # Halve what the doubling jumped over.
        low, high = best - at, min(reach, n - at)
        while high - low > 1:
            middle = (low + high) // 2
            if _hop(ground, way, at, at + middle) <= so_far[at + middle] - so_far[at] + _EQUAL:
                low = middle
            else:
                high = middle
        at += low
        way[out] = way[at]
        out += 1
    return out


@numba.njit(cache=True, nogil=True)
def _flat(way, k, point):
    """Distance in plan from vertex k to a point."""
    return np.sqrt((way[k, 1] - point[0]) ** 2 + (way[k, 2] - point[1]) ** 2)


@numba.njit(cache=True, nogil=True)
def _pull(ground, way, k):
    """Moves vertex k to where the walk over it costs least, by ever smaller steps; returns whether it moved."""
    best = _hop(ground, way, k - 1, k) + _hop(ground, way, k, k + 1)
    if best < _STRAIGHT * _flat(way, k - 1, way[k + 1, 1:]):
        return False  # nearly straight: there is nothing to gain
    moved = False
    stride = 4
    while stride > 0:
        better = False
        for direction in range(9):
            p = int(way[k, 0])
            for _ in range(stride):
                if p >= 0:
                    p = ground.step[p, direction]
            if p < 0:
                continue
            # No walk is cheaper than the straight lines in plan, which rules most places out unwalked.
            if _flat(way, k - 1, ground.xyz[p]) + _flat(way, k + 1, ground.xyz[p]) >= best - _LEAST_GAIN:
                continue
            kept = way[k, 0], way[k, 1], way[k, 2]
            way[k, 0], way[k, 1], way[k, 2] = p, ground.xyz[p, 0], ground.xyz[p, 1]
            cost = _hop(ground, way, k - 1, k)
            if cost < best:
                cost += _hop(ground, way, k, k + 1)
            if cost < best - _LEAST_GAIN:
                best, better, moved = cost, True, True
            else:
                way[k, 0], way[k, 1], way[k, 2] = kept
        if not better:
            stride //= 2
    return moved


@numba.njit(cache=True, nogil=True)
def _tighten(ground, way, passes):
    n = _skip(ground, way, len(way))
    for _ in range(passes):
        moved = False
        for k in range(1, n - 1):
            moved |= _pull(ground, way, k)
        if not moved:
            break
        n = _skip(ground, way, n)
    return n


@numba.njit(cache=True, nogil=True)
def _follow_floor(ground, way, profile, points, tolerance):
    """Writes floor points to `points` such that straight lines between them keep within the tolerance of the floor.

    A point is added where no straight line from the last one passes all heights since (a corridor, in one go).
    """
    count = 0
    for k in range(len(way) - 1):
        p, q = int(way[k, 0]), int(way[k + 1, 0])
        ax, ay, bx, by = way[k, 1], way[k, 2], way[k + 1, 1], way[k + 1, 2]
        n = walk_line(ground, p, ax, ay, q, bx, by, profile)[2]
        flat = np.sqrt((bx - ax) ** 2 + (by - ay) ** 2)
        t, z = 0.0, ground.xyz[p, 2]
        if k == 0:
            points[0] = ax, ay, z
            count = 1
        low, high, t_last, z_last = -np.inf, np.inf, t, z
        for s in range(n):
            run = (profile[s, 0] - t) * flat
            if run < 1e-6:
                continue
            slope = (profile[s, 1] - z) / run
            if not low <= slope <= high:
                t, z = t_last, z_last
                points[count] = ax + t * (bx - ax), ay + t * (by - ay), z
                count += 1
                run = (profile[s, 0] - t) * flat
                low, high = -np.inf, np.inf
            low = max(low, (profile[s, 1] - tolerance - z) / run)
            high = min(high, (profile[s, 1] + tolerance - z) / run)
            t_last, z_last = profile[s]
        points[count] = bx, by, ground.xyz[q, 2]
        count += 1
    return count


def tighten(ground: FloorGrid, way: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns a way of no higher cost with the same ends.

    Args:
        ground: The ground.
        way: (n, 3) place, x, y of each vertex; a straight walk or a step leads from each to the next.

    Returns:
        (m, 3), m <= n, likewise; inner vertices stand at the centre of their place.
    """
    pulled = way.copy()
    return pulled[: _tighten(ground, pulled, _PASSES)]


def follow_floor(ground: FloorGrid, way: NDArray[np.float64], tolerance_m: float) -> NDArray[np.float64]:
    """Returns floor points (n, 3) along the way, with one more wherever the slope of the floor changes."""
    cells = np.abs(np.diff(way[:, 1:], axis=0)).sum(axis=1) / ground.cell_m
    profile = np.empty((int(cells.max(initial=0)) + 8, 2))
    points = np.empty((int(cells.sum()) + 9 * len(way), 3))
    return points[: _follow_floor(ground, way, profile, points, tolerance_m)]
