# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Doors that a file knows only by the names of its parts."""

from __future__ import annotations

import dataclasses
import re

import numpy as np
from numpy.typing import NDArray

from walk_building.errors import ParameterError
from walk_building.loaders.raw import RawMesh, RawModel

# The bounding box of a leaf or a pair of leaves, closed or ajar: height, and the longer side of its outline.
_HEIGHT_M = (1.5, 3.2)
_WIDTH_M = (0.4, 2.6)


def doors_by_name(raw: RawModel, pattern: str, turn: NDArray[np.float64]) -> RawModel:
    """Returns the content with the parts that are doors by name and size among the doors.

    Content that has doors by class stays as it is, and so does content that would have no part left.

    Args:
        raw: A file's content.
        pattern: Regular expression for the names of doors; "" for none.
        turn: (3, 3) what brings a row of the file's coordinates to metres, z up.

    Raises:
        ParameterError: The pattern is no regular expression.
    """
    try:
        regex = re.compile(pattern)
    except re.error as error:
        raise ParameterError("doors", pattern, f"a regular expression ({error})") from error
    if raw.doors or not pattern:
        return raw
    named = [bool(regex.search(mesh.name)) and _door_sized(mesh, turn) for mesh in raw.parts]
    if not any(named) or all(named):
        return raw
    parts = tuple(mesh for mesh, is_door in zip(raw.parts, named, strict=True) if not is_door)
    doors = tuple(mesh for mesh, is_door in zip(raw.parts, named, strict=True) if is_door)
    warning = f"Doors by their names, which stand open: {len(doors)} (name others with --doors)."
    return dataclasses.replace(raw, parts=parts, doors=doors, warnings=(*raw.warnings, warning))


def _door_sized(mesh: RawMesh, turn: NDArray[np.float64]) -> bool:
    if len(mesh.faces) == 0 or mesh.faces.max() >= len(mesh.vertices):
        return False
    used = mesh.vertices[np.unique(mesh.faces)]
    if not np.isfinite(used).all():
        return False
    x, y, height = np.ptp(used @ turn, axis=0)
    return bool(_HEIGHT_M[0] <= height <= _HEIGHT_M[1] and _WIDTH_M[0] <= max(x, y) <= _WIDTH_M[1])
