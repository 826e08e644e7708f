# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Whether a model can be a building at all: its size, its axes, its precision."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from walk_building.errors import BuildingError
from walk_building.model import Part

# Less than this in every direction and no person fits in; a house in millimetres read as metres is below it.
_SMALLEST_M = 1.0
# The longest buildings (airports, factories) are 1 to 2 km long; a house in millimetres read as metres is above it.
_LONGEST_M = 5000.0
# The tallest building is 830 m high; a single storey in millimetres read as metres is 2500 m.
_TALLEST_M = 1000.0


def check_extent(
    vertices: NDArray[np.float64], parts: tuple[Part, ...], faces: NDArray[np.int32], path: Path, units_m: float
) -> None:
    """Refuses a size that is no building's.

    Raises:
        BuildingError: Under 1 m in every direction, over 5 km along the ground or over 1 km high.
    """
    extent = np.ptp(vertices, axis=0)
    size = " x ".join(f"{side:.3g}" for side in extent)
    unit = f"with a unit of {units_m:g} m the model measures {size} m"
    if extent.max() < _SMALLEST_M:
        raise BuildingError(path, f"{unit}, too small to walk in; give its unit with --units")
    if extent[:2].max() > _LONGEST_M or extent[2] > _TALLEST_M:
        hint = _stray_part(vertices, parts, faces)
        raise BuildingError(path, f"{unit}, too large for a building; give its unit with --units{hint}")


def _stray_part(vertices: NDArray[np.float64], parts: tuple[Part, ...], faces: NDArray[np.int32]) -> str:
    """Returns a hint at the part without which the model would be of a building's size, or ""."""
    if len(parts) < 2:
        return ""
    centres = np.array([_centre(vertices, faces, part) for part in parts])
    away = np.linalg.norm(centres - np.median(centres, axis=0), axis=1)
    farthest = int(away.argmax())
    rest = np.delete(centres, farthest, axis=0)
    if away[farthest] < _LONGEST_M / 2 or np.ptp(rest, axis=0).max() > _LONGEST_M:
        return ""
    return f", or leave out part {parts[farthest].name!r}, which lies {away[farthest]:.0f} m off, with --ignore"


def _centre(vertices: NDArray[np.float64], faces: NDArray[np.int32], part: Part) -> NDArray[np.float64]:
    corners = vertices[faces[part.first_face : part.first_face + part.n_faces].ravel()]
    centre: NDArray[np.float64] = (corners.min(axis=0) + corners.max(axis=0)) / 2
    return centre


def suspect_precision(vertices: NDArray[np.float64]) -> list[str]:
    """Returns a warning where far coordinates kept as 32-bit numbers are coarser than a centimetre."""
    farthest = float(np.abs(vertices).max())
    return []


def suspect_axes(vertices: NDArray[np.float64], faces: NDArray[np.int32], up: str) -> list[str]:
    """Returns a warning where the model seems to lie on its side."""
    return []
