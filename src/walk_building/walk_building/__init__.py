# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Building files as something to plan in: triangles, rooms, storeys, walkable surface, exact queries."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from walk_building.building import Building, Room
    from walk_building.closed_doors import ClosedDoor
    from walk_building.config import Config, param
    from walk_building.errors import BuildingError, ParameterError, WalkError
    from walk_building.geometry import Closest, Geometry, RayHits
    from walk_building.model import Door, LoadOptions, Model, Part, Space, Storey
    from walk_building.pipeline import load_building, prepare_building
    from walk_building.progress import Progress, no_progress
    from walk_building.surface import WalkableSurface
    from walk_building.sweep import BodySweep
    from walk_building.walker import Walker

__all__ = [
    "BodySweep",
    "Building",
    "BuildingError",
    "ClosedDoor",
    "Closest",
    "Config",
    "Door",
    "Geometry",
    "LoadOptions",
    "Model",
    "ParameterError",
    "Part",
    "Progress",
    "RayHits",
    "Room",
    "Space",
    "Storey",
    "WalkError",
    "WalkableSurface",
    "Walker",
    "load_building",
    "no_progress",
    "param",
    "prepare_building",
]

_HOMES = {
    "walk_building.building": ("Building", "Room"),
    "walk_building.closed_doors": ("ClosedDoor",),
    "walk_building.config": ("Config", "param"),
    "walk_building.errors": ("BuildingError", "ParameterError", "WalkError"),
    "walk_building.geometry": ("Closest", "Geometry", "RayHits"),
    "walk_building.model": ("Door", "LoadOptions", "Model", "Part", "Space", "Storey"),
    "walk_building.pipeline": ("load_building", "prepare_building"),
    "walk_building.progress": ("Progress", "no_progress"),
    "walk_building.surface": ("WalkableSurface",),
    "walk_building.sweep": ("BodySweep",),
    "walk_building.walker": ("Walker",),
}


def __getattr__(name: str) -> object:
    """Imports what is asked for: all of it at once would keep every executable from starting at once."""
    for module, names in _HOMES.items():
        if name in names:
            return getattr(importlib.import_module(module), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
