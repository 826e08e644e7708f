# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From a file's content to the model: scale, turn, drop, check, move near the origin."""

from __future__ import annotations

from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from walk_building.errors import BuildingError
from walk_building.loaders.plausible import check_extent, suspect_axes, suspect_precision
from walk_building.loaders.raw import PartFilter, RawMesh, RawModel
from walk_building.model import Door, LoadOptions, Model, Part, Space, Storey

_Scalar = TypeVar("_Scalar", bound=np.generic)

# Single-precision engines (ray queries, viewers) are good to 0.1 mm up to here.
_NEAR_M = 1000.0

# Rotations that bring the file's up axis to z and keep the handedness; y up as glTF has it: x right, -z ahead.
_TO_Z_UP = {
    "x": np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]),
    "y": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
    "z": np.eye(3),
}


def assemble(raw: RawModel, path: Path, options: LoadOptions, part_filter: PartFilter, content_hash: str) -> Model:
    """Returns the model of a file's content.

    Raises:
        BuildingError: Nothing is left, coordinates are not finite, or the size is no building's.
    """
    units_m = options.units_m or raw.units_m or 1.0
    up = raw.up or "z" if options.up == "auto" else options.up
    turn = units_m * _TO_Z_UP[up].T  # rows are points: p_model = p_file @ turn
    warnings = list(raw.warnings) + _assumptions(raw, options, part_filter)

    parts, n_degenerate = _solid_parts(raw.parts, turn, path)
    if not parts:
        raise BuildingError(path, _why_empty(raw, part_filter))
    vertices, faces, listed = _join(parts)
    check_extent(vertices, listed, faces, path, units_m)
    if n_degenerate:
        warnings.append(f"{n_degenerate} triangles without an area were left out.")
    warnings += suspect_precision(vertices)
    warnings += suspect_axes(vertices, faces, up)

    offset_m = _offset(vertices)
    return Model(
        source=path,
        content_hash=content_hash,
        vertices=_frozen(vertices - offset_m),
        faces=_frozen(faces),
        parts=listed,
        spaces=tuple(_space(mesh, turn, offset_m) for mesh in raw.spaces),
        doors=tuple(_door(mesh, turn, offset_m) for mesh in raw.doors),
        storeys=_storeys(raw, units_m, float(offset_m[2])),
        offset_m=_frozen(offset_m),
        units_m=units_m,
        warnings=tuple(warnings),
    )


def _assumptions(raw: RawModel, options: LoadOptions, part_filter: PartFilter) -> list[str]:
    warnings = []
    if raw.units_m is None and not options.units_m:
        warnings.append("The file does not say its unit; metres are assumed (change it with --units).")
    if part_filter.pattern and not part_filter.dropped:
        warnings.append(f"The pattern to ignore, {part_filter.pattern!r}, found no part.")
    return warnings


def _solid_parts(
    meshes: tuple[RawMesh, ...], turn: NDArray[np.float64], path: Path
) -> tuple[list[tuple[RawMesh, NDArray[np.float64], NDArray[np.int32]]], int]:
    """Returns the meshes with their vertices [m] and their faces with an area, and how many faces had none."""
    solid = []
    n_degenerate = 0
    for mesh in meshes:
        vertices = mesh.vertices @ turn
        _check_numbers(mesh, vertices, path)
        corners = vertices[mesh.faces]
        area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        keep = area > 0.0
        n_degenerate += int(np.count_nonzero(~keep))
        if keep.any():
            solid.append((mesh, vertices, mesh.faces[keep]))
    return solid, n_degenerate


def _check_numbers(mesh: RawMesh, vertices: NDArray[np.float64], path: Path) -> None:
    finite = np.isfinite(vertices).all(axis=1)
    if not finite.all():
        bad = int(np.flatnonzero(~finite)[0])
        raise BuildingError(
            path, f"vertex {bad} of part {mesh.name!r} is not a finite number; export the file again or ignore the part"
        )
    if len(mesh.faces) and (mesh.faces.min() < 0 or mesh.faces.max() >= len(vertices)):
        raise BuildingError(
            path, f"a triangle of part {mesh.name!r} names a vertex that does not exist; the file is damaged"
        )


def _why_empty(raw: RawModel, part_filter: PartFilter) -> str:
    if part_filter.dropped:
        return f"the pattern to ignore, {part_filter.pattern!r}, leaves no part of the building"
    if raw.warnings:
        return "holds no triangles: " + " ".join(raw.warnings)
    return "holds no triangles, so there is nothing to walk on"


def _join(
    solid: list[tuple[RawMesh, NDArray[np.float64], NDArray[np.int32]]],
) -> tuple[NDArray[np.float64], NDArray[np.int32], tuple[Part, ...]]:
    parts = []
    first_vertex = first_face = 0
    shifted = []
    for mesh, vertices, faces in solid:
        shifted.append(faces + np.int32(first_vertex))
        parts.append(Part(name=mesh.name, kind=mesh.kind, first_face=first_face, n_faces=len(faces)))
        first_vertex += len(vertices)
        first_face += len(faces)
    return np.concatenate([vertices for _, vertices, _ in solid]), np.concatenate(shifted), tuple(parts)


def _offset(vertices: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the whole metres [m] that bring far axes near the origin; axes that are near stay as they are."""
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    far = np.maximum(np.abs(low), np.abs(high)) > _NEAR_M
    return np.where(far, np.round((low + high) / 2), 0.0)


def _space(mesh: RawMesh, turn: NDArray[np.float64], offset_m: NDArray[np.float64]) -> Space:
    return Space(
        name=mesh.name,
        long_name=mesh.long_name,
        storey=mesh.storey,
        vertices=_frozen(mesh.vertices @ turn - offset_m),
        faces=_frozen(mesh.faces),
    )


def _door(mesh: RawMesh, turn: NDArray[np.float64], offset_m: NDArray[np.float64]) -> Door:
    vertices = mesh.vertices @ turn - offset_m
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    return Door(name=mesh.name, storey=mesh.storey, centre=_frozen((low + high) / 2), size=_frozen(high - low))


def _storeys(raw: RawModel, units_m: float, offset_z_m: float) -> tuple[Storey, ...]:
    storeys = [Storey(name=name, elevation_m=elevation * units_m - offset_z_m) for name, elevation in raw.storeys]
    return tuple(sorted(storeys, key=lambda storey: storey.elevation_m))


def _frozen(array: NDArray[_Scalar]) -> NDArray[_Scalar]:
    array = np.ascontiguousarray(array)
    array.flags.writeable = False
    return array
