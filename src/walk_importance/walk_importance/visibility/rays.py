# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Visibility the source's way, a ray for every pair: the oracle of the other modes and the bench's reference."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor

import numba
import numpy as np
from numpy.typing import NDArray

from walk_building.bvh import first_hit
from walk_importance.visibility.estimate import Scene, VisibilityEstimate, estimate


def ray_visibility(scene: Scene) -> Iterator[VisibilityEstimate]:
    """Yields the visibility map once, by rays between voxel centres against the triangles.

    Free voxels that a wall thinner than a voxel parts see each other here no more than in reality; apart from
    that the word-parallel modes ask the same of the voxels instead. Takes a microsecond a pair, so hours for a
    house at 0.25 m.
    """
    sources = np.argwhere(scene.sources)
    yield _as_estimate(scene, sources, count_triangle_rays(scene, sources))


def voxel_ray_visibility(scene: Scene) -> Iterator[VisibilityEstimate]:
    """Yields the visibility map once, by a scalar walk from voxel to voxel for every pair.

    The same definition of seeing as in the exact mode, by another algorithm: each axis's next boundary is compared
    in whole numbers, and the walk ends at the first obstacle.
    """
    sources = np.argwhere(scene.sources)
    seen = count_voxel_rays(scene, sources)
    yield _as_estimate(scene, sources, seen)


def count_voxel_rays(scene: Scene, sources: NDArray[np.int64]) -> NDArray[np.int64]:
    """Returns the number of other target voxels that each of `sources` (N, 3) sees, by scalar voxel walks."""
    return in_chunks(_voxel_rays, len(sources), np.ascontiguousarray(scene.free), sources, np.argwhere(scene.targets))


def count_triangle_rays(scene: Scene, sources: NDArray[np.int64]) -> NDArray[np.int64]:
    """Returns the number of other target voxels that each of `sources` (N, 3) sees, by rays against the triangles."""
    assert scene.geometry is not None
    start, goal = scene.grid.centres(sources), scene.grid.centres(np.argwhere(scene.targets))
    return in_chunks(_triangle_rays, len(sources), scene.geometry.bvh, start, goal)


def in_chunks(kernel: Callable[..., None], n: int, *args: object) -> NDArray[np.int64]:
    """Returns what `kernel(begin, end, *args, seen)` writes for 0..n, on all cores."""
    seen = np.zeros(n, np.int64)
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    edges = np.linspace(0, n, 16 * cores + 1).astype(int)
    with ThreadPoolExecutor(cores) as pool:
        list(pool.map(lambda i: kernel(edges[i], edges[i + 1], *args, seen), range(16 * cores)))
    return seen


def _as_estimate(scene: Scene, sources: NDArray[np.int64], seen: NDArray[np.int64]) -> VisibilityEstimate:
    counts = np.zeros(scene.grid.shape, np.float32)
    counts[tuple(sources.T)] = seen
    n = float(scene.targets.sum())
    return estimate(scene, counts, 0.0, 1.0, n * (n - 1) / 2)


@numba.njit(cache=True, nogil=True)
def _triangle_rays(begin, end, bvh, start, goal, seen):
    for i in range(begin, end):
        x, y, z = start[i]
        n = -1  # itself
        for j in range(len(goal)):
            dx, dy, dz = goal[j, 0] - x, goal[j, 1] - y, goal[j, 2] - z
            if first_hit(bvh, x, y, z, dx, dy, dz, 1.0)[1] < 0:
                n += 1
        seen[i] = n


@numba.njit(cache=True, nogil=True)
def _voxel_rays(begin, end, free, sources, targets, seen):
    flat = free.reshape(-1)
    stride_y = free.shape[2]
    stride_x = free.shape[1] * stride_y
    for i in range(begin, end):
        x, y, z = sources[i]
        at = x * stride_x + y * stride_y + z
        n = -1  # itself
        for j in range(len(targets)):
            n += _voxel_ray(flat, at, targets[j, 0] - x, targets[j, 1] - y, targets[j, 2] - z, stride_x, stride_y)
        seen[i] = n


@numba.njit(cache=True, nogil=True)
def _voxel_ray(flat, at, dx, dy, dz, stride_x, stride_y):
    """Whether all voxels that the segment from voxel `at` by (dx, dy, dz) touches are free; 0 or 1."""
    ax, ay, az = abs(dx), abs(dy), abs(dz)
    jx = stride_x if dx > 0 else -stride_x
    jy = stride_y if dy > 0 else -stride_y
    jz = 1 if dz > 0 else -1
    # Time runs in units of 1 / (2 ax ay az), zeros taken as one: the next crossing and the time between two.
    px, py, pz = max(ax, 1), max(ay, 1), max(az, 1)
    stop = 2 * px * py * pz
    tx, wx = (py * pz, 2 * py * pz) if ax else (stop + 1, 0)
    ty, wy = (px * pz, 2 * px * pz) if ay else (stop + 1, 0)
    tz, wz = (px * py, 2 * px * py) if az else (stop + 1, 0)
    while True:
        if tx < ty and tx < tz:
            if tx > stop:
                return 1
            at += jx
            tx += wx
        elif ty < tx and ty < tz:
            if ty > stop:
                return 1
            at += jy
            ty += wy
        elif tz < tx and tz < ty:
            if tz > stop:
                return 1
            at += jz
            tz += wz
        else:
            t = min(tx, ty, tz)
            if t > stop:
                return 1
            mx, my, mz = jx * (tx == t), jy * (ty == t), jz * (tz == t)
            if not _edge_free(flat, at, mx, my, mz):
                return 0
            at += mx + my + mz
            tx += wx * (tx == t)
            ty += wy * (ty == t)
            tz += wz * (tz == t)
        if not flat[at]:
            return 0


@numba.njit(cache=True, nogil=True)
def _edge_free(flat, at, mx, my, mz):
    """Whether the voxels beside a crossing of two or three boundaries at once are free."""
    if not ((mx == 0 or flat[at + mx]) and (my == 0 or flat[at + my]) and (mz == 0 or flat[at + mz])):
        return False
    if mx == 0 or my == 0 or mz == 0:
        return True
    return flat[at + mx + my] and flat[at + mx + mz] and flat[at + my + mz]
