# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Rooms in which a wide walker does not fit: they are there all the same, and whoever plans is told why not."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building, Room
from walk_building.storeys import storey_of
from walk_building.walker import Walker

_NOWHERE = np.empty(0, np.int64)


def usual_width(walker: Walker) -> Walker:
    """Returns the walker, no wider than the usual one: which rooms a building has does not depend on who walks."""
    return dataclasses.replace(walker, radius_m=min(walker.radius_m, Walker().radius_m))


def with_narrow_rooms(building: Building, usual: Building) -> Building:
    """Returns the building with the rooms of the usual walker in which, or into which, its own walker does not fit.

    Args:
        building: As its walker finds it.
        usual: The same model as a walker of the usual width finds it.
    """
    there = usual.surface.nearest(building.surface.places)
    # A part of the usual walker's that the wide one does not start in is closed to it for another reason.
    same_part = bool(usual.reachable[there[building.reachable]].any())
    width = f"a walker {2 * building.walker.radius_m:g} m wide"
    rooms = tuple(
        dataclasses.replace(room, reason=f"the way there is too narrow for {width}")
        if same_part and not room.reachable and len(room.places) and usual.reachable[there[room.places]].any()
        else room
        for room in building.rooms
    )
    entered = set(usual.surface.room[there[building.surface.room >= 0]].tolist())
    stood_in = set(usual.surface.room[there].tolist())  # in parts too small to be a room of their own, too
    closed = {}
    for index, room in enumerate(usual.rooms):
        if index not in entered and len(room.places):
            reason = f"the way there is too narrow for {width}" if index in stood_in else f"too narrow for {width}"
            closed[index] = dataclasses.replace(room, places=_NOWHERE, reachable=False, reason=room.reason or reason)
    declared = len(building.model.spaces)
    kept = [closed.get(index, room) for index, room in enumerate(rooms[:declared])]
    found = [_on_storey_of(building, room) for index, room in closed.items() if index >= declared]
    floor = usual.surface.places[usual.reachable | (usual.surface.indoor & (usual.surface.room >= 0))]
    floor.setflags(write=False)
    return dataclasses.replace(
        building, rooms=(*kept, *rooms[declared:], *_named(building, rooms[declared:], found)), narrow_floor=floor
    )


def _on_storey_of(building: Building, room: Room) -> Room:
    return dataclasses.replace(room, storey=int(storey_of(building.storeys, room.centre[None, 2])[0]))


def _named(building: Building, there: tuple[Room, ...], added: list[Room]) -> list[Room]:
    """Returns rooms that are no declared spaces with numbers that go on behind those of their storey."""
    count = [sum(room.storey == storey for room in there) for storey in range(len(building.storeys))]
    named = []
    for room in added:
        count[room.storey] += 1
        name = f"{building.storeys[room.storey].name}, room {count[room.storey]}"
        named.append(dataclasses.replace(room, name=name))
    return named


def usual_floor(building: Building, storey: int) -> NDArray[np.float64]:
    """Returns where a walker of the usual width stands on a storey (n, 3); empty where the walker is no wider."""
    floor = building.narrow_floor
    return floor[storey_of(building.storeys, floor[:, 2]) == storey] if len(floor) else floor
