# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Which voxels a line of sight touches: the supercover of the segment between two voxel centres."""

from __future__ import annotations

import numba


@numba.njit(cache=True, nogil=True)
def supercover(dx, dy, dz, stride_x, stride_y, stride_z, cells):
    """Writes the linear offsets of all voxels the segment from (0, 0, 0) to (dx, dy, dz) touches; returns their number.

    A voxel is closed: where the segment passes through an edge or a corner, every voxel that shares it is touched,
    so nothing is seen through the crack between two obstacles. Crossings are compared in whole numbers: the k-th
    boundary along an axis is crossed at (2k + 1) / (2 |d|), and two of them are ordered by their cross products.

    Args:
        dx: The displacement along x in voxels.
        dy: Along y.
        dz: Along z.
        stride_x: What one voxel along x adds to the offset.
        stride_y: Along y.
        stride_z: Along z.
        cells: (M,) int64, M >= 3 (|dx| + |dy| + |dz|) + 1, written from the start.
    """
    ax, ay, az = abs(dx), abs(dy), abs(dz)
    sx = stride_x if dx >= 0 else -stride_x
    sy = stride_y if dy >= 0 else -stride_y
    sz = stride_z if dz >= 0 else -stride_z
    kx, ky, kz = 1, 1, 1  # 2k + 1 of the next boundary along each axis
    at, n = 0, 1
    cells[0] = 0
    while kx < 2 * ax or ky < 2 * ay or kz < 2 * az:
        more_x, more_y, more_z = kx < 2 * ax, ky < 2 * ay, kz < 2 * az
        # An axis steps when no other axis that still has boundaries crosses one earlier.
        step_x = more_x and not (more_y and ky * ax < kx * ay) and not (more_z and kz * ax < kx * az)
        step_y = more_y and not (more_x and kx * ay < ky * ax) and not (more_z and kz * ay < ky * az)
        step_z = more_z and not (more_x and kx * az < kz * ax) and not (more_y and ky * az < kz * ay)
        mx = sx if step_x else 0
        my = sy if step_y else 0
        mz = sz if step_z else 0
        if step_x + step_y + step_z > 1:
            n = _touched_at_edge(at, mx, my, mz, cells, n)
        at += mx + my + mz
        cells[n] = at
        n += 1
        kx += 2 * step_x
        ky += 2 * step_y
        kz += 2 * step_z
    return n


@numba.njit(cache=True, nogil=True)
def _touched_at_edge(at, mx, my, mz, cells, n):
    """Adds the voxels beside a crossing of two or three boundaries at once, without the one it leads into."""
    for mask in range(1, 7):
        ix, iy, iz = mask & 1, (mask >> 1) & 1, (mask >> 2) & 1
        # Only true parts of the step: no axis that does not move, not all of those that do.
        if (ix and mx == 0) or (iy and my == 0) or (iz and mz == 0):
            continue
        if (ix or mx == 0) and (iy or my == 0) and (iz or mz == 0):
            continue
        cells[n] = at + ix * mx + iy * my + iz * mz
        n += 1
    return n
