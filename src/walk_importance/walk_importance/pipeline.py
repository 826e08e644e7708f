# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From a building to its importance map."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_building.progress import Progress, no_progress
from walk_importance.config import ImportanceConfig
from walk_importance.distance import distance_map, floor_and_ceiling_faces
from walk_importance.errors import NoFreeVoxelError
from walk_importance.free_space import eye_voxels, indoor_voxels
from walk_importance.grid import VoxelGrid, fit_grid
from walk_importance.importance_map import ImportanceMap, weigh
from walk_importance.obstacle import obstacle_voxels
from walk_importance.visibility import MODES, Scene, VisibilityEstimate

_STAGE = "importance"


def compute_importance(
    building: Building, config: ImportanceConfig | None = None, progress: Progress = no_progress
) -> ImportanceMap:
    """Returns the importance map, its visibility as good as `config` asks for.

    Raises:
        NoFreeVoxelError: Every voxel meets geometry.
    """
    *_, last = refine_importance(building, config, progress)
    return last


def refine_importance(
    building: Building, config: ImportanceConfig | None = None, progress: Progress = no_progress
) -> Iterator[ImportanceMap]:
    """Yields importance maps of growing accuracy; with `progressive` visibility the first comes within a second.

    Raises:
        NoFreeVoxelError: Every voxel meets geometry.
    """
    config = config or ImportanceConfig()
    progress(_STAGE, 0.0)
    grid, notes = fit_grid(building.geometry.bounds, config.voxel_size_m, config.max_voxels)
    blocked, obstacle, distance = _geometry_maps(building, grid, config)
    progress(_STAGE, 0.2)
    scene = _scene(building, grid, ~blocked, config)
    for view in MODES[config.visibility](scene):
        progress(_STAGE, _how_far(view, config))
        yield ImportanceMap(
            grid=grid,
            obstacle=obstacle,
            distance=distance,
            visibility=_sealed(view.share),
            importance=weigh(obstacle, distance, view.share, config),
            visibility_stderr=view.stderr,
            notes=notes,
        )
        if _good_enough(view, config):
            return


def _good_enough(view: VisibilityEstimate, config: ImportanceConfig) -> bool:
    return view.done >= 1.0 or view.stderr <= config.visibility_error * view.spread


def _how_far(view: VisibilityEstimate, config: ImportanceConfig) -> float:
    # The error halves with four times the work, hence the square.
    if _good_enough(view, config):
        return 1.0
    return 0.2 + 0.8 * max(view.done, min(1.0, config.visibility_error * view.spread / view.stderr) ** 2)


def _geometry_maps(
    building: Building, grid: VoxelGrid, config: ImportanceConfig
) -> tuple[NDArray[np.bool_], NDArray[np.float32], NDArray[np.float32]]:
    """The voxels that meet geometry, the obstacle map and the distance map."""
    triangles = building.model.vertices[building.model.faces]
    level = floor_and_ceiling_faces(building.model, config.floor_area_m2)
    upright = obstacle_voxels(grid, triangles[~level])
    blocked = upright | obstacle_voxels(grid, triangles[level])
    if blocked.all():
        raise NoFreeVoxelError(grid.voxel_size_m)
    distance = distance_map(grid, upright, config.distance_clip_m)
    return blocked, _sealed(blocked.astype(np.float32)), _sealed(distance)


def visibility_scene(building: Building, config: ImportanceConfig) -> Scene:
    """Returns the question that the modes of visibility answer for a building, for measuring and testing them."""
    grid, _ = fit_grid(building.geometry.bounds, config.voxel_size_m, config.max_voxels)
    triangles = building.model.vertices[building.model.faces]
    return _scene(building, grid, ~obstacle_voxels(grid, triangles), config)


def _scene(building: Building, grid: VoxelGrid, free: NDArray[np.bool_], config: ImportanceConfig) -> Scene:
    targets = indoor_voxels(building, grid, free) if config.free_space == "indoors" else free
    if not targets.any():
        raise NoFreeVoxelError(grid.voxel_size_m)
    sources = targets
    if config.visibility_sources == "eye":
        sources = eye_voxels(building, grid, free) & targets
    return Scene(grid=grid, free=free, targets=targets, sources=sources, geometry=building.geometry, seed=config.seed)


def _sealed(array: NDArray[np.float32]) -> NDArray[np.float32]:
    array.setflags(write=False)
    return array
