# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A building to plan in: its triangles, its walkable surface, its storeys and rooms."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import ArrayLike, NDArray

from walk_building.closed_doors import ClosedDoor
from walk_building.geometry import Geometry, as_points
from walk_building.model import Model, Storey
from walk_building.surface import WalkableSurface
from walk_building.walker import Walker


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Room:
    """A room: a declared space, or a piece of the walkable surface between doorways."""

    name: str
    storey: int  # index into Building.storeys
    area_m2: float  # of the floor a walker can stand on
    centre: NDArray[np.float64]  # (3,) the place of the room farthest from its walls, on the floor [m]
    places: NDArray[np.int64]  # (K,) indices into the surface's places; empty where nobody can stand in it
    reachable: bool
    reason: str  # why it cannot be reached, in words; "" where it can


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Building:
    """Everything the planner knows about a building. Immutable, positions in the model's coordinates."""

    model: Model
    walker: Walker
    geometry: Geometry
    surface: WalkableSurface
    storeys: tuple[Storey, ...]  # lowest first
    rooms: tuple[Room, ...]
    start_component: int  # the part of the surface that the tour is in
    reachable: NDArray[np.bool_]  # (P,) the places of the surface that the tour may use
    entrance: int  # the reachable place where one comes in from outdoors, -1 where there is none
    hash: str  # of the file, the load options and the walker, hex
    warnings: tuple[str, ...]  # sentences for the user
    closed_doors: tuple[ClosedDoor, ...] = ()  # leaves that look like closed doors, where the file names no door
    # (M, 3) where a walker of the usual width stands, for one who is wider; empty for all others
    narrow_floor: NDArray[np.float64] = dataclasses.field(default_factory=lambda: np.empty((0, 3)))

    def to_file(self, points: ArrayLike) -> NDArray[np.float64]:
        """Returns points (N, 3) in the file's own coordinates, in metres and z up."""
        return as_points("points", points) + self.model.offset_m

    def from_file(self, points: ArrayLike) -> NDArray[np.float64]:
        """Returns points (N, 3) of the file's own coordinates, in metres and z up, in the model's."""
        return as_points("points", points) - self.model.offset_m

    def eyes(self, places: NDArray[np.int64]) -> NDArray[np.float64]:
        """Returns the eye positions (N, 3) of a walker who stands on the given places."""
        return self.surface.places[places] + np.array([0.0, 0.0, self.walker.eye_height_m])
