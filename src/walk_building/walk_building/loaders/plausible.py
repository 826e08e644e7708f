# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Whether a model can be a building at all: its size, its axes, its precision."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from walk_building.errors import BuildingError
from walk_building.model import Part

# Less than this in every direction and no person fits in; a house in millimetres read as metres is below it.
_SMALLEST_M = 1.0
# A room is higher; a house in metres read as feet is below it, with two storeys.
_LOWEST_M = 2.0
# The longest buildings (airports, factories) are 1 to 2 km long; a house in millimetres read as metres is above it.
_LONGEST_M = 5000.0
# The tallest building is 830 m high; a single storey in millimetres read as metres is 2500 m.
_TALLEST_M = 1000.0
# Few buildings are higher, while a single storey in centimetres read as metres is 250 m.
_TALLEST_UNSTATED_M = 200.0
_ASK = "give its unit with --units (mm, cm, in, ft, or its length in metres)"

# A walker's clearance of a few centimetres means nothing if walls are only known this well.
_COARSE_M = 0.005
# Share of the far numbers that look rounded above which the file is taken to be: about a half is to be expected.
_ROUNDED = 0.1
# Cosine of the angle, 18 degrees, up to which a triangle counts as facing along an axis.
_FACING = 0.95


def check_extent(
    vertices: NDArray[np.float64],
    faces: NDArray[np.int32],
    parts: tuple[Part, ...],
    path: Path,
    units_m: float,
    *,
    stated: bool,
) -> None:
    """Refuses a size that is no building's.

    Args:
        vertices: (V, 3) [m].
        faces: (F, 3).
        parts: What the faces belong to.
        path: For the message.
        units_m: Length of the file's unit, stated or assumed [m].
        stated: Whether the file or the user says the unit.

    Raises:
        BuildingError: Under 1 m in every direction, over 5 km along the ground or over 1 km high; over 200 m high
            where nobody says the unit.
    """
    extent = np.ptp(vertices, axis=0)
    size = " x ".join(f"{side:.3g}" for side in extent)
    unit = f"with a unit of {units_m:g} m the model measures {size} m"
    if extent.max() < _SMALLEST_M:
        raise BuildingError(path, f"{unit}, too small to walk in; {_ASK}")
    if extent[:2].max() > _LONGEST_M or extent[2] > _TALLEST_M:
        hint = _stray_part(vertices, faces, parts)
        raise BuildingError(path, f"{unit}, too large for a building; {_ASK}{hint}")
    if not stated and extent[2] > _TALLEST_UNSTATED_M:
        in_cm = " x ".join(f"{side / 100:.3g}" for side in extent)
        raise BuildingError(
            path,
            f"the file does not say its unit; in metres it measures {size} m, in centimetres {in_cm} m: {_ASK}, "
            "or --units 1 if it is in metres",
        )


def _stray_part(vertices: NDArray[np.float64], faces: NDArray[np.int32], parts: tuple[Part, ...]) -> str:
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


def suspect_size(vertices: NDArray[np.float64], units_m: float) -> list[str]:
    """Returns a warning where a person could hardly stand upright in the model: most likely its unit is another.

    Args:
        vertices: (V, 3) [m].
        units_m: Length of the file's unit, stated or assumed [m].
    """
    height_m = np.ptp(vertices[:, 2])
    if height_m >= _LOWEST_M:
        return []
    return [
        f"With a unit of {units_m:g} m the model is only {height_m:.2f} m high, less than a room: is that its unit? "
        "Say another with --units (mm, cm, in, ft, or its length in metres)."
    ]


def suspect_precision(meshes: Iterable[NDArray[np.float64]], units_m: float) -> list[str]:
    """Returns a warning where a file keeps far coordinates as 32-bit numbers, whose steps are then coarse.

    The last bit of a number that was rounded to 32 of them is set half of the time; that of one that merely fits, such
    as a whole metre, hardly ever.

    Args:
        meshes: Vertices (V, 3) of each part in the file's units.
        units_m: Length of one unit [m].
    """
    # Each number once: the corners of a building share few of them.
    numbers = np.unique(np.concatenate([np.abs(vertices).ravel() for vertices in meshes]))
    with np.errstate(all="ignore"):  # a vertex that no triangle names may be anything
        single = numbers.astype(np.float32)
        steps_m = np.spacing(single) * np.float32(units_m)
    coarse = steps_m >= _COARSE_M
    fits = coarse & (single == numbers)
    rounded = fits & (single.view(np.uint32) % 2 == 1)
    if np.count_nonzero(rounded) <= _ROUNDED * np.count_nonzero(coarse):
        return []
    step = steps_m[fits].max()
    return [
        f"The file keeps coordinates far from the origin as 32-bit numbers, in steps of {step * 1000:.0f} mm; "
        "export it near the origin for exact walls."
    ]


def suspect_axes(vertices: NDArray[np.float64], faces: NDArray[np.int32], up: str) -> list[str]:
    """Returns a warning where the model seems to lie on its side; our own measures.

    Floors pack much area into little height: the area that faces along an axis, per metre of that axis, is by far
    the largest along the true vertical. A tower's facades can beat its floors there, but not in area too; and the
    single floor of a low building is found as one plane that holds most of what faces its way.
    """
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
    area = np.linalg.norm(normals, axis=1)
    extent = np.maximum(np.ptp(vertices, axis=0), 1e-3)
    facing = np.abs(normals) > _FACING * area[:, None]
    total = (facing * area[:, None]).sum(axis=0)
    y, z = 1, 2
    denser = total[y] / extent[y] > 1.5 * total[z] / extent[z]
    on_side = denser and total[y] > 1.2 * total[z]
    flat = (
        denser
        and extent[y] < 0.5 * min(extent[0], extent[z])
        and _largest_plane(corners, area, facing, y) > 0.5 > _largest_plane(corners, area, facing, z)
    )
    if not (on_side or flat):
        return []
    other = "z" if up == "y" else "y"
    return [f"The building seems to lie on its side: more floor faces along y than along z; try --up {other}."]


def _largest_plane(
    corners: NDArray[np.float64], area: NDArray[np.float64], facing: NDArray[np.bool_], axis: int
) -> float:
    """Returns the share of the area facing along an axis that lies within one layer of 10 cm."""
    mine = facing[:, axis]
    if not mine.any():
        return 0.0
    layer = np.floor(corners[mine, :, axis].mean(axis=1) / 0.1).astype(np.int64)
    sums = np.bincount(layer - layer.min(), weights=area[mine])
    return float(sums.max() / sums.sum())
