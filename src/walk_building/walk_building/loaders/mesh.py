# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""glTF, GLB, OBJ, PLY, STL and COLLADA by trimesh; the only file that imports it for reading."""

from __future__ import annotations

import contextlib
import logging
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from walk_building.errors import BuildingError
from walk_building.loaders.collada import read_asset
from walk_building.loaders.gltf import check_gltf
from walk_building.loaders.raw import PartFilter, RawMesh, RawModel
from walk_building.model import LoadOptions
from walk_building.progress import Progress

# Materials are never used: a missing texture must not matter.
_WITHOUT_MATERIALS = {
    ".glb": {"skip_materials": True},
    ".gltf": {"skip_materials": True},
    ".obj": {"skip_materials": True, "split_objects": True, "group_material": False},
}


def load_mesh(path: Path, options: LoadOptions, part_filter: PartFilter, progress: Progress) -> RawModel:
    """Returns the triangles of a mesh file, every instance placed, named after the nodes of its scene.

    Raises:
        BuildingError: The file is not what its suffix says, is damaged, or needs an extension that is not read.
    """
    suffix = path.suffix.lower()
    units_m, up = None, None
    if suffix in (".glb", ".gltf"):
        check_gltf(path)
        units_m, up = 1.0, "y"
    elif suffix == ".dae":
        asset = read_asset(path)
        units_m, up = asset.units_m, asset.up
    resolver = _Neighbours(path.parent)
    scene = _read(path, suffix, resolver)
    parts, warnings = _parts(scene, part_filter)
    if not options.furniture:
        warnings.append("The format has no classes, so furniture cannot be told apart; name it with --ignore.")
    return RawModel(
        parts=tuple(parts), units_m=units_m, up=up, references=resolver.contents(), warnings=tuple(warnings)
    )


def _read(path: Path, suffix: str, resolver: _Neighbours) -> Any:
    import trimesh  # a second of imports that an IFC file does not need

    try:
        with path.open("rb") as file, _quiet():
            return trimesh.load_scene(
                file, file_type=suffix[1:], resolver=resolver, process=False, **_WITHOUT_MATERIALS.get(suffix, {})
            )
    except MissingNeighbour as error:
        raise BuildingError(path, f"refers to {error.name}, which is not there; put it beside the file") from error
    except Exception as error:  # the engine raises whatever its parser trips over
        raise BuildingError(path, f"cannot be read as {suffix[1:].upper()} ({_first_line(error)})") from error


def _parts(scene: Any, part_filter: PartFilter) -> tuple[list[RawMesh], list[str]]:
    parts = []
    n_other = 0
    for node in scene.graph.nodes_geometry:
        transform, key = scene.graph[node]
        geometry = scene.geometry[key]
        if not hasattr(geometry, "faces"):
            n_other += 1
            continue
        if part_filter.drops(str(node), "mesh"):
            continue
        faces = np.asarray(geometry.faces, dtype=np.int32).reshape(-1, 3)
        if np.linalg.det(transform[:3, :3]) < 0.0:
            faces = faces[:, ::-1]
        vertices = np.asarray(geometry.vertices, dtype=np.float64) @ transform[:3, :3].T + transform[:3, 3]
        parts.append(RawMesh(name=str(node), kind="mesh", vertices=vertices, faces=faces))
    warnings = [f"{n_other} lines or point clouds were left out; only triangles count."] if n_other else []
    return parts, warnings


class MissingNeighbour(Exception):
    """A file beside the model that the model needs."""

    def __init__(self, name: str) -> None:
        self.name = name
        super().__init__(name)


class _Neighbours:
    """Hands the engine the files a model refers to, and keeps them for the content hash."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._read: dict[str, bytes] = {}

    def get(self, name: str) -> bytes:
        try:
            self._read[name] = (self._folder / name.strip()).read_bytes()
        except OSError as error:
            raise MissingNeighbour(name) from error
        return self._read[name]

    def contents(self) -> tuple[bytes, ...]:
        return tuple(self._read[name] for name in sorted(self._read))


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    # The engine logs tracebacks for textures it cannot find, and textures are of no use here.
    logger = logging.getLogger("trimesh")
    level = logger.level
    logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        logger.setLevel(level)


def _first_line(error: Exception) -> str:
    text = str(error).strip().splitlines()
    return text[0][:200] if text else type(error).__name__
