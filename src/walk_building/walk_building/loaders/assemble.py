# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From a file's content to the model: scale, turn, drop, check, move near the origin."""

from __future__ import annotations

import dataclasses
import logging
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from walk_building.errors import BuildingError
from walk_building.loaders.named_doors import doors_by_name
from walk_building.loaders.plausible import check_extent, suspect_axes, suspect_precision, suspect_size
from walk_building.loaders.raw import PartFilter, RawMesh, RawModel
from walk_building.model import Door, LoadOptions, Model, Part, Space, Storey

_log = logging.getLogger(__name__)

_Scalar = TypeVar("_Scalar", bound=np.generic)

# Single-precision engines (ray queries, viewers) are good to 0.1 mm up to here.
_NEAR_M = 1000.0

# Rotations that bring the file's up axis to z and keep the handedness; y up as glTF has it: x right, -z ahead.
_TO_Z_UP = {
    "x": np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]),
    "y": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
    "z": np.eye(3),
}


_TURNED = (
    "The file does not say which axis points up; nearly all of its floor faces along y, so y is taken as up "
    "(--up z if that is wrong)."
)


def assemble(raw: RawModel, path: Path, options: LoadOptions, part_filter: PartFilter, content_hash: str) -> Model:
    """Returns the model of a file's content.

    Raises:
        BuildingError: Nothing is left, coordinates are not finite, or the size is no building's.
    """
    units_m = options.units_m or raw.units_m or 1.0
    up = raw.up or "z" if options.up == "auto" else options.up
    turned = raw.up is None and options.up == "auto" and _lies_on_its_side(raw, path, units_m)
    if turned:
        up = "y"
    turn = units_m * _TO_Z_UP[up].T  # rows are points: p_model = p_file @ turn
    raw = doors_by_name(raw, options.doors, turn)
    warnings = list(raw.warnings) + [_TURNED] * turned + _assumptions(raw, options, part_filter)
    solid = [_solid(mesh, turn, path) for mesh in raw.parts]
    meshes = [mesh for mesh, _ in solid if len(mesh.faces)]
    if not meshes:
        raise BuildingError(path, _why_empty(raw, part_filter))
    vertices, faces, parts = _join(meshes)
    check_extent(vertices, faces, parts, path, units_m, stated=bool(raw.units_m or options.units_m))
    n_degenerate = sum(n for _, n in solid)
    if n_degenerate:
        _log.info("%s: %d triangles without an area were left out", path, n_degenerate)
    warnings += suspect_precision((mesh.vertices for mesh in raw.parts), units_m)
    warnings += suspect_axes(vertices, faces, up)
    warnings += suspect_size(vertices, units_m)

    offset_m = _offset(vertices)
    return Model(
        source=path,
        content_hash=content_hash,
        vertices=_frozen(vertices - offset_m),
        faces=_frozen(faces),
        parts=parts,
        spaces=tuple(_space(mesh, turn, offset_m) for mesh in raw.spaces),
        doors=tuple(_door(mesh, turn, offset_m) for mesh in raw.doors),
        storeys=_storeys(raw, units_m, float(offset_m[2])),
        offset_m=_frozen(offset_m),
        units_m=units_m,
        warnings=tuple(warnings),
    )


def _lies_on_its_side(raw: RawModel, path: Path, units_m: float) -> bool:
    """Whether a file without a declared vertical shows floors along y as it stands, and none once it is turned."""
    meshes = [mesh for mesh, _ in (_solid(mesh, units_m * np.eye(3), path) for mesh in raw.parts) if len(mesh.faces)]
    if not meshes:
        return False
    vertices, faces, _ = _join(meshes)
    return bool(suspect_axes(vertices, faces, "z")) and not suspect_axes(vertices @ _TO_Z_UP["y"].T, faces, "y")


def _assumptions(raw: RawModel, options: LoadOptions, part_filter: PartFilter) -> list[str]:
    warnings = []
    if raw.units_m is None and not options.units_m:
        warnings.append(
            "The file does not say its unit; metres are assumed (for others --units: mm, cm, in, ft, or its length in "
            "metres)."
        )
    if part_filter.pattern and not part_filter.dropped:
        warnings.append(f"The pattern to ignore, {part_filter.pattern!r}, found no part.")
    return warnings


def _solid(mesh: RawMesh, turn: NDArray[np.float64], path: Path) -> tuple[RawMesh, int]:
    """Returns the mesh in metres, z up, without useless triangles and vertices, and how many triangles that were."""
    if len(mesh.faces) and (mesh.faces.min() < 0 or mesh.faces.max() >= len(mesh.vertices)):
        raise BuildingError(path, f"a triangle of part {mesh.name!r} names a vertex that is not there; export it again")
    used = np.zeros(len(mesh.vertices), dtype=np.bool_)
    used[mesh.faces] = True
    with np.errstate(all="ignore"):  # what is not finite is refused on the next line
        vertices = mesh.vertices[used] @ turn
    if not np.isfinite(vertices).all():
        raise BuildingError(path, f"part {mesh.name!r} has vertices that are no finite numbers; export it again")
    faces = (np.cumsum(used, dtype=np.int32) - 1)[mesh.faces]
    corners = vertices[faces]
    with np.errstate(over="ignore", invalid="ignore"):  # absurd sizes are refused with the extent
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    keep = (normals != 0.0).any(axis=1)
    solid = dataclasses.replace(mesh, vertices=vertices, faces=faces[keep].astype(np.int32))
    return solid, int(np.count_nonzero(~keep))


def _why_empty(raw: RawModel, part_filter: PartFilter) -> str:
    if part_filter.dropped:
        return f"the pattern to ignore, {part_filter.pattern!r}, leaves no part of the building"
    if raw.warnings:
        return "holds no triangles: " + " ".join(raw.warnings)
    return "holds no triangles, so there is nothing to walk on"


def _join(meshes: list[RawMesh]) -> tuple[NDArray[np.float64], NDArray[np.int32], tuple[Part, ...]]:
    """Returns the vertices [m] and faces of all meshes, and which faces belong to which."""
    parts, faces = [], []
    first_vertex = first_face = 0
    for mesh in meshes:
        faces.append(mesh.faces + np.int32(first_vertex))
        parts.append(Part(name=mesh.name, kind=mesh.kind, first_face=first_face, n_faces=len(mesh.faces)))
        first_vertex += len(mesh.vertices)
        first_face += len(mesh.faces)
    return np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces), tuple(parts)


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
