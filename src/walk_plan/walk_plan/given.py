# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Keypoints that the user brings in place of those that the importance map suggests."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from walk_bag.keypoint_files import ImportedKeypoints
from walk_building.building import Building
from walk_importance.importance_map import ImportanceMap
from walk_importance.keypoints import SkippedRoom, Suggestion
from walk_importance.view import quat_xyzw_from_yaw, view_yaws
from walk_sequencer.tour import Tour


def given_suggestion(building: Building, importance_map: ImportanceMap, given: ImportedKeypoints) -> Suggestion:
    """Returns the user's keypoints as if they had been suggested, in the user's order.

    Those that say no look get the one in which most is seen.

    Args:
        building: In which they lie.
        importance_map: Its maps, for scores and looks.
        given: The keypoints.
    """
    eyes = building.from_file(given.positions) if given.of_building else given.positions.copy()
    feet = eyes - [0.0, 0.0, building.walker.eye_height_m]
    place = building.surface.nearest(feet)
    room = building.surface.room[place].astype(np.int64)
    arrays = {
        "positions": eyes,
        "quat_xyzw": np.where(given.looks[:, None], given.quat_xyzw, _best_looks(building, importance_map, eyes)),
        "score": importance_map.at(eyes).astype(np.float64),
        "room": room,
        "place": place.astype(np.int64),
    }
    for array in arrays.values():
        array.setflags(write=False)
    skipped = tuple(
        SkippedRoom(room=index, reason=one.reason or f"no keypoint of {given.source} is in it")
        for index, one in enumerate(building.rooms)
        if index not in room
    )
    return Suggestion(**arrays, skipped=skipped)


def left_out(given: ImportedKeypoints, tour: Tour) -> tuple[str, ...]:
    """Returns a sentence for each of the user's keypoints that the tour leaves out."""
    return tuple(f"{given.name_of(u.index)} is left out: {u.reason}." for u in tour.unreachable)


def _best_looks(building: Building, importance_map: ImportanceMap, eyes: NDArray[np.float64]) -> NDArray[np.float64]:
    return quat_xyzw_from_yaw(view_yaws(building.geometry, importance_map, eyes))
