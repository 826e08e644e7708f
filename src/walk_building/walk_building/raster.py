# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Vertical rays through every column of a grid at once: where each meets the triangles."""

from __future__ import annotations

import dataclasses

import numba
import numpy as np
from numpy.typing import NDArray

# An offset of the columns that no drawing uses, so that rays run along no edge or wall of a drawn grid.
_OFFSET_SHARE = 0.5 + 0.0137


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Columns:
    """A grid of vertical lines; line (i, j) stands at `origin + (i, j) * cell_m`."""

    origin: NDArray[np.float64]  # (2,) of column (0, 0) [m]
    cell_m: float
    shape: tuple[int, int]

    @classmethod
    def over(cls, bounds: NDArray[np.float64], cell_m: float, margin_cells: int = 2) -> Columns:
        """Returns the columns that cover `bounds` (2, 3) and a margin around it."""
        start = np.floor(bounds[0, :2] / cell_m) - margin_cells
        end = np.ceil(bounds[1, :2] / cell_m) + margin_cells
        nx, ny = (end - start).astype(int)
        return cls(origin=(start + _OFFSET_SHARE) * cell_m, cell_m=cell_m, shape=(int(nx), int(ny)))

    @property
    def count(self) -> int:
        """How many columns there are."""
        return self.shape[0] * self.shape[1]

    def flat_of(self, xy: NDArray[np.float64]) -> NDArray[np.int64]:
        """Returns the index i * ny + j of the column nearest to each point (N, 2), -1 outside of the grid."""
        ij = np.rint((xy - self.origin) / self.cell_m).astype(np.int64)
        inside = np.all((ij >= 0) & (ij < self.shape), axis=1)
        return np.where(inside, ij[:, 0] * self.shape[1] + ij[:, 1], -1)


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Hits:
    """What the vertical rays meet, lowest first: those of column c are `start[c] : start[c + 1]`."""

    start: NDArray[np.int64]  # (columns + 1,)
    z: NDArray[np.float64]  # (H,) [m]
    face: NDArray[np.int32]  # (H,)


def cast_columns(columns: Columns, vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> Hits:
    """Returns where each column's line meets the triangles. Upright triangles are met by none."""
    triangles = np.ascontiguousarray(vertices[faces], dtype=np.float64)
    local = triangles.copy()
    local[:, :, :2] = (triangles[:, :, :2] - columns.origin) / columns.cell_m
    start, z, face = _cast(local, columns.shape[0], columns.shape[1])
    return Hits(start=start, z=z, face=face)


@numba.njit(cache=True, nogil=True)
def _height(tri, i, j):
    """Height of a triangle over the grid point (i, j), nan where it is not above or below it."""
    ax, ay = tri[0, 0] - i, tri[0, 1] - j
    bx, by = tri[1, 0] - i, tri[1, 1] - j
    cx, cy = tri[2, 0] - i, tri[2, 1] - j
    u, v, w = bx * cy - by * cx, cx * ay - cy * ax, ax * by - ay * bx
    total = u + v + w
    if total == 0.0 or not ((u >= 0.0 and v >= 0.0 and w >= 0.0) or (u <= 0.0 and v <= 0.0 and w <= 0.0)):
        return np.nan
    return (u * tri[0, 2] + v * tri[1, 2] + w * tri[2, 2]) / total


@numba.njit(cache=True, nogil=True)
def _span(tri, axis, n):
    low = min(tri[0, axis], tri[1, axis], tri[2, axis])
    high = max(tri[0, axis], tri[1, axis], tri[2, axis])
    return max(int(np.ceil(low)), 0), min(int(np.floor(high)), n - 1)


@numba.njit(cache=True, nogil=True)
def _cast(triangles, nx, ny):
    start = np.zeros(nx * ny + 1, np.int64)
    for f in range(triangles.shape[0]):
        i0, i1 = _span(triangles[f], 0, nx)
        j0, j1 = _span(triangles[f], 1, ny)
        for i in range(i0, i1 + 1):
            for j in range(j0, j1 + 1):
                if not np.isnan(_height(triangles[f], i, j)):
                    start[i * ny + j + 1] += 1
    for c in range(nx * ny):
        start[c + 1] += start[c]
    z = np.empty(start[-1])
    face = np.empty(start[-1], np.int32)
    fill = start[:-1].copy()
    for f in range(triangles.shape[0]):
        i0, i1 = _span(triangles[f], 0, nx)
        j0, j1 = _span(triangles[f], 1, ny)
        for i in range(i0, i1 + 1):
            for j in range(j0, j1 + 1):
                height = _height(triangles[f], i, j)
                if np.isnan(height):
                    continue
                c = i * ny + j
                k = fill[c]
                # Insertion keeps each column sorted; columns hold a few dozen hits at most.
                while k > start[c] and z[k - 1] > height:
                    z[k], face[k] = z[k - 1], face[k - 1]
                    k -= 1
                z[k], face[k] = height, f
                fill[c] += 1
    return start, z, face
