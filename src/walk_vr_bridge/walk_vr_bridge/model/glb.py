# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A writer for quantised GLB files whose meshes know the names of the parts they were made of.

In the axes of the map, z up; see docs/protocol.md for the layout.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from walk_vr_bridge.model.pieces import GROUPS, Piece

ALL_STOREYS = -1
_SHORT, _USHORT, _UINT = 5122, 5123, 5125  # component types
_VERTICES, _INDICES = 34962, 34963  # buffer targets
_MAGIC, _JSON, _BIN = 0x46546C67, 0x4E4F534A, 0x004E4942
_STEPS = 32767
_STRIDE = 8  # three int16, filled up to four bytes as glTF wants it


def batches(pieces: Sequence[Piece], most: int) -> list[tuple[str, int, list[Piece]]]:
    """Returns the pieces that are drawn in one go: by group and storey, or by group alone where that is too many."""
    by_storey: dict[tuple[str, int], list[Piece]] = {}
    for piece in pieces:
        by_storey.setdefault((piece.group, piece.storey), []).append(piece)
    if len(by_storey) <= most:
        return [(group, storey, found) for (group, storey), found in sorted(by_storey.items())]
    by_group: dict[str, list[Piece]] = {}
    for piece in pieces:
        by_group.setdefault(piece.group, []).append(piece)
    return [(group, ALL_STOREYS, found) for group, found in sorted(by_group.items())]


def write_glb(groups: Sequence[tuple[str, int, list[Piece]]], extras: dict[str, Any]) -> bytes:
    """Returns a GLB file with a node for each batch.

    Args:
        groups: Group, storey (or ALL_STOREYS) and pieces.
        extras: What is stored with the scene.
    """
    used = [name for name in GROUPS if any(name == group for group, _, _ in groups)]
    file: dict[str, list[Any]] = {"accessors": [], "bufferViews": [], "meshes": [], "nodes": []}
    binary = bytearray()
    for group, storey, pieces in groups:
        _add(file, binary, group, storey, pieces, used.index(group))
    document = {
        "asset": {"version": "2.0", "generator": "walk_vr_bridge"},
        "extensionsUsed": ["KHR_mesh_quantization"],
        "extensionsRequired": ["KHR_mesh_quantization"],
        "scene": 0,
        "scenes": [{"nodes": list(range(len(file["nodes"]))), "extras": extras}],
        "materials": [_material(name) for name in used],
        "buffers": [{"byteLength": len(binary)}],
        **file,
    }
    text = json.dumps(document, separators=(",", ":"), ensure_ascii=False).encode()
    text += b" " * (-len(text) % 4)
    length = 12 + 8 + len(text) + 8 + len(binary)
    head = struct.pack("<III", _MAGIC, 2, length) + struct.pack("<II", len(text), _JSON)
    return head + text + struct.pack("<II", len(binary), _BIN) + bytes(binary)


def _add(
    file: dict[str, list[Any]], binary: bytearray, group: str, storey: int, pieces: list[Piece], material: int
) -> None:
    start = np.concatenate([[0], np.cumsum([len(p.vertices) for p in pieces])])
    vertices = np.concatenate([p.vertices for p in pieces])
    faces = np.concatenate([p.faces + first for p, first in zip(pieces, start[:-1], strict=True)])
    centre = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    # One scale for all axes, so that normals need no correction.
    scale = max(float(np.ptp(vertices, axis=0).max()) / 2 / _STEPS, 1e-6)
    whole = np.rint((vertices - centre) / scale).astype(np.int16)
    indices = _append(file, binary, faces.astype(np.uint16 if len(vertices) < 2**16 else np.uint32).reshape(-1))
    positions = _append(file, binary, whole)
    primitive = {"attributes": {"POSITION": positions}, "indices": indices, "material": material}
    file["meshes"].append({"name": group, "primitives": [primitive]})
    name = group if storey == ALL_STOREYS else f"{group}/{storey}"
    parts = [[p.name, p.kind, len(p.faces)] for p in pieces]
    file["nodes"].append(
        {
            "name": name,
            "mesh": len(file["meshes"]) - 1,
            "translation": centre.tolist(),
            "scale": [scale] * 3,
            "extras": {"group": group, "storey": storey, "parts": parts},
        }
    )


def _append(file: dict[str, list[Any]], binary: bytearray, array: NDArray[Any]) -> int:
    """Adds positions (V, 3) int16 or indices (n,) to the file; returns the accessor."""
    is_index = array.ndim == 1
    data = array if is_index else np.pad(array, ((0, 0), (0, 1)))
    view: dict[str, Any] = {"buffer": 0, "byteOffset": len(binary), "byteLength": data.nbytes}
    view |= {"target": _INDICES} if is_index else {"target": _VERTICES, "byteStride": _STRIDE}
    binary += data.tobytes()
    binary += bytes(-len(binary) % 4)
    file["bufferViews"].append(view)
    kind = {np.dtype(np.uint16): _USHORT, np.dtype(np.uint32): _UINT, np.dtype(np.int16): _SHORT}[array.dtype]
    accessor: dict[str, Any] = {"bufferView": len(file["bufferViews"]) - 1, "componentType": kind, "count": len(array)}
    accessor["type"] = "SCALAR" if is_index else "VEC3"
    if not is_index:
        accessor |= {"min": array.min(axis=0).tolist(), "max": array.max(axis=0).tolist()}
    file["accessors"].append(accessor)
    return len(file["accessors"]) - 1


def _material(group: str) -> dict[str, Any]:
    colour = GROUPS[group]
    surface = {"baseColorFactor": list(colour), "metallicFactor": 0.0, "roughnessFactor": 0.9}
    look = {"alphaMode": "BLEND"} if colour[3] < 1 else {}
    return {"name": group, "pbrMetallicRoughness": surface, "doubleSided": True, **look}
