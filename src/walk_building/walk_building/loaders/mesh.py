# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""glTF, GLB, OBJ, PLY, STL and COLLADA by trimesh; the only file that imports it for reading."""

from __future__ import annotations

import contextlib
import io
import logging
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np

from walk_building.errors import BuildingError
from walk_building.loaders.collada import read_collada
from walk_building.loaders.gltf import check_gltf
from walk_building.loaders.obj import readable_obj
from walk_building.loaders.raw import PartFilter, RawMesh, RawModel
from walk_building.model import LoadOptions
from walk_building.progress import Progress

# Materials are never used: a missing texture must not matter.
_SETTINGS: dict[str, dict[str, Any]] = {
    ".glb": {"skip_materials": True},
    ".gltf": {"skip_materials": True},
    ".obj": {"skip_materials": True, "split_objects": True, "split_groups": True, "group_material": False},
    ".ply": {"skip_materials": True},
}

_STL_HEADER_BYTES = 84
_STL_TRIANGLE_BYTES = 50


def load_mesh(path: Path, options: LoadOptions, part_filter: PartFilter, progress: Progress) -> RawModel:
    """Returns the triangles of a mesh file, every instance placed, named after the nodes of its scene.

    Raises:
        BuildingError: The file is not what its suffix says, is damaged, or needs an extension that is not read.
    """
    suffix = path.suffix.lower()
    units_m, up, names = None, None, {}
    warnings: list[str] = []
    if suffix in (".glb", ".gltf"):
        warnings += check_gltf(path)
        units_m, up = 1.0, "y"
    elif suffix == ".dae":
        facts = read_collada(path)
        units_m, up, names = facts.units_m, facts.up, dict(facts.names)
    if not options.furniture:
        warnings.append("The format has no classes, so furniture cannot be told apart; drop it by name with --ignore.")
    progress("load", 0.1)
    neighbours = _Neighbours(path.parent, serve=suffix in (".glb", ".gltf"))
    scene = _read(path, suffix, neighbours)
    progress("load", 0.8)
    parts, n_other = _parts(scene, path.stem, names, part_filter)
    if n_other:
        warnings.append(f"{n_other} lines or point clouds were left out; only triangles count.")
    return RawModel(
        parts=tuple(parts), units_m=units_m, up=up, references=neighbours.contents(), warnings=tuple(warnings)
    )


def _read(path: Path, suffix: str, neighbours: _Neighbours) -> Any:
    import trimesh  # a second of imports that an IFC file does not need

    kind = suffix[1:]
    try:
        with _quiet(trimesh.util.log) as messages, np.errstate(all="ignore"):
            scene = trimesh.load_scene(
                _stream(path, suffix), file_type=kind, resolver=neighbours, process=False, **_SETTINGS.get(suffix, {})
            )
    except BuildingError:
        raise
    except MissingNeighbourError as error:
        raise BuildingError(path, f"refers to {error.name!r}, which is not there; put it beside the file") from error
    except Exception as error:  # the engine raises whatever its parser trips over
        raise BuildingError(path, f"cannot be read as {kind.upper()} ({_first_line(error)})") from error
    if any("didn't decode" in message for message in messages):
        raise BuildingError(path, "its compressed geometry is damaged; export it again")
    return scene


def _stream(path: Path, suffix: str) -> io.BytesIO:
    """Returns what the engine is to read: the file's bytes, or its text in the form that the engine understands."""
    data = path.read_bytes()
    if suffix == ".obj":
        return io.BytesIO(readable_obj(_decoded(data)).encode())
    if suffix != ".stl":
        return io.BytesIO(data)
    count = int.from_bytes(data[_STL_HEADER_BYTES - 4 : _STL_HEADER_BYTES], "little")
    if len(data) == _STL_HEADER_BYTES + _STL_TRIANGLE_BYTES * count:
        return io.BytesIO(data)
    if data.lstrip()[:5].lower() != b"solid":
        raise BuildingError(path, "is not an STL file, or is cut short; copy or export it again")
    return io.BytesIO(_decoded(data).encode())


def _decoded(data: bytes) -> str:
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def _parts(scene: Any, stem: str, names: Mapping[str, str], part_filter: PartFilter) -> tuple[list[RawMesh], int]:
    """Returns the placed meshes that are not ignored, and how many geometries are no meshes."""
    parts = []
    n_other = 0
    for node in scene.graph.nodes_geometry:
        transform, key = scene.graph[node]
        geometry = scene.geometry[key]
        if not hasattr(geometry, "faces"):
            n_other += 1
            continue
        name = _part_name(scene, str(node), str(key), stem, names)
        if part_filter.drops(name, "mesh"):
            continue
        faces = np.asarray(geometry.faces, dtype=np.int32).reshape(-1, 3)
        with np.errstate(all="ignore"):  # what is not finite is found, and said, later
            if np.linalg.det(transform[:3, :3]) < 0.0:
                faces = faces[:, ::-1]
            vertices = np.asarray(geometry.vertices, dtype=np.float64) @ transform[:3, :3].T + transform[:3, 3]
        parts.append(RawMesh(name=name, kind="mesh", vertices=vertices, faces=faces))
    return parts, n_other


def _part_name(scene: Any, node: str, key: str, stem: str, names: Mapping[str, str]) -> str:
    # The engine appends _1, _2 … to a COLLADA geometry that is placed again.
    for geometry_id in (key, key.rpartition("_")[0]):
        if geometry_id in names:
            return names[geometry_id]
    if re.fullmatch(r"geometry_\d+", node):  # made up where the format has no names
        return stem
    parent = str(scene.graph.transforms.parents.get(node, ""))
    # The engine names the primitives of one glTF mesh after the node and a random text.
    if parent and re.fullmatch(re.escape(parent) + r"_\w{6}", node):
        return parent
    return node


class MissingNeighbourError(Exception):
    """A file beside the model that the model needs."""

    def __init__(self, name: str) -> None:
        self.name = name
        super().__init__(name)


class _Neighbours:
    """Hands the engine the buffers that a glTF refers to, and keeps them for the content hash."""

    def __init__(self, folder: Path, *, serve: bool) -> None:
        self._folder = folder
        self._serve = serve  # other formats refer only to materials and textures
        self._read: dict[str, bytes] = {}

    def __getitem__(self, name: str) -> bytes:
        return self.get(name)

    def get(self, name: str) -> bytes:
        if not self._serve:
            raise MissingNeighbourError(name)
        try:
            self._read[name] = (self._folder / unquote(name)).read_bytes()
        except (OSError, ValueError) as error:
            raise MissingNeighbourError(name[:80]) from error
        return self._read[name]

    def contents(self) -> tuple[bytes, ...]:
        return tuple(self._read[name] for name in sorted(self._read))


@contextlib.contextmanager
def _quiet(logger: logging.Logger) -> Iterator[list[str]]:
    """Keeps what the engine logs to itself (tracebacks of missing textures, mostly) and yields it."""
    messages: list[str] = []

    def keep(record: logging.LogRecord) -> bool:
        messages.append(record.getMessage())
        return False

    logger.addFilter(keep)
    try:
        yield messages
    finally:
        logger.removeFilter(keep)


def _first_line(error: Exception) -> str:
    lines = str(error).strip().splitlines()
    return lines[0][:200] if lines else type(error).__name__
