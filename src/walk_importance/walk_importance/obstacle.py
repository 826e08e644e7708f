# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The obstacle map: which voxels meet the building's triangles."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from walk_importance.grid import VoxelGrid


def obstacle_voxels(grid: VoxelGrid, triangles: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Returns the voxels that meet a triangle, exactly, up to a millionth of a voxel on the safe side.

    Args:
        grid: The grid.
        triangles: (F, 3, 3) corners [m].

    Returns:
        (nx, ny, nz) bool.
    """
    scaled = np.ascontiguousarray((triangles - grid.origin) / grid.voxel_size_m)
    found = np.zeros(grid.shape, bool)
    _voxelise(scaled, found)
    return found


@numba.njit(cache=True, nogil=True)
def _voxelise(triangles, found):
    """Tests the separating axes of triangle and unit cube (`akenine2001`): cube's sides, normal, nine edge products."""
    slack = 1e-6
    lo = np.empty(3, np.int64)
    hi = np.empty(3, np.int64)
    axes = np.empty((10, 3))
    low = np.empty(10)  # where the triangle, widened by half a cube, begins and ends on each axis
    high = np.empty(10)
    for f in range(len(triangles)):
        t = triangles[f]
        for k in range(3):
            lo[k] = max(0, int(np.floor(min(t[0, k], t[1, k], t[2, k]) - slack)))
            hi[k] = min(found.shape[k] - 1, int(np.floor(max(t[0, k], t[1, k], t[2, k]) + slack)))
        _axes(t, axes, low, high, slack)
        for i in range(lo[0], hi[0] + 1):
            for j in range(lo[1], hi[1] + 1):
                for k in range(lo[2], hi[2] + 1):
                    if not found[i, j, k] and _meets(axes, low, high, i + 0.5, j + 0.5, k + 0.5):
                        found[i, j, k] = True


@numba.njit(cache=True, nogil=True)
def _axes(t, axes, low, high, slack):
    for e in range(3):
        d = t[(e + 1) % 3] - t[e]
        # The products of the edge with x, y and z.
        axes[3 * e, 0], axes[3 * e, 1], axes[3 * e, 2] = 0.0, -d[2], d[1]
        axes[3 * e + 1, 0], axes[3 * e + 1, 1], axes[3 * e + 1, 2] = d[2], 0.0, -d[0]
        axes[3 * e + 2, 0], axes[3 * e + 2, 1], axes[3 * e + 2, 2] = -d[1], d[0], 0.0
    a, b = t[1] - t[0], t[2] - t[0]
    axes[9, 0] = a[1] * b[2] - a[2] * b[1]
    axes[9, 1] = a[2] * b[0] - a[0] * b[2]
    axes[9, 2] = a[0] * b[1] - a[1] * b[0]
    for m in range(10):
        x, y, z = axes[m, 0], axes[m, 1], axes[m, 2]
        reach = (0.5 + slack) * (abs(x) + abs(y) + abs(z))
        p0 = x * t[0, 0] + y * t[0, 1] + z * t[0, 2]
        p1 = x * t[1, 0] + y * t[1, 1] + z * t[1, 2]
        p2 = x * t[2, 0] + y * t[2, 1] + z * t[2, 2]
        low[m] = min(p0, p1, p2) - reach
        high[m] = max(p0, p1, p2) + reach


@numba.njit(cache=True, nogil=True)
def _meets(axes, low, high, x, y, z):
    for m in range(10):
        p = axes[m, 0] * x + axes[m, 1] * y + axes[m, 2] * z
        if p < low[m] or p > high[m]:
            return False
    return True
