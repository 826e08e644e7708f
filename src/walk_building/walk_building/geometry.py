# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Exact queries on a building's triangles: closest point, ray, height above the floor."""

from __future__ import annotations

import dataclasses
import itertools
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray

from walk_building.bvh import Bvh, build_bvh, closest_point, first_hit
from walk_building.errors import ParameterError

# Below this many queries the hand-over to other threads costs more than it saves.
_PARALLEL_FROM = 2048


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Closest:
    """Closest points on the geometry, one per query; inf and face -1 where none lies within the limit."""

    points: NDArray[np.float64]  # (N, 3), nan where there is none
    distance_m: NDArray[np.float64]  # (N,)
    face: NDArray[np.int32]  # (N,)


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class RayHits:
    """First hits of rays, one per query; inf and face -1 where there is none within the limit."""

    distance_m: NDArray[np.float64]  # (N,)
    face: NDArray[np.int32]  # (N,)


class Geometry:
    """A building's triangles behind exact queries. Immutable, safe to share between threads.

    Attributes:
        vertices: (V, 3) [m].
        faces: (F, 3).
        bvh: The tree, for compiled kernels of other packages.
    """

    def __init__(self, vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> None:
        if len(faces) == 0:
            raise ParameterError("faces", 0, "at least one triangle")
        self.vertices = vertices
        self.faces = faces
        self.bvh: Bvh = build_bvh(vertices, faces)

    @property
    def bounds(self) -> NDArray[np.float64]:
        """(2, 3): the lowest and the highest corner [m]."""
        return np.stack([self.bvh.low[0], self.bvh.high[0]])

    def closest(self, points: ArrayLike, max_distance_m: float = np.inf) -> Closest:
        """Returns the closest point on the geometry to each of `points` (N, 3) [m]."""
        query = as_points("points", points)
        found = np.empty((len(query), 3))
        distance = np.empty(len(query))
        face = np.empty(len(query), np.int32)
        in_chunks(_closest_batch, len(query), self.bvh, query, float(max_distance_m), found, distance, face)
        return Closest(points=found, distance_m=distance, face=face)

    def raycast(self, origins: ArrayLike, directions: ArrayLike, max_distance_m: float = np.inf) -> RayHits:
        """Returns the first hit of each ray.

        Args:
            origins: (N, 3) [m].
            directions: (N, 3) of any length but zero.
            max_distance_m: How far to look.
        """
        start = as_points("origins", origins)
        along = as_points("directions", directions)
        if start.shape != along.shape:
            raise ParameterError("directions", along.shape, f"as many as there are origins, {start.shape}")
        length = np.linalg.norm(along, axis=1)
        if not np.all(length > 0.0):
            raise ParameterError("directions", "a zero vector", "vectors of any length but zero")
        unit = np.ascontiguousarray(along / length[:, None])
        distance = np.empty(len(start))
        face = np.empty(len(start), np.int32)
        in_chunks(_ray_batch, len(start), self.bvh, start, unit, float(max_distance_m), distance, face)
        return RayHits(distance_m=distance, face=face)

    def height_above_floor(self, points: ArrayLike) -> NDArray[np.float64]:
        """Returns how far below each point (N, 3) the first surface lies, straight down [m]; inf where none does."""
        query = as_points("points", points)
        down = np.broadcast_to(np.array([0.0, 0.0, -1.0]), query.shape)
        return self.raycast(query, down).distance_m

    def drop_below(self, x: float, y: float, z: float) -> float:
        """Returns what `height_above_floor` does for one point, without its price for many."""
        return float(first_hit(self.bvh, x, y, z, 0.0, 0.0, -1.0, np.inf)[0])


def as_points(name: str, points: ArrayLike) -> NDArray[np.float64]:
    """Returns `points` as a contiguous finite (N, 3) float64 array.

    Raises:
        ParameterError: Another shape, or numbers that are not finite.
    """
    array = np.ascontiguousarray(points, dtype=np.float64)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ParameterError(name, array.shape, "an array of shape (N, 3)")
    if not np.isfinite(array).all():
        raise ParameterError(name, "nan or inf", "finite coordinates in metres")
    return array


def in_chunks(kernel: Callable[..., None], n: int, *args: object) -> None:
    """Runs `kernel(begin, end, *args)` over 0..n, on all cores where there is enough to do."""
    # The number of cores is a file to read: a tenth of a millisecond, which a single question must not cost.
    workers = 1 if n < _PARALLEL_FROM else min(os.cpu_count() or 1, n // _PARALLEL_FROM + 1)
    if workers == 1:
        kernel(0, n, *args)
        return
    # More chunks than cores, because queries near the geometry take longer than others.
    edges = np.linspace(0, n, 8 * workers + 1).astype(int)
    with ThreadPoolExecutor(workers) as pool:
        for done in [pool.submit(kernel, a, b, *args) for a, b in itertools.pairwise(edges)]:
            done.result()


@numba.njit(cache=True, nogil=True)
def _closest_batch(begin, end, bvh, query, max_distance, found, distance, face):
    for i in range(begin, end):
        x, y, z, sq, f = closest_point(bvh, query[i, 0], query[i, 1], query[i, 2], max_distance)
        found[i, 0], found[i, 1], found[i, 2] = x, y, z
        distance[i] = np.sqrt(sq) if f >= 0 else np.inf
        face[i] = f


@numba.njit(cache=True, nogil=True)
def _ray_batch(begin, end, bvh, origins, unit, max_distance, distance, face):
    for i in range(begin, end):
        o, d = origins[i], unit[i]
        distance[i], face[i] = first_hit(bvh, o[0], o[1], o[2], d[0], d[1], d[2], max_distance)
