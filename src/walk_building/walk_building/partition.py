# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The floor divided: what is indoors, what can be walked to, which room is where."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Room
from walk_building.ground import Ground
from walk_building.porches import porch_places
from walk_building.regions import components, start_component
from walk_building.rooms import find_rooms


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Partition:
    """Parts and rooms of the P places of a building; see Building and WalkableSurface."""

    indoor: NDArray[np.bool_]  # (P,)
    component: NDArray[np.int32]  # (P,)
    start: int
    reachable: NDArray[np.bool_]  # (P,)
    rooms: tuple[Room, ...]
    room: NDArray[np.int32]  # (P,)


def partition(ground: Ground, indoor: NDArray[np.bool_], *, outdoors: bool) -> Partition:
    """Returns the parts and rooms, without the porches that only lead in.

    A porch that joins two halves of a building is a way through it, and stays.

    Args:
        ground: The places.
        indoor: (P,) those with the building around or above them.
        outdoors: Whether the walker may leave the building.
    """
    whole = _divide(ground, indoor, outdoors)
    found = whole.rooms[len(ground.model.spaces) :]
    porch = porch_places(found, ground.places, ground.indptr, ground.neighbours, indoor)
    if not porch.any():
        return whole
    without = _divide(ground, indoor & ~porch, outdoors)
    return without if np.array_equal(without.reachable | porch, whole.reachable | porch) else whole


def _divide(ground: Ground, indoor: NDArray[np.bool_], outdoors: bool) -> Partition:
    allowed = np.ones_like(indoor) if outdoors else indoor
    component = components(ground.indptr, ground.neighbours, allowed)
    in_space = ground.space >= 0
    start = start_component(component, indoor & in_space if in_space.any() else indoor)
    reachable = (component == start) & allowed
    rooms, room = find_rooms(ground, indoor, component, reachable)
    return Partition(indoor=indoor, component=component, start=start, reachable=reachable, rooms=rooms, room=room)
