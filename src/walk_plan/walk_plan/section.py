# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Horizontal sections of the building, as an architect's plan shows them."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from walk_building.geometry import Geometry
from walk_building.model import Part

_SNAP_M = 1e-3  # ends of cut lines closer than this are one corner
_MAX_SOLID_M = 0.8  # a closed outline that is thinner is something solid; a wider one may be a room ...
_MAX_COLUMN_M2 = 1.5  # ... unless it is as small as a column


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """What a horizontal plane cuts."""

    z_m: float
    lines: tuple[NDArray[np.float64], ...]  # (k, 2) polylines of everything cut [m]
    solids: tuple[shapely.Polygon, ...]  # the cut through walls and columns, where the mesh encloses them


def cut(geometry: Geometry, z_m: float, parts: Sequence[Part] = ()) -> Section:
    """Returns the exact section of the mesh with the plane z = `z_m`.

    Args:
        geometry: The mesh.
        z_m: Height of the plane [m].
        parts: Pieces of the mesh that are solid each on its own, such as walls; what is filled comes from them alone.
    """
    segments, face = cut_segments(geometry.vertices, geometry.faces, z_m)
    snapped = np.round(segments / _SNAP_M) * _SNAP_M
    long = np.any(snapped[:, 0] != snapped[:, 1], axis=1)
    snapped, face = snapped[long], face[long]
    if len(snapped) == 0:
        return Section(z_m=z_m, lines=(), solids=())
    lines = shapely.simplify(_merged(snapped), _SNAP_M)
    return Section(
        z_m=z_m,
        lines=tuple(np.asarray(shapely.get_coordinates(line)) for line in lines),
        solids=_solids(snapped, face, parts),
    )


def cut_segments(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], z_m: float
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Returns the (s, 2, 2) segments in which triangles cross the plane z = `z_m` [m], and the triangle of each (s,).

    A corner in the plane counts as above it, so a triangle is cut in none or in two of its edges.
    """
    above = (vertices[:, 2] >= z_m)[faces]
    count = above.sum(axis=1)
    crossing = (count == 1) | (count == 2)
    triangles, above, count = vertices[faces[crossing]], above[crossing], count[crossing]
    # The corner that lies alone on its side: both cut edges start there.
    alone = np.argmax(above == (count == 1)[:, None], axis=1)
    rows = np.arange(len(triangles))
    tip = triangles[rows, alone]
    ends = []
    for turn in (1, 2):
        other = triangles[rows, (alone + turn) % 3]
        share = (z_m - tip[:, 2]) / (other[:, 2] - tip[:, 2])
        ends.append(tip[:, :2] + share[:, None] * (other - tip)[:, :2])
    return np.stack(ends, axis=1), np.flatnonzero(crossing)


def _merged(segments: NDArray[np.float64]) -> NDArray[np.object_]:
    """Returns the segments chained to lines, each drawn once."""
    # Every segment with its smaller end first, so that the two sides of a shared edge are found to be one.
    swap = (segments[:, 0, 0] > segments[:, 1, 0]) | (
        (segments[:, 0, 0] == segments[:, 1, 0]) & (segments[:, 0, 1] > segments[:, 1, 1])
    )
    ordered = np.where(swap[:, None, None], segments[:, ::-1], segments)
    unique = np.unique(ordered.reshape(-1, 4), axis=0).reshape(-1, 2, 2)
    return np.asarray(shapely.get_parts(shapely.line_merge(shapely.multilinestrings(shapely.linestrings(unique)))))


def _solids(
    segments: NDArray[np.float64], face: NDArray[np.int64], parts: Sequence[Part]
) -> tuple[shapely.Polygon, ...]:
    """Returns what the outlines of each part enclose, where it is so thin that it is no room."""
    found = []
    for part in parts:
        mine = (face >= part.first_face) & (face < part.first_face + part.n_faces)
        if mine.any():
            # Noded first: outlines may touch and cross, and only pieces between crossings enclose areas.
            areas = shapely.get_parts(shapely.polygonize([shapely.unary_union(_merged(segments[mine]))]))
            found.append(areas[_thin(areas) | (shapely.area(areas) <= _MAX_COLUMN_M2)])
    union = shapely.get_parts(shapely.union_all(np.concatenate(found))) if found else []
    return tuple(area for area in union if isinstance(area, shapely.Polygon))


def _thin(areas: NDArray[np.object_]) -> NDArray[np.bool_]:
    return np.asarray(shapely.is_empty(shapely.buffer(areas, -_MAX_SOLID_M / 2, join_style="mitre")))
