# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Distance from a standing body's axis, a vertical segment, to the triangles, in compiled code."""

from __future__ import annotations

import numba
import numpy as np

from walk_building.bvh import STACK_DEPTH, closest_on_triangle


@numba.njit(cache=True, nogil=True)
def axis_distance_sq(bvh, x, y, low_z, high_z, limit):
    """Squared distance from the vertical segment (x, y, low_z..high_z) to the triangles.

    The search stops at the first triangle nearer than sqrt(limit[0]) and prunes what is farther than
    sqrt(limit[1]); without any in that range the answer is limit[1].
    """
    enough, best = limit
    stack = np.empty(STACK_DEPTH, np.int32)
    stack_sq = np.empty(STACK_DEPTH)
    stack[0], stack_sq[0] = 0, 0.0
    top = 1
    while top > 0:
        top -= 1
        if stack_sq[top] >= best:
            continue
        node = stack[top]
        first = bvh.child[node]
        if bvh.filled[node] > 0:
            for i in range(first, first + bvh.filled[node]):
                if _axis_corners_sq(bvh.triangles[i], x, y, low_z, high_z) < best:
                    best = min(best, _axis_triangle_sq(bvh.triangles[i], x, y, low_z, high_z))
                    if best < enough:
                        return best
            continue
        near, far = first, first + 1
        near_sq, far_sq = _axis_box_sq(bvh, near, x, y, low_z, high_z), _axis_box_sq(bvh, far, x, y, low_z, high_z)
        if far_sq < near_sq:
            near, far, near_sq, far_sq = far, near, far_sq, near_sq
        # The nearer one is looked at first: what it finds spares much of the other.
        if far_sq < best:
            stack[top], stack_sq[top] = far, far_sq
            top += 1
        if near_sq < best:
            stack[top], stack_sq[top] = near, near_sq
            top += 1
    return best


@numba.njit(cache=True, nogil=True)
def _axis_box_sq(bvh, node, x, y, low_z, high_z):
    dx = max(bvh.low[node, 0] - x, 0.0, x - bvh.high[node, 0])
    dy = max(bvh.low[node, 1] - y, 0.0, y - bvh.high[node, 1])
    dz = max(bvh.low[node, 2] - high_z, 0.0, low_z - bvh.high[node, 2])
    return dx * dx + dy * dy + dz * dz


@numba.njit(cache=True, nogil=True)
def _axis_corners_sq(tri, x, y, low_z, high_z):
    """Squared distance to the box around a triangle: a bound that costs a tenth of the distance itself."""
    dx = max(min(tri[0, 0], tri[1, 0], tri[2, 0]) - x, 0.0, x - max(tri[0, 0], tri[1, 0], tri[2, 0]))
    dy = max(min(tri[0, 1], tri[1, 1], tri[2, 1]) - y, 0.0, y - max(tri[0, 1], tri[1, 1], tri[2, 1]))
    dz = max(min(tri[0, 2], tri[1, 2], tri[2, 2]) - high_z, 0.0, low_z - max(tri[0, 2], tri[1, 2], tri[2, 2]))
    return dx * dx + dy * dy + dz * dz


@numba.njit(cache=True, nogil=True)
def _axis_triangle_sq(tri, x, y, low_z, high_z):
    """Squared distance from a vertical segment to a triangle: 0 where it pierces it, else ends or edges decide."""
    if _pierces(tri, x, y, low_z, high_z):
        return 0.0
    best = np.inf
    for z in (low_z, high_z):
        cx, cy, cz = closest_on_triangle(tri, x, y, z)
        best = min(best, (cx - x) ** 2 + (cy - y) ** 2 + (cz - z) ** 2)
    for k in range(3):
        best = min(best, _axis_edge_sq(tri[k], tri[(k + 1) % 3], x, y, low_z, high_z))
    return best


@numba.njit(cache=True, nogil=True)
def _pierces(tri, x, y, low_z, high_z):
    ax, ay = tri[0, 0] - x, tri[0, 1] - y
    bx, by = tri[1, 0] - x, tri[1, 1] - y
    cx, cy = tri[2, 0] - x, tri[2, 1] - y
    u = bx * cy - by * cx
    v = cx * ay - cy * ax
    w = ax * by - ay * bx
    total = u + v + w
    if total == 0.0 or not ((u >= 0.0 and v >= 0.0 and w >= 0.0) or (u <= 0.0 and v <= 0.0 and w <= 0.0)):
        return False
    z = (u * tri[0, 2] + v * tri[1, 2] + w * tri[2, 2]) / total
    return low_z <= z <= high_z


@numba.njit(cache=True, nogil=True)
def _axis_edge_sq(a, b, x, y, low_z, high_z):
    """Squared distance from a vertical segment to the edge a-b.

    Along the edge, the horizontal distance is least at `t`; if the edge is there above or below the segment,
    the nearest pair has the segment's end in it, which the caller has looked at already for whole triangles
    and which is bounded here by clamping.
    """
    ex, ey, ez = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    flat = ex * ex + ey * ey
    t = ((x - a[0]) * ex + (y - a[1]) * ey) / flat if flat > 0.0 else 0.5
    t = min(max(t, 0.0), 1.0)
    dx, dy, z = a[0] + t * ex - x, a[1] + t * ey - y, a[2] + t * ez
    if flat == 0.0:
        # A vertical edge: the horizontal distance holds wherever the two overlap in height.
        dz = max(min(a[2], b[2]) - high_z, low_z - max(a[2], b[2]), 0.0)
    else:
        dz = max(z - high_z, low_z - z, 0.0)
    return dx * dx + dy * dy + dz * dz


@numba.njit(cache=True, nogil=True)
def standing_clearances(begin, end, bvh, floor, axis_low, axis_high, limit, out):
    """Writes to `out` the squared distances from the body axes above the floor points to the triangles."""
    for i in range(begin, end):
        x, y, z = floor[i]
        out[i] = axis_distance_sq(bvh, x, y, z + axis_low, z + axis_high, limit)
