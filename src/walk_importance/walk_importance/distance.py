# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The distance map: how far the closest obstacle is, floors and ceilings left out."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from walk_building.model import Model
from walk_importance.grid import VoxelGrid

# What a walker walks on or under. The source leaves out floors and ceilings; stairs and ramps are floors that climb.
_FLOOR_CLASSES = ("IfcSlab", "IfcRoof", "IfcStair", "IfcRamp", "IfcPlate", "IfcFooting", "IfcSite")
_LEVEL_DEG = 40.0  # a steeper face of an unlabelled mesh is a wall; the steepest slope a walker takes by default
_NARROW_M = 0.3  # a level piece narrower than this is the top of a wall, however long it is
_WELD_M = 1e-4  # corners closer than this are one


def floor_and_ceiling_faces(model: Model, floor_area_m2: float) -> NDArray[np.bool_]:
    """Returns which faces are floors or ceilings, (F,) bool.

    Slabs, roofs, stairs and ramps are, by class. Coverings are where they are level: they also clad walls. In a mesh
    without classes those are whose faces are level, hang together over at least `floor_area_m2`, and are
    wide: twice the area over the length of the outline is the width of a strip, and a wall's top is a strip.
    """
    kind = np.full(len(model.faces), 2, np.int8)  # 0 obstacle, 1 floor, 2 ask the shape, 3 floor where it is level
    for part in model.parts:
        kind[part.first_face : part.first_face + part.n_faces] = _rule(part.kind)
    level = _level_faces(model.vertices, model.faces)
    found = np.asarray((kind == 1) | ((kind == 3) & level))
    asked = np.flatnonzero((kind == 2) & level)
    found[asked] = _wide_pieces(model.vertices, model.faces[asked], floor_area_m2)
    return found


def _rule(kind: str) -> int:
    if kind.startswith(_FLOOR_CLASSES):
        return 1
    if kind.startswith("IfcCovering"):
        return 3
    return 0 if kind.startswith("Ifc") and not kind.startswith("IfcBuildingElementProxy") else 2


def _level_faces(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> NDArray[np.bool_]:
    normal = _normals(vertices, faces)
    return np.asarray(np.abs(normal[:, 2]) > np.cos(np.radians(_LEVEL_DEG)) * np.linalg.norm(normal, axis=1))


def _normals(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> NDArray[np.float64]:
    """Normals (F, 3) twice as long as the faces' area."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.cross(b - a, c - a)


def _wide_pieces(vertices: NDArray[np.float64], faces: NDArray[np.int32], floor_area_m2: float) -> NDArray[np.bool_]:
    """Which of `faces` (F, 3) belong to a connected piece of at least the area that is no strip."""
    if len(faces) == 0:
        return np.zeros(0, bool)
    _, welded = np.unique(np.round(vertices[faces.reshape(-1)] / _WELD_M).astype(np.int64), axis=0, return_inverse=True)
    corners = welded.reshape(-1, 3)
    edges = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
    owner = np.tile(np.arange(len(faces)), 3)
    _, edge, uses = np.unique(edges, axis=0, return_inverse=True, return_counts=True)
    edge = edge.reshape(-1)
    # Faces and edges are the two sides of a graph; a piece is a connected part of it.
    n = len(faces) + len(uses)
    links = coo_array((np.ones(len(edge), np.int8), (owner, len(faces) + edge)), shape=(n, n))
    _, label = connected_components(links, directed=False)
    piece = label[: len(faces)]
    area = np.bincount(piece, 0.5 * np.linalg.norm(_normals(vertices, faces), axis=1))
    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    length = np.linalg.norm(vertices[ends[:, 0]] - vertices[ends[:, 1]], axis=1)
    outline = np.bincount(piece[owner], np.where(uses[edge] == 1, length, 0.0), minlength=len(area))
    wide = 2.0 * area >= _NARROW_M * outline
    return np.asarray((wide & (area >= floor_area_m2))[piece])


def distance_map(grid: VoxelGrid, obstacles: NDArray[np.bool_], clip_m: float) -> NDArray[np.float32]:
    """Returns the distance from each voxel's centre to the closest obstacle voxel's, clipped, as a share of the clip.

    The exact Euclidean distance transform, axis by axis (`saito1994`), cut off where the clip makes the rest equal.

    Args:
        grid: The grid.
        obstacles: (nx, ny, nz) bool, without floors and ceilings.
        clip_m: The distance that becomes 1 [m].
    """
    reach = clip_m / grid.voxel_size_m
    window = int(np.ceil(reach))
    squared = np.full(obstacles.shape, window * window + 1, np.int32)
    squared[obstacles] = 0
    for axis in range(3):
        lines = np.moveaxis(squared, axis, -1)
        _lower_along(lines, window)
    distance = np.sqrt(squared, dtype=np.float32)
    distance /= np.float32(reach)
    return np.minimum(distance, np.float32(1.0), out=distance)


@numba.njit(cache=True, nogil=True)
def _lower_along(squared, window):
    """Replaces each value by the minimum over its line of value there + distance squared, in place."""
    n = squared.shape[2]
    far = np.int32(window * window + 1)
    line = np.empty(n, np.int32)
    for i in range(squared.shape[0]):
        for j in range(squared.shape[1]):
            line[:] = far
            for k in range(n):
                value = squared[i, j, k]
                if value == far:
                    continue
                for m in range(max(0, k - window), min(n, k + window + 1)):
                    line[m] = min(line[m], value + (m - k) * (m - k))
            squared[i, j, :] = line
