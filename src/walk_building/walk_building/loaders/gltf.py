# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a glTF file needs, asked before the mesh engine reads it: the engine fills in zeros for what it lacks."""

from __future__ import annotations

import importlib.util
import json
import struct
from pathlib import Path
from typing import Any

from walk_building.errors import BuildingError

_DRACO = "KHR_draco_mesh_compression"
_INSTANCING = "EXT_mesh_gpu_instancing"
_QUANTIZED = "KHR_mesh_quantization"

# Looks, lights and metadata: a walker cannot bump into them.
_HARMLESS = ("KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "KHR_animation_", "KHR_xmp", "MSFT_")
_TRIANGLE_FAN = 6
_JSON_CHUNK = 0x4E4F534A


def check_gltf(path: Path) -> list[str]:
    """Returns warnings about what the mesh engine will leave out of a `.gltf` or `.glb` file.

    Raises:
        BuildingError: It is no glTF 2, or it needs an extension or an encoding that the engine does not read.
    """
    tree = _tree(path)
    version = str(_dict(tree.get("asset")).get("version", "2.0"))
    if not version.startswith("2"):
        raise BuildingError(path, f"is glTF {version}; export it as glTF 2.0")
    used = {str(name) for key in ("extensionsRequired", "extensionsUsed") for name in _list(tree.get(key))}
    required = {str(name) for name in _list(tree.get("extensionsRequired"))}
    _check_compression(path, used, required)
    _check_accessors(path, tree)
    return _left_out(tree)


def _tree(path: Path) -> dict[str, Any]:
    data = path.read_bytes()
    if path.suffix.lower() == ".glb":
        if data[:4] != b"glTF" or len(data) < 20:
            raise BuildingError(path, "is not a GLB file (it does not start with glTF)")
        _, _, total, length, kind = struct.unpack_from("<IIIII", data)
        if kind != _JSON_CHUNK or len(data) < total:
            raise BuildingError(path, "is damaged or cut short; copy or export it again")
        data = data[20 : 20 + length]
    try:
        tree = json.loads(data)
    except (ValueError, RecursionError) as error:
        raise BuildingError(path, f"is not a glTF file (its JSON cannot be read: {error})") from error
    if not isinstance(tree, dict) or "asset" not in tree:
        raise BuildingError(path, 'is not a glTF file (it has no "asset")')
    return tree


def _check_compression(path: Path, used: set[str], required: set[str]) -> None:
    again = "export it again without that extension"
    if _DRACO in used and importlib.util.find_spec("DracoPy") is None:
        raise BuildingError(path, f"is compressed with {_DRACO}; pip install DracoPy, or {again}")
    if _INSTANCING in used:
        raise BuildingError(path, f"places copies with {_INSTANCING}, which is not read; {again}")
    known = (*_HARMLESS, _DRACO, _QUANTIZED)
    unknown = sorted(name for name in required if not name.startswith(known))
    if unknown:
        raise BuildingError(path, f"needs {', '.join(unknown)}, which is not read; {again}")


def _check_accessors(path: Path, tree: dict[str, Any]) -> None:
    accessors = _list(tree.get("accessors"))
    for primitive in _primitives(tree):
        indices = [_dict(primitive.get("attributes")).get("POSITION"), primitive.get("indices")]
        for index in indices:
            if not isinstance(index, int) or not 0 <= index < len(accessors):
                continue
            accessor = _dict(accessors[index])
            if "sparse" in accessor:
                raise BuildingError(path, "stores geometry in sparse accessors, which are not read; export it again")
            if accessor.get("normalized"):
                raise BuildingError(path, f"stores normalized positions ({_QUANTIZED}); export it without quantization")


def _left_out(tree: dict[str, Any]) -> list[str]:
    fans = sum(primitive.get("mode") == _TRIANGLE_FAN for primitive in _primitives(tree))
    return [f"{fans} triangle fans were left out; only triangles and strips are read."] if fans else []


def _primitives(tree: dict[str, Any]) -> list[dict[str, Any]]:
    meshes = [_dict(mesh) for mesh in _list(tree.get("meshes"))]
    return [_dict(primitive) for mesh in meshes for primitive in _list(mesh.get("primitives"))]


def _list(value: object) -> list[Any]:
    return value if isinstance(value, list) else []


def _dict(value: object) -> dict[str, Any]:
    return value if isinstance(value, dict) else {}
