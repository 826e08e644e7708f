# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A bounding volume hierarchy over triangles, as flat arrays that any compiled kernel can walk.

The tree is built by splitting at the middle of the longer side of the centroids' box, falling back to the
median where that leaves one side empty; see `ericson2005` for the queries on single triangles.
"""

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray

LEAF_SIZE = 4  # triangles; between 2 and 8 the queries differ by less than their noise
STACK_DEPTH = 64  # the middle split halves a box's side each time, so 64 levels outlast float64's resolution


class Bvh(NamedTuple):
    """Nodes in depth-first order; the children of node i are `child[i]` and `child[i] + 1`.

    A leaf has `filled[i] > 0` triangles, `triangles[child[i] : child[i] + filled[i]]`.
    """

    low: NDArray[np.float64]  # (M, 3) box corners
    high: NDArray[np.float64]  # (M, 3)
    child: NDArray[np.int32]  # (M,)
    filled: NDArray[np.int32]  # (M,)
    triangles: NDArray[np.float64]  # (F, 3, 3) corners, in leaf order
    face: NDArray[np.int32]  # (F,) index of each in the caller's faces


def build_bvh(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> Bvh:
    """Builds the tree over `vertices[faces]`.

    Args:
        vertices: (V, 3) [m].
        faces: (F, 3), F >= 1.
    """
    triangles = np.ascontiguousarray(vertices[faces], dtype=np.float64)
    low, high, child, count, order = _build(triangles)
    return Bvh(low, high, child, count, np.ascontiguousarray(triangles[order]), order.astype(np.int32))


@numba.njit(cache=True, nogil=True)
def _build(triangles):
    n = triangles.shape[0]
    centroid = np.empty((n, 3))
    for i in range(n):
        for k in range(3):
            centroid[i, k] = (triangles[i, 0, k] + triangles[i, 1, k] + triangles[i, 2, k]) / 3.0
    order = np.arange(n)
    low = np.empty((2 * n, 3))
    high = np.empty((2 * n, 3))
    child = np.empty(2 * n, np.int32)
    count = np.zeros(2 * n, np.int32)
    todo = [(0, 0, n)]
    n_nodes = 1
    while len(todo) > 0:
        node, begin, end = todo.pop()
        for k in range(3):
            low[node, k] = np.inf
            high[node, k] = -np.inf
        centre_low = np.full(3, np.inf)
        centre_high = np.full(3, -np.inf)
        for i in order[begin:end]:
            for k in range(3):
                for corner in range(3):
                    low[node, k] = min(low[node, k], triangles[i, corner, k])
                    high[node, k] = max(high[node, k], triangles[i, corner, k])
                centre_low[k] = min(centre_low[k], centroid[i, k])
                centre_high[k] = max(centre_high[k], centroid[i, k])
        if end - begin <= LEAF_SIZE:
            child[node] = begin
            count[node] = end - begin
            continue
        axis = np.argmax(centre_high - centre_low)
        middle = _partition(order, centroid[:, axis], begin, end, 0.5 * (centre_low[axis] + centre_high[axis]))
        if middle in (begin, end):
            middle = (begin + end) // 2
            part = order[begin:end].copy()
            order[begin:end] = part[np.argsort(centroid[part, axis])]
        child[node] = n_nodes
        todo.append((n_nodes, begin, middle))
        todo.append((n_nodes + 1, middle, end))
        n_nodes += 2
    return low[:n_nodes].copy(), high[:n_nodes].copy(), child[:n_nodes].copy(), count[:n_nodes].copy(), order


@numba.njit(cache=True, nogil=True)
def _partition(order, key, begin, end, pivot):
    i, j = begin, end - 1
    while i <= j:
        if key[order[i]] < pivot:
            i += 1
        else:
            order[i], order[j] = order[j], order[i]
            j -= 1
    return i


@numba.njit(cache=True, nogil=True)
def box_distance_sq(low, high, node, x, y, z):
    """Squared distance from a point to a node's box, 0 inside."""
    dx = max(low[node, 0] - x, 0.0, x - high[node, 0])
    dy = max(low[node, 1] - y, 0.0, y - high[node, 1])
    dz = max(low[node, 2] - z, 0.0, z - high[node, 2])
    return dx * dx + dy * dy + dz * dz


@numba.njit(cache=True, nogil=True)
def closest_on_triangle(tri, px, py, pz):
    """Closest point of a triangle (3, 3) to a point, by the regions of its barycentric plane (`ericson2005`)."""
    ax, ay, az = tri[0, 0], tri[0, 1], tri[0, 2]
    abx, aby, abz = tri[1, 0] - ax, tri[1, 1] - ay, tri[1, 2] - az
    acx, acy, acz = tri[2, 0] - ax, tri[2, 1] - ay, tri[2, 2] - az
    apx, apy, apz = px - ax, py - ay, pz - az
    d1 = abx * apx + aby * apy + abz * apz
    d2 = acx * apx + acy * apy + acz * apz
    if d1 <= 0.0 and d2 <= 0.0:
        return ax, ay, az
    ab2 = abx * abx + aby * aby + abz * abz
    ac2 = acx * acx + acy * acy + acz * acz
    abac = abx * acx + aby * acy + abz * acz
    d3 = d1 - ab2
    d4 = d2 - abac
    if d3 >= 0.0 and d4 <= d3:
        return ax + abx, ay + aby, az + abz
    d5 = d1 - abac
    d6 = d2 - ac2
    if d6 >= 0.0 and d5 <= d6:
        return ax + acx, ay + acy, az + acz
    vc = d1 * d4 - d3 * d2
    if vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        v = d1 / (d1 - d3) if d1 != d3 else 0.0
        return ax + v * abx, ay + v * aby, az + v * abz
    vb = d5 * d2 - d1 * d6
    if vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        w = d2 / (d2 - d6) if d2 != d6 else 0.0
        return ax + w * acx, ay + w * acy, az + w * acz
    va = d3 * d6 - d5 * d4
    if va <= 0.0 and d4 >= d3 and d5 >= d6:
        span = (d4 - d3) + (d5 - d6)
        w = (d4 - d3) / span if span != 0.0 else 0.0
        return ax + abx + w * (acx - abx), ay + aby + w * (acy - aby), az + abz + w * (acz - abz)
    total = va + vb + vc
    v, w = vb / total, vc / total
    return ax + abx * v + acx * w, ay + aby * v + acy * w, az + abz * v + acz * w


@numba.njit(cache=True, nogil=True)
def closest_point(bvh, px, py, pz, max_distance):
    """Closest point of the triangles to a point: x, y, z, squared distance, face; face is -1 beyond max_distance."""
    best = max_distance * max_distance
    bx, by, bz, best_face = np.nan, np.nan, np.nan, -1
    stack = np.empty(STACK_DEPTH, np.int32)
    stack_sq = np.empty(STACK_DEPTH)
    stack[0] = 0
    stack_sq[0] = box_distance_sq(bvh.low, bvh.high, 0, px, py, pz)
    top = 1
    while top > 0:
        top -= 1
        if stack_sq[top] > best:
            continue
        node = stack[top]
        first = bvh.child[node]
        if bvh.filled[node] > 0:
            for i in range(first, first + bvh.filled[node]):
                cx, cy, cz = closest_on_triangle(bvh.triangles[i], px, py, pz)
                sq = (cx - px) ** 2 + (cy - py) ** 2 + (cz - pz) ** 2
                if sq < best or (sq == best and best_face < 0):
                    best, bx, by, bz, best_face = sq, cx, cy, cz, bvh.face[i]
            continue
        near, far = first, first + 1
        near_sq = box_distance_sq(bvh.low, bvh.high, near, px, py, pz)
        far_sq = box_distance_sq(bvh.low, bvh.high, far, px, py, pz)
        if far_sq < near_sq:
            near, far, near_sq, far_sq = far, near, far_sq, near_sq
        if far_sq <= best:
            stack[top] = far
            stack_sq[top] = far_sq
            top += 1
        if near_sq <= best:
            stack[top] = near
            stack_sq[top] = near_sq
            top += 1
    return bx, by, bz, best, best_face


@numba.njit(cache=True, nogil=True)
def _box_entry(bvh, node, ox, oy, oz, ix, iy, iz, limit):
    """Where a ray (origin, inverse direction) enters a node's box, inf where it misses it before `limit`."""
    t1, t2 = (bvh.low[node, 0] - ox) * ix, (bvh.high[node, 0] - ox) * ix
    enter, leave = min(t1, t2), max(t1, t2)
    t1, t2 = (bvh.low[node, 1] - oy) * iy, (bvh.high[node, 1] - oy) * iy
    enter, leave = max(enter, min(t1, t2)), min(leave, max(t1, t2))
    t1, t2 = (bvh.low[node, 2] - oz) * iz, (bvh.high[node, 2] - oz) * iz
    enter, leave = max(enter, min(t1, t2), 0.0), min(leave, max(t1, t2))
    # Boxes of flat faces have no thickness: a relative slack keeps rounding from losing them.
    return enter if enter <= leave * (1.0 + 1e-12) + 1e-12 and enter <= limit else np.inf


@numba.njit(cache=True, nogil=True)
def _ray_triangle(tri, ox, oy, oz, dx, dy, dz):
    """Distance along the ray to a triangle in units of the direction's length, inf where it misses (`moller1997`)."""
    ax, ay, az = tri[0, 0], tri[0, 1], tri[0, 2]
    e1x, e1y, e1z = tri[1, 0] - ax, tri[1, 1] - ay, tri[1, 2] - az
    e2x, e2y, e2z = tri[2, 0] - ax, tri[2, 1] - ay, tri[2, 2] - az
    hx, hy, hz = dy * e2z - dz * e2y, dz * e2x - dx * e2z, dx * e2y - dy * e2x
    det = e1x * hx + e1y * hy + e1z * hz
    if det == 0.0:
        return np.inf
    sx, sy, sz = ox - ax, oy - ay, oz - az
    u = (sx * hx + sy * hy + sz * hz) / det
    if u < -1e-12 or u > 1.0 + 1e-12:
        return np.inf
    qx, qy, qz = sy * e1z - sz * e1y, sz * e1x - sx * e1z, sx * e1y - sy * e1x
    v = (dx * qx + dy * qy + dz * qz) / det
    if v < -1e-12 or u + v > 1.0 + 1e-12:
        return np.inf
    t = (e2x * qx + e2y * qy + e2z * qz) / det
    return t if t >= 0.0 else np.inf


@numba.njit(cache=True, nogil=True)
def _inverse(d):
    # A finite stand-in for 1/0 keeps 0 * inf, which is nan, out of the box test.
    return 1.0 / d if abs(d) > 1e-300 else (1e300 if d >= 0.0 else -1e300)


@numba.njit(cache=True, nogil=True)
def first_hit(bvh, ox, oy, oz, dx, dy, dz, max_t):
    """First triangle along a ray: t in units of the direction's length, and the face; (inf, -1) where there is none."""
    ix, iy, iz = _inverse(dx), _inverse(dy), _inverse(dz)
    best, best_face = max_t, -1
    stack = np.empty(STACK_DEPTH, np.int32)
    stack_t = np.empty(STACK_DEPTH)
    stack[0] = 0
    stack_t[0] = _box_entry(bvh, 0, ox, oy, oz, ix, iy, iz, best)
    top = 1
    while top > 0:
        top -= 1
        if stack_t[top] > best or stack_t[top] == np.inf:
            continue
        node = stack[top]
        first = bvh.child[node]
        if bvh.filled[node] > 0:
            for i in range(first, first + bvh.filled[node]):
                t = _ray_triangle(bvh.triangles[i], ox, oy, oz, dx, dy, dz)
                if t <= best and t < np.inf:
                    best, best_face = t, bvh.face[i]
            continue
        near, far = first, first + 1
        near_t = _box_entry(bvh, near, ox, oy, oz, ix, iy, iz, best)
        far_t = _box_entry(bvh, far, ox, oy, oz, ix, iy, iz, best)
        if far_t < near_t:
            near, far, near_t, far_t = far, near, far_t, near_t
        if far_t < np.inf:
            stack[top] = far
            stack_t[top] = far_t
            top += 1
        if near_t < np.inf:
            stack[top] = near
            stack_t[top] = near_t
            top += 1
    if best_face < 0:
        return np.inf, -1
    return best, best_face
