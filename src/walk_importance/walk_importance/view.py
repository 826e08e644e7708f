# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Where to look from a keypoint, and what floor is seen from it (our own)."""

from __future__ import annotations

import functools
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numba
import numpy as np
from numpy.typing import NDArray

from walk_building.bvh import first_hit
from walk_building.geometry import Geometry
from walk_importance.importance_map import ImportanceMap

_YAWS = 72
_PITCHES_RAD = (np.radians(-20.0), 0.0, np.radians(15.0))
_FIELD_OF_VIEW_RAD = np.radians(90.0)  # what a headset shows at once
_FAR_M = 15.0
_STEPS = 15
_WORTH_SHARING = 200  # rays; fewer are cast before another thread has begun
_TOUCH_M = 1e-6  # a surface this near the target is the target's own


def view_yaws(geometry: Geometry, importance_map: ImportanceMap, eyes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the yaw (K,) [rad] from each eye (K, 3) in whose field of view the most importance is seen.

    Rays go out all around against the triangles; along each, as far as it gets, up to 15 m, importance above the
    map's lowest is summed up; the best window of 90 degrees wins.
    """
    yaw = np.arange(_YAWS) * (2 * np.pi / _YAWS)
    grid, importance = importance_map.grid, importance_map.importance
    gain = np.zeros((len(eyes), _YAWS))
    floor = importance.min()

    def look(low: int, high: int) -> None:
        some, into = eyes[low:high], gain[low:high]
        _look_around(geometry.bvh, some, yaw, importance, grid.origin, grid.voxel_size_m, floor, into)

    _share_out(look, len(eyes))
    half = round(_FIELD_OF_VIEW_RAD / (2 * np.pi) * _YAWS / 2)
    window = sum(np.roll(gain, shift, axis=1) for shift in range(-half, half + 1))
    return np.asarray(yaw[np.argmax(window, axis=1)])


@numba.njit(cache=True, nogil=True)
def _look_around(bvh, eyes, yaws, importance, origin, voxel_size, floor, gain):
    """Adds to `gain` (K, yaws) the importance above `floor` along the rays of each yaw, at all pitches."""
    for k in range(len(eyes)):
        x, y, z = eyes[k, 0], eyes[k, 1], eyes[k, 2]
        for i in range(len(yaws)):
            for pitch in _PITCHES_RAD:
                dx, dy, dz = np.cos(pitch) * np.cos(yaws[i]), np.cos(pitch) * np.sin(yaws[i]), np.sin(pitch)
                reach, _ = first_hit(bvh, x, y, z, dx, dy, dz, _FAR_M)
                for step in range(_STEPS):
                    away = (step + 0.5) * _FAR_M / _STEPS
                    if away >= reach:
                        break
                    a = _voxel(x + away * dx, origin[0], voxel_size, importance.shape[0])
                    b = _voxel(y + away * dy, origin[1], voxel_size, importance.shape[1])
                    c = _voxel(z + away * dz, origin[2], voxel_size, importance.shape[2])
                    gain[k, i] += importance[a, b, c] - floor


@numba.njit(cache=True, nogil=True)
def _voxel(at, origin, voxel_size, count):
    return min(max(int(np.floor((at - origin) / voxel_size)), 0), count - 1)


def quat_xyzw_from_yaw(yaw: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the rotations (K, 4) about z that turn the x axis to each yaw (K,)."""
    zero = np.zeros_like(yaw)
    return np.stack([zero, zero, np.sin(yaw / 2), np.cos(yaw / 2)], axis=1)


def sees(
    geometry: Geometry, eye: NDArray[np.float64], targets: NDArray[np.float64], distance_m: float
) -> NDArray[np.bool_]:
    """Returns which of `targets` (N, 3) an eye (3,) sees, no farther than `distance_m`."""
    seen = np.zeros(len(targets), bool)

    def look(low: int, high: int) -> None:
        _see(geometry.bvh, eye, targets[low:high], distance_m, seen[low:high])

    if len(targets) < _WORTH_SHARING:
        look(0, len(targets))
    else:
        _share_out(look, len(targets))
    return seen


def _share_out(work: Callable[[int, int], None], count: int) -> None:
    """Runs compiled work on ranges of `count` rows, on all cores."""
    cuts = np.linspace(0, count, _threads() + 1).astype(int).tolist()
    list(_pool().map(work, cuts[:-1], cuts[1:]))


def _threads() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@functools.cache
def _pool() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(_threads(), thread_name_prefix="view")


@numba.njit(cache=True, nogil=True)
def _see(bvh, eye, targets, reach, seen):
    """Sets in `seen` (N,) what an eye (3,) sees of `targets` (N, 3), no farther than `reach`; what is set stays."""
    for i in range(len(targets)):
        x, y, z = targets[i, 0] - eye[0], targets[i, 1] - eye[1], targets[i, 2] - eye[2]
        length = np.sqrt(x * x + y * y + z * z)
        if seen[i] or length > reach:
            continue
        if length <= _TOUCH_M:
            seen[i] = True
            continue
        # The direction is as long as the way, so 1 is the target itself.
        hit, _ = first_hit(bvh, eye[0], eye[1], eye[2], x, y, z, 1.0 - _TOUCH_M / length)
        seen[i] = hit == np.inf
