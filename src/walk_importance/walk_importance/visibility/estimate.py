# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What every mode of visibility takes and gives."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from walk_building.geometry import Geometry
from walk_importance.grid import VoxelGrid


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """What sees and what is seen.

    Attributes:
        grid: The grid.
        free: (nx, ny, nz) bool; a line of sight passes through free voxels only, whatever they count as.
        targets: (nx, ny, nz) bool, subset of `free`: what there is to see.
        sources: (nx, ny, nz) bool, subset of `targets`: voxels whose view is computed.
        geometry: The triangles, for the mode that asks them.
        seed: Of the order in which displacements are sampled, for the mode that does.
    """

    grid: VoxelGrid
    free: NDArray[np.bool_]
    targets: NDArray[np.bool_]
    sources: NDArray[np.bool_]
    geometry: Geometry | None = None
    seed: int = 0

    @staticmethod
    def of(grid: VoxelGrid, free: NDArray[np.bool_], seed: int = 0) -> Scene:
        """Returns the source's scene: all free voxels look at all free voxels."""
        return Scene(grid=grid, free=free, targets=free, sources=free, seed=seed)


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class VisibilityEstimate:
    """A visibility map, final or on its way.

    Attributes:
        share: (nx, ny, nz) float32, share of the other target voxels that is seen, 0 outside the sources.
        stderr: Standard error of `share`, root mean square over the sources; 0 when every pair was asked.
        spread: Standard deviation of `share` over the sources.
        done: Share of the displacements (or pairs) asked so far.
        pairs: Pairs of voxels answered so far.
    """

    share: NDArray[np.float32]
    stderr: float
    spread: float
    done: float
    pairs: float


def estimate(scene: Scene, seen: NDArray[np.float32], variance: float, done: float, pairs: float) -> VisibilityEstimate:
    """Turns numbers of seen voxels (nx, ny, nz), which are overwritten, and their mean variance into an estimate."""
    others = max(int(scene.targets.sum()) - 1, 1)
    share = seen
    share[~scene.sources] = 0
    share /= np.float32(others)
    inside = share[scene.sources]
    return VisibilityEstimate(
        share=share,
        stderr=float(np.sqrt(variance) / others),
        spread=float(inside.std(dtype=np.float64)) if len(inside) else 0.0,
        done=done,
        pairs=pairs,
    )
