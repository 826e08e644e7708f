# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A writer for the few parts of binary glTF 2.0 that a walkthrough needs.

Our own: the maintained writers either leave out animations or cameras.
"""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

_FLOAT, _UINT = 5126, 5125  # component types
_VERTICES, _INDICES = 34962, 34963  # buffer targets
_MAGIC, _JSON, _BIN = 0x46546C67, 0x4E4F534A, 0x004E4942


class GltfFile:
    """A scene that is built up piece by piece; positions in metres, y up. Every method returns the piece's index.

    Attributes:
        extras: What is stored with the scene, anything JSON can hold.
    """

    def __init__(self) -> None:
        self.extras: dict[str, Any] = {}
        self._binary = bytearray()
        self._lists: dict[str, list[dict[str, Any]]] = {}

    def material(self, name: str, rgba: tuple[float, float, float, float]) -> int:
        """Adds a matt colour that is seen from both sides."""
        surface = {"baseColorFactor": list(rgba), "metallicFactor": 0.0, "roughnessFactor": 0.9}
        return self._add("materials", {"name": name, "pbrMetallicRoughness": surface, "doubleSided": True})

    def positions(self, vertices: NDArray[np.float64]) -> int:
        """Adds vertices (V, 3) that several meshes can share."""
        return self._accessor(vertices.astype("<f4"), "VEC3", _FLOAT, _VERTICES, limits=True)

    def mesh(self, name: str, vertices: int | NDArray[np.float64], faces: ArrayLike, material: int) -> int:
        """Adds triangles; `vertices` is what `positions` returned, or an array of their own."""
        shared = vertices if isinstance(vertices, int) else self.positions(vertices)
        indices = self._accessor(np.asarray(faces, "<u4").reshape(-1), "SCALAR", _UINT, _INDICES, limits=True)
        piece = {"attributes": {"POSITION": shared}, "indices": indices, "material": material}
        return self._add("meshes", {"name": name, "primitives": [piece]})

    def camera(self, name: str, field_of_view_rad: float) -> int:
        """Adds a perspective camera with an upright field of view."""
        lens = {"yfov": field_of_view_rad, "znear": 0.05, "aspectRatio": 16 / 9}
        return self._add("cameras", {"name": name, "type": "perspective", "perspective": lens})

    def node(self, name: str, **properties: Any) -> int:
        """Adds a node to the scene with properties of glTF: mesh, camera, translation (3,), rotation xyzw (4,)."""
        plain = {k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in properties.items()}
        return self._add("nodes", {"name": name, **plain})

    def animation(
        self,
        name: str,
        node: int,
        t_s: NDArray[np.float64],
        translation: NDArray[np.float64],
        rotation_xyzw: NDArray[np.float64],
    ) -> int:
        """Moves a node through keyframes: times (k,) [s] from 0, positions (k, 3), unit quaternions (k, 4)."""
        times = self._accessor(t_s.astype("<f4"), "SCALAR", _FLOAT, None, limits=True)
        outputs = {
            "translation": self._accessor(translation.astype("<f4"), "VEC3", _FLOAT, None),
            "rotation": self._accessor(rotation_xyzw.astype("<f4"), "VEC4", _FLOAT, None),
        }
        samplers = [{"input": times, "output": output, "interpolation": "LINEAR"} for output in outputs.values()]
        channels = [{"sampler": i, "target": {"node": node, "path": path}} for i, path in enumerate(outputs)]
        return self._add("animations", {"name": name, "samplers": samplers, "channels": channels})

    def to_bytes(self) -> bytes:
        """Returns the file."""
        document: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "walk_bag"},
            "scene": 0,
            "scenes": [{"nodes": list(range(len(self._lists.get("nodes", [])))), "extras": self.extras}],
            "buffers": [{"byteLength": len(self._binary)}],
            **self._lists,
        }
        text = json.dumps(document, separators=(",", ":")).encode()
        # Chunks end on four bytes: text is filled up with spaces, binary data with zeros (which it is already).
        text += b" " * (-len(text) % 4)
        length = 12 + 8 + len(text) + 8 + len(self._binary)
        head = struct.pack("<III", _MAGIC, 2, length) + struct.pack("<II", len(text), _JSON)
        return head + text + struct.pack("<II", len(self._binary), _BIN) + bytes(self._binary)

    def _accessor(
        self, array: NDArray[Any], kind: str, component: int, target: int | None, limits: bool = False
    ) -> int:
        view: dict[str, Any] = {"buffer": 0, "byteOffset": len(self._binary), "byteLength": array.nbytes}
        if target is not None:
            view["target"] = target
        self._binary += np.ascontiguousarray(array).tobytes()
        self._binary += bytes(-len(self._binary) % 4)
        accessor: dict[str, Any] = {
            "bufferView": self._add("bufferViews", view), "componentType": component, "count": len(array), "type": kind,
        }  # fmt: skip
        if limits:
            accessor["min"] = np.atleast_1d(array.min(axis=0)).tolist()
            accessor["max"] = np.atleast_1d(array.max(axis=0)).tolist()
        return self._add("accessors", accessor)

    def _add(self, kind: str, entry: dict[str, Any]) -> int:
        entries = self._lists.setdefault(kind, [])
        entries.append(entry)
        return len(entries) - 1
