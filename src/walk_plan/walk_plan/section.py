# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Horizontal sections of the building, as an architect's plan shows them."""

from __future__ import annotations

import dataclasses

import numpy as np
import shapely
from numpy.typing import NDArray

from walk_building.geometry import Geometry

_SNAP_M = 1e-3  # ends of cut lines closer than this are one corner
_MAX_SOLID_M = 0.8  # a closed outline that is thinner is something solid; a wider one may be a room


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """What a horizontal plane cuts."""

    z_m: float
    lines: tuple[NDArray[np.float64], ...]  # (k, 2) polylines of everything cut [m]
    solids: tuple[shapely.Polygon, ...]  # the cut through walls and columns, where the mesh encloses them


def cut(geometry: Geometry, z_m: float) -> Section:
    """Returns the exact section of the mesh with the plane z = `z_m`."""
    segments = cut_segments(geometry.vertices, geometry.faces, z_m)
    if len(segments) == 0:
        return Section(z_m=z_m, lines=(), solids=())
    # Snapped to the grid before merging: neighbouring triangles compute the corner they share differently.
    snapped = np.round(segments / _SNAP_M) * _SNAP_M
    snapped = snapped[np.any(snapped[:, 0] != snapped[:, 1], axis=1)]
    ends = np.sort(snapped.view([("x", float), ("y", float)])[..., 0], axis=1)
    unique = np.unique(ends, axis=0).view(float).reshape(-1, 2, 2)
    merged = shapely.get_parts(shapely.line_merge(shapely.multilinestrings(shapely.linestrings(unique))))
    lines = shapely.simplify(merged, _SNAP_M)
    return Section(
        z_m=z_m,
        lines=tuple(np.asarray(shapely.get_coordinates(line)) for line in lines),
        solids=_solids(merged),
    )


def cut_segments(vertices: NDArray[np.float64], faces: NDArray[np.int32], z_m: float) -> NDArray[np.float64]:
    """Returns the (s, 2, 2) segments in which triangles cross the plane z = `z_m` [m].

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
    return np.stack(ends, axis=1) if len(rows) else np.zeros((0, 2, 2))


def _solids(merged: NDArray[np.object_]) -> tuple[shapely.Polygon, ...]:
    closed = merged[shapely.is_closed(merged) & (shapely.get_num_points(merged) > 3)]
    if len(closed) == 0:
        return ()
    rings = [shapely.Polygon(shapely.get_coordinates(line)) for line in closed]
    areas = shapely.get_parts(shapely.make_valid(rings))
    areas = areas[shapely.get_type_id(areas) == shapely.GeometryType.POLYGON]
    thin = shapely.is_empty(shapely.buffer(areas, -_MAX_SOLID_M / 2, join_style="mitre"))
    # A wide ring with another wide ring just inside is a wall around a room: what lies between them is solid.
    wide = areas[~thin]
    between = shapely.symmetric_difference_all(wide) if len(wide) else shapely.Polygon()
    walls = shapely.get_parts(between)
    walls = walls[shapely.is_empty(shapely.buffer(walls, -_MAX_SOLID_M / 2, join_style="mitre"))]
    union = shapely.get_parts(shapely.union_all(np.concatenate([areas[thin], walls])))
    return tuple(part for part in union if isinstance(part, shapely.Polygon) and part.area > 0.0)
