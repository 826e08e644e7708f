# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""All figures of a walkthrough as plain data: what report.json holds."""

from __future__ import annotations

import dataclasses
import importlib.metadata
import math
import platform
from typing import Any

import numpy as np

from walk_building.building import Building
from walk_plan.profile import storeys_along
from walk_plan.quality import PathQuality
from walk_plan.stages import peak_memory_mib
from walk_plan.walkthrough import Walkthrough

FORMAT = 1
"""Rises when a key of report.json changes its meaning."""

ENGINES = (
    "numpy",
    "scipy",
    "numba",
    "ompl",
    "python-fcl",
    "trimesh",
    "ifcopenshell",
    "shapely",
    "matplotlib",
    "rosbags",
)


def summary(walkthrough: Walkthrough) -> dict[str, Any]:
    """Returns the figures, parameters, versions and costs of a plan, ready for JSON.

    Lengths in metres, times in seconds, positions z up in the building file's own coordinates; figures that have
    no meaning for this walk are null.
    """
    building, tour, path = walkthrough.building, walkthrough.tour, walkthrough.path
    report = {
        "format": FORMAT,
        "versions": versions(),
        "building": _building(walkthrough),
        "config": dataclasses.asdict(walkthrough.config),
        "warnings": walkthrough.warnings,
        "importance": {
            "voxel_size_m": walkthrough.importance_map.grid.voxel_size_m,
            "shape": walkthrough.importance_map.grid.shape,
            "visibility_stderr": walkthrough.importance_map.visibility_stderr,
            "notes": walkthrough.importance_map.notes,
        },
        "keypoints": _keypoints(walkthrough),
        "tour": {
            "method": tour.method,
            "length_m": tour.length_m,
            "unreachable": [
                {"position_m": _in_file(walkthrough, u.index), "reason": u.reason} for u in tour.unreachable
            ],
        },
        "trajectory": {
            "points": len(path.points),
            "samples": len(walkthrough.trajectory.t_s),
            "solver": path.solver,
            "iterations": path.iterations,
            "cost": path.cost,
            "repaired": [dataclasses.asdict(stretch) for stretch in path.repaired],
            "colliding": [dataclasses.asdict(stretch) for stretch in path.colliding],
        },
        "quality": [named_rooms(building, quality) for quality in walkthrough.qualities],
        "rooms": [
            {
                "name": building.rooms[visit.room].name,
                "storey": building.storeys[building.rooms[visit.room].storey].name,
                "area_m2": building.rooms[visit.room].area_m2,
                "reachable": building.rooms[visit.room].reachable,
                "visited": visit.entered,
                "keypoints": visit.keypoints,
                "reason": visit.reason,
            }
            for visit in walkthrough.visits
        ],
        "stages_s": walkthrough.stage_s,
        "total_s": sum(walkthrough.stage_s.values()),
        "peak_memory_mib": peak_memory_mib(),
    }
    plain = as_plain(report)
    assert isinstance(plain, dict)
    return plain


def versions() -> dict[str, str]:
    """Returns the versions of Python and of the engines that are installed."""
    found = {"python": platform.python_version()}
    for name in ENGINES:
        try:
            found[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            found[name] = "not installed"
    return found


def as_plain(value: Any) -> Any:
    """Returns nested data with numpy's types turned into Python's, and what is not finite into None."""
    if isinstance(value, dict):
        return {str(key): as_plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [as_plain(entry) for entry in value]
    if isinstance(value, np.generic):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value


def named_rooms(building: Building, quality: PathQuality) -> dict[str, Any]:
    """Returns the figures of a walk by name, with names for the rooms it enters and for those it misses."""
    rooms = building.rooms
    figures = dataclasses.asdict(quality)
    figures["rooms"] = [rooms[room].name for room in quality.rooms]
    figures["rooms_missed"] = [
        room.name for index, room in enumerate(rooms) if room.reachable and index not in quality.rooms
    ]
    return figures


def _building(walkthrough: Walkthrough) -> dict[str, Any]:
    building = walkthrough.building
    model = building.model
    return {
        "file": model.source.name,
        "hash": building.hash,
        "content_hash": model.content_hash,
        "triangles": len(model.faces),
        "size_m": np.ptp(building.geometry.bounds, axis=0),
        "units_m": model.units_m,
        "offset_m": model.offset_m,
        "storeys": [
            {"name": storey.name, "elevation_m": storey.elevation_m + model.offset_m[2]} for storey in building.storeys
        ],
        "rooms": len(building.rooms),
        "reachable_area_m2": float(building.reachable.sum() * building.surface.place_area_m2),
    }


def _keypoints(walkthrough: Walkthrough) -> list[dict[str, Any]]:
    building = walkthrough.building
    storeys = storeys_along(building, walkthrough.keypoints)
    rows = []
    for number, (keypoint, storey) in enumerate(zip(walkthrough.tour.order, storeys, strict=True), start=1):
        room = int(walkthrough.suggestion.room[keypoint])
        rows.append(
            {
                "number": number,
                "position_m": _in_file(walkthrough, int(keypoint)),
                "storey": building.storeys[storey].name if storey >= 0 else "",
                "room": building.rooms[room].name if room >= 0 else "",
                "score": walkthrough.suggestion.score[keypoint],
            }
        )
    return rows


def _in_file(walkthrough: Walkthrough, keypoint: int) -> Any:
    return walkthrough.building.to_file(walkthrough.suggestion.positions[keypoint][None, :])[0]
