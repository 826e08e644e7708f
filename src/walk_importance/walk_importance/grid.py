# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The voxel grid over a building."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

DOOR_M = 0.6
"""Voxels larger than this leave no free one in a narrow door."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class VoxelGrid:
    """A box of cubes; voxel (i, j, k) has its centre at `origin + (i + 0.5, j + 0.5, k + 0.5) * voxel_size_m`.

    Attributes:
        origin: (3,) lowest corner [m].
        voxel_size_m: Edge of a voxel.
        shape: Voxels along x, y, z.
    """

    origin: NDArray[np.float64]
    voxel_size_m: float
    shape: tuple[int, int, int]

    @property
    def size(self) -> int:
        """Number of voxels."""
        return self.shape[0] * self.shape[1] * self.shape[2]

    def centres(self, indices: NDArray[np.int64]) -> NDArray[np.float64]:
        """Returns the centres (N, 3) [m] of voxels (N, 3)."""
        return np.asarray(self.origin + (indices + 0.5) * self.voxel_size_m)

    def indices(self, points: NDArray[np.float64]) -> NDArray[np.int64]:
        """Returns the voxels (N, 3) that hold `points` (N, 3) [m]; points outside get the closest voxel."""
        found = np.floor((points - self.origin) / self.voxel_size_m)
        return np.asarray(np.clip(found, 0, np.array(self.shape) - 1), dtype=np.int64)


def fit_grid(bounds: NDArray[np.float64], voxel_size_m: float, max_voxels: int) -> tuple[VoxelGrid, tuple[str, ...]]:
    """Lays a grid over a box and says so if it had to be coarser than asked for.

    The lowest corner of the box is the middle of voxel (0, 0, 0): surfaces at whole multiples of the voxel size from
    it, which drawn buildings are full of, then fill one layer of voxels and not the two beside them.

    Args:
        bounds: (2, 3) lowest and highest corner of the building [m].
        voxel_size_m: Edge of a voxel as asked for.
        max_voxels: Cap on their number.

    Returns:
        The grid, and a note if the cap made it coarser.
    """
    size = voxel_size_m
    extent = bounds[1] - bounds[0]
    while np.prod(_shape(extent, size).astype(float)) > max_voxels:
        # The cube root overshoots a little because shapes are rounded up; never step by less than a percent.
        size *= max(1.01, (np.prod(_shape(extent, size).astype(float)) / max_voxels) ** (1 / 3) * 0.99)
    nx, ny, nz = (int(n) for n in _shape(extent, size))
    notes: tuple[str, ...] = ()
    closes = f"; above {DOOR_M:g} m doors may close" if size > DOOR_M else ""
    if size > voxel_size_m:
        notes = (
            f"voxels of {voxel_size_m:g} m would be more than max_voxels = {max_voxels:,}; "
            f"the grid uses {size:.3f} m, {nx * ny * nz:,} voxels{closes}",
        )
    return VoxelGrid(origin=bounds[0] - 0.5 * size, voxel_size_m=float(size), shape=(nx, ny, nz)), notes


def _shape(extent: NDArray[np.float64], size: float) -> NDArray[np.int64]:
    # A hair more than exact, so that a far side on a boundary between voxels does not ask for one more layer.
    return np.asarray(np.floor(extent / size + 0.5 - 1e-9) + 1, dtype=np.int64)
