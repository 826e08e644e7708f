# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Which rooms a walk enters, and why it leaves the others out."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_importance.keypoints import Suggestion


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class RoomVisit:
    """What became of one room."""

    room: int  # index into Building.rooms
    keypoints: tuple[int, ...]  # numbers on the tour, from 1, of the keypoints in it
    entered: bool
    reason: str  # why it was not entered, "" if it was


def rooms_entered(building: Building, eyes: NDArray[np.float64]) -> tuple[int, ...]:
    """Returns the rooms that the eyes (n, 3) pass through, each once, in the order of the first time."""
    feet = eyes - [0.0, 0.0, building.walker.eye_height_m]
    room = building.surface.room[building.surface.nearest(feet)]
    first = np.sort(np.unique(room, return_index=True)[1])
    return tuple(int(room[i]) for i in first if room[i] >= 0)


def room_visits(
    building: Building, suggestion: Suggestion, order: NDArray[np.int64], entered: tuple[int, ...]
) -> tuple[RoomVisit, ...]:
    """Returns one entry for each room of the building, in the building's order.

    Args:
        building: With the rooms.
        suggestion: The keypoints and the rooms that got none.
        order: (M,) the keypoints as they are visited.
        entered: The rooms that the walk enters.
    """
    skipped = {skip.room: skip.reason for skip in suggestion.skipped}
    numbers: dict[int, list[int]] = {}
    for number, keypoint in enumerate(order, start=1):
        numbers.setdefault(int(suggestion.room[keypoint]), []).append(number)
    visits = []
    for index, room in enumerate(building.rooms):
        here = index in entered
        passed = tuple(numbers.get(index, ()))
        reason = "" if here else skipped.get(index) or room.reason or _not_entered(passed)
        visits.append(RoomVisit(room=index, keypoints=passed, entered=here, reason=reason))
    return tuple(visits)


def _not_entered(keypoints: tuple[int, ...]) -> str:
    if not keypoints:
        return "no viewpoint was placed in it"
    return "the smoothed walk turns round at its door, just before viewpoint " + ", ".join(map(str, keypoints))
