# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The building's parts as pieces that are drawn in one colour, with their names."""

from __future__ import annotations

import dataclasses
import re

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building

GROUPS: dict[str, tuple[float, float, float, float]] = {
    "structure": (0.82, 0.81, 0.78, 1.0),
    "ceiling": (0.93, 0.93, 0.91, 1.0),
    "glass": (0.55, 0.72, 0.80, 0.35),
    "stair": (0.70, 0.66, 0.60, 1.0),
    "door": (0.62, 0.46, 0.31, 1.0),
    "furniture": (0.55, 0.60, 0.68, 1.0),
}
"""Base colours by group."""

_GROUP_OF = (
    ("glass", re.compile(r"Window|CurtainWall|Plate")),
    ("ceiling", re.compile(r"Covering")),
    ("stair", re.compile(r"Stair|Ramp|Railing")),
    ("door", re.compile(r"Door")),
    ("furniture", re.compile(r"Furni|Proxy|Sanitary|FlowTerminal|Lamp|Light|Appliance|Geographic|Transport")),
)
_FLOOR_TOLERANCE_M = 0.5  # a slab's middle lies below the floor that it carries


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Piece:
    """Triangles of one part."""

    name: str
    kind: str  # IFC class, or "mesh"
    group: str
    storey: int
    vertices: NDArray[np.float64]  # (V, 3) [m]
    faces: NDArray[np.int64]  # (F, 3)


def pieces_of(building: Building) -> list[Piece]:
    """Returns the parts that have triangles, each with its own vertices, in the order of the file."""
    model, floors = building.model, np.array([s.elevation_m for s in building.storeys])
    found = []
    for part in model.parts:
        triangles = model.faces[part.first_face : part.first_face + part.n_faces]
        if not len(triangles):
            continue
        vertices, faces = compact(model.vertices[triangles.reshape(-1)], np.arange(triangles.size).reshape(-1, 3))
        if not len(faces):
            continue
        middle = float(vertices[:, 2].min() + vertices[:, 2].max()) / 2
        storey = int(np.searchsorted(floors, middle + _FLOOR_TOLERANCE_M, side="right")) - 1
        found.append(
            Piece(
                name=part.name,
                kind=part.kind,
                group=group_of(part.kind),
                storey=max(storey, 0),
                vertices=vertices,
                faces=faces,
            )
        )
    return found


def group_of(kind: str) -> str:
    """Returns the group of an IFC class; "structure" for all that has none of its own."""
    return next((group for group, pattern in _GROUP_OF if pattern.search(kind)), "structure")


def compact(
    vertices: NDArray[np.float64], faces: NDArray[np.int64], grid_m: float = 1e-4
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Returns vertices and faces with equal vertices merged, in the order of use, and without empty triangles.

    Args:
        vertices: (V, 3) [m].
        faces: (F, 3).
        grid_m: Vertices in one cell of this size are equal.
    """
    keys = np.rint(vertices / grid_m).astype(np.int64)
    _, first, label = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    merged = label.reshape(-1)[faces]
    merged = merged[(merged[:, 0] != merged[:, 1]) & (merged[:, 1] != merged[:, 2]) & (merged[:, 2] != merged[:, 0])]
    # In the order of use, indices rise by small steps, which compresses to half.
    used, where, order = np.unique(merged.reshape(-1), return_index=True, return_inverse=True)
    rank = np.empty(len(used), np.int64)
    rank[np.argsort(where, kind="stable")] = np.arange(len(used))
    kept = np.empty((len(used), 3))
    kept[rank] = vertices[first[used]]
    return kept, rank[order].reshape(-1, 3)
