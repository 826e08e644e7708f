# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Where to look from a keypoint, and what floor is seen from it (our own)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from walk_building.geometry import Geometry
from walk_importance.importance_map import ImportanceMap

_YAWS = 72
_PITCHES_RAD = np.radians([-20.0, 0.0, 15.0])
_FIELD_OF_VIEW_RAD = np.radians(90.0)  # what a headset shows at once
_FAR_M = 15.0
_STEPS = 15


def view_yaws(geometry: Geometry, importance_map: ImportanceMap, eyes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the yaw (K,) [rad] from each eye (K, 3) in whose field of view the most importance is seen.

    Rays go out all around against the triangles; along each, as far as it gets, up to 15 m, importance above the
    map's lowest is summed up; the best window of 90 degrees wins.
    """
    yaw = np.arange(_YAWS) * (2 * np.pi / _YAWS)
    grid_yaw, grid_pitch = np.meshgrid(yaw, _PITCHES_RAD, indexing="ij")
    flat = np.cos(grid_pitch)
    ahead = np.stack([flat * np.cos(grid_yaw), flat * np.sin(grid_yaw), np.sin(grid_pitch)], axis=-1)
    directions = ahead.reshape(-1, 3)
    rays = len(directions)
    origins = np.repeat(eyes, rays, axis=0)
    ahead = np.tile(directions, (len(eyes), 1))
    reach = np.minimum(geometry.raycast(origins, ahead, _FAR_M).distance_m, _FAR_M)
    floor = float(importance_map.importance.min())
    gain = np.zeros(len(origins))
    for step in range(_STEPS):
        away = (step + 0.5) * _FAR_M / _STEPS
        seen = away < reach
        gain[seen] += importance_map.at(origins[seen] + away * ahead[seen]) - floor
    around = gain.reshape(len(eyes), _YAWS, len(_PITCHES_RAD)).sum(axis=2)
    half = round(_FIELD_OF_VIEW_RAD / (2 * np.pi) * _YAWS / 2)
    window = sum(np.roll(around, shift, axis=1) for shift in range(-half, half + 1))
    return np.asarray(yaw[np.argmax(window, axis=1)])


def quat_xyzw_from_yaw(yaw: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the rotations (K, 4) about z that turn the x axis to each yaw (K,)."""
    zero = np.zeros_like(yaw)
    return np.stack([zero, zero, np.sin(yaw / 2), np.cos(yaw / 2)], axis=1)


def sees(
    geometry: Geometry, eye: NDArray[np.float64], targets: NDArray[np.float64], distance_m: float
) -> NDArray[np.bool_]:
    """Returns which of `targets` (N, 3) an eye (3,) sees, no farther than `distance_m`."""
    along = targets - eye
    length = np.linalg.norm(along, axis=1)
    seen = length <= 1e-6
    ask = np.flatnonzero((length > 1e-6) & (length <= distance_m))
    if len(ask):
        hit = geometry.raycast(np.broadcast_to(eye, (len(ask), 3)), along[ask], distance_m).distance_m
        seen[ask] = hit >= length[ask] - 1e-6
    return np.asarray(seen)
