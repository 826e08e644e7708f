# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Keypoints that the user brings in place of those that the importance map suggests."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_importance.importance_map import ImportanceMap
from walk_importance.keypoints import SkippedRoom, Suggestion
from walk_importance.view import quat_xyzw_from_yaw, view_yaws


def given_suggestion(
    building: Building,
    importance_map: ImportanceMap,
    eyes: NDArray[np.float64],
    quat_xyzw: NDArray[np.float64],
    looks: NDArray[np.bool_],
    source: str,
) -> Suggestion:
    """Returns the user's keypoints as if they had been suggested, in the user's order.

    Args:
        building: In which they lie.
        importance_map: Its maps, for scores and looks.
        eyes: (K, 3) eye positions [m].
        quat_xyzw: (K, 4) where each looks.
        looks: (K,) whether that counts; the others get the look in which most is seen.
        source: What to call where they come from.
    """
    feet = eyes - [0.0, 0.0, building.walker.eye_height_m]
    place = building.surface.nearest(feet)
    room = building.surface.room[place].astype(np.int64)
    best = quat_xyzw_from_yaw(view_yaws(building.geometry, importance_map, eyes))
    arrays = {
        "positions": eyes.copy(),
        "quat_xyzw": np.where(looks[:, None], quat_xyzw, best),
        "score": importance_map.at(eyes).astype(np.float64),
        "room": room,
        "place": place.astype(np.int64),
    }
    for array in arrays.values():
        array.setflags(write=False)
    skipped = tuple(
        SkippedRoom(room=index, reason=one.reason or f"no keypoint of {source} is in it")
        for index, one in enumerate(building.rooms)
        if index not in room
    )
    return Suggestion(**arrays, skipped=skipped)
