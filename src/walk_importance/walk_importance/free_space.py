# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Which free voxels count: indoors, and around a walker's eye (our own)."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_importance.grid import VoxelGrid

_OVER_FURNITURE_M = 1.5  # air this far beside a place to stand, past furniture, is still the room's


def indoor_voxels(building: Building, grid: VoxelGrid, free: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Returns the free voxels indoors, (nx, ny, nz) bool.

    The air above every indoor place a walker can stand on, up to the first obstacle, and the free voxels that are
    reached from it by going level for at most 1.5 m: the air above furniture and beside walls. Through an open
    facade that lets as much of the outside in.
    """
    places = building.surface.places[building.surface.indoor]
    low = np.zeros(grid.shape, bool)
    # A step up, the voxel of the floor itself is behind.
    found = grid.indices(places + np.array([0.0, 0.0, max(building.walker.step_m, 1.01 * grid.voxel_size_m)]))
    low[tuple(found.T)] = True
    inside = low & free
    _rise(inside, free)
    return _spread_level(inside, free, round(_OVER_FURNITURE_M / grid.voxel_size_m))


@numba.njit(cache=True, nogil=True)
def _rise(inside, free):
    for i in range(free.shape[0]):
        for j in range(free.shape[1]):
            for k in range(1, free.shape[2]):
                if inside[i, j, k - 1] and free[i, j, k]:
                    inside[i, j, k] = True


def _spread_level(inside: NDArray[np.bool_], free: NDArray[np.bool_], steps: int) -> NDArray[np.bool_]:
    for _ in range(steps):
        wider = inside.copy()
        wider[1:] |= inside[:-1]
        wider[:-1] |= inside[1:]
        wider[:, 1:] |= inside[:, :-1]
        wider[:, :-1] |= inside[:, 1:]
        inside = wider & free
    return inside


def eye_voxels(building: Building, grid: VoxelGrid, free: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Returns the free voxels within a voxel of where a walker's eye can be, (nx, ny, nz) bool."""
    near = np.zeros(grid.shape, bool)
    eyes = grid.indices(building.eyes(np.flatnonzero(building.reachable)))
    for dx in (-1, 0, 1):
        for dy in (-1, 0, 1):
            for dz in (-1, 0, 1):
                near[tuple(np.clip(eyes + (dx, dy, dz), 0, np.array(grid.shape) - 1).T)] = True
    return near & free
