# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The importance map: three maps and their weighted sum."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from walk_importance.config import ImportanceConfig
from walk_importance.grid import VoxelGrid


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class ImportanceMap:
    """The maps over one grid, each (nx, ny, nz) float32, read-only.

    Attributes:
        grid: The voxels.
        obstacle: M_obs, 1 where the voxel meets geometry, else 0.
        distance: M_dist, distance to obstacles other than floors and ceilings, 0..1.
        visibility: M_vis, share of the free voxels that is seen, 0..1.
        importance: The weighted sum.
        visibility_stderr: Standard error of `visibility`; 0 where it is exact.
        notes: Sentences for the user, such as that the grid is coarser than asked for.
    """

    grid: VoxelGrid
    obstacle: NDArray[np.float32]
    distance: NDArray[np.float32]
    visibility: NDArray[np.float32]
    importance: NDArray[np.float32]
    visibility_stderr: float
    notes: tuple[str, ...]

    def at(self, points: NDArray[np.float64]) -> NDArray[np.float32]:
        """Returns the importance of the voxels that hold `points` (N, 3) [m]."""
        return self.importance[tuple(self.grid.indices(points).T)]


def weigh(
    obstacle: NDArray[np.float32],
    distance: NDArray[np.float32],
    visibility: NDArray[np.float32],
    config: ImportanceConfig,
) -> NDArray[np.float32]:
    """Importance = λ_obs (1 - M_obs) + λ_dist M_dist + λ_vis M_vis (`schmidiger`)."""
    importance = np.float32(config.weight_obstacle) * (1 - obstacle)
    importance += np.float32(config.weight_distance) * distance
    importance += np.float32(config.weight_visibility) * visibility
    importance.setflags(write=False)
    return importance


def reweigh(importance_map: ImportanceMap, config: ImportanceConfig) -> ImportanceMap:
    """Returns the map with other weights; the three maps, which do not depend on them, are shared."""
    m = importance_map
    return dataclasses.replace(m, importance=weigh(m.obstacle, m.distance, m.visibility, config))
