# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""All that a page loads of a building, made once."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from walk_building.building import Building
from walk_building.progress import Progress, no_progress
from walk_vr_bridge.config import BridgeConfig
from walk_vr_bridge.content import Content, content
from walk_vr_bridge.model.floor import floor_of
from walk_vr_bridge.model.glb import batches, write_glb
from walk_vr_bridge.model.pieces import Piece, pieces_of
from walk_vr_bridge.model.simplify import simplify

PROTOCOL = 1
FULL_MESHES, MINIATURE_MESHES = 16, 6
_GLB = "model/gltf-binary"


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """A building ready to be served."""

    hash: str
    building: Content
    miniature: Content
    description: dict[str, Any]


def make_scene(building: Building, config: BridgeConfig, progress: Progress = no_progress) -> Scene:
    """Returns meshes and description of a building."""
    pieces = pieces_of(building)
    progress("page", 0.2)
    full = simplify(pieces, config.full_triangles)
    progress("page", 0.5)
    small = simplify(full, config.miniature_triangles)
    progress("page", 0.8)
    extras = {"hash": building.hash, "up": "z"}
    building_batches = batches(full, FULL_MESHES)
    miniature_batches = batches(small, 0)
    assert len(miniature_batches) <= MINIATURE_MESHES
    files = [content(write_glb(groups, extras), _GLB) for groups in (building_batches, miniature_batches)]
    count = sum(len(p.faces) for p in pieces)
    glb = {
        "building": _told("/building.glb", files[0], full, len(building_batches), count),
        "miniature": _told("/miniature.glb", files[1], small, len(miniature_batches), count),
    }
    description = describe(building) | {"glb": glb}
    progress("page", 1.0)
    return Scene(hash=building.hash, building=files[0], miniature=files[1], description=description)


def describe(building: Building) -> dict[str, Any]:
    """Returns what building.json says, without the meshes."""
    walker, surface = building.walker, building.surface
    low, high = building.geometry.bounds
    reachable = np.flatnonzero(building.reachable)
    start = building.entrance if building.entrance >= 0 else int(reachable[0]) if len(reachable) else 0
    return {
        "protocol": PROTOCOL,
        "name": building.model.source.name,
        "hash": building.hash,
        "units": "m",
        "up": "z",
        "frame": "map",
        "offset_m": building.model.offset_m.tolist(),
        "bounds": {"min": low.tolist(), "max": high.tolist()},
        "walker": {
            "eye_height_m": walker.eye_height_m,
            "height_m": walker.height_m,
            "radius_m": walker.radius_m,
            "step_m": walker.step_m,
        },
        "start": surface.places[start].tolist(),
        "storeys": [
            {
                "name": storey.name,
                "floor_z_m": storey.elevation_m,
                "floor": np.round(floor_of(building, index), 3).tolist(),
            }
            for index, storey in enumerate(building.storeys)
        ],
        "rooms": [
            {
                "name": room.name,
                "storey": room.storey,
                "centre": np.asarray(room.centre).tolist(),
                "area_m2": room.area_m2,
                "reachable": room.reachable,
                "reason": room.reason,
            }
            for room in building.rooms
        ],
        "warnings": list(building.warnings),
    }


def _told(url: str, file: Content, pieces: list[Piece], meshes: int, in_file: int) -> dict[str, Any]:
    triangles = sum(len(p.faces) for p in pieces)
    return {
        "url": url,
        "etag": file.etag.strip('"'),
        "bytes": len(file.gzipped or file.data),
        "triangles": triangles,
        "triangles_in_file": in_file,
        "simplified": triangles < in_file,
        "meshes": meshes,
        "parts": len(pieces),
    }
