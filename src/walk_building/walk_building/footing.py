# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From a point in space, as a hand or a mouse gives it, to where the walker's eye would be there."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from walk_building.building import Building
from walk_building.errors import ParameterError


def eye_over_floor(building: Building, point: ArrayLike) -> NDArray[np.float64]:
    """Returns the eye position (3,) over the floor that lies below a point (3,) [m].

    A hand lifts a keypoint off its height or lowers it; what it means is the place on the floor. Where nothing
    lies below within the height of a storey, the point is returned as it is.
    """
    eye = np.array(point, dtype=np.float64)
    if eye.shape != (3,) or not all(map(math.isfinite, eye.tolist())):
        raise ParameterError("point", eye.tolist(), "three finite coordinates in metres")
    drop = building.geometry.drop_below(*eye.tolist())
    if drop <= 2 * building.walker.eye_height_m:
        eye[2] += building.walker.eye_height_m - drop
    eye.setflags(write=False)
    return eye


def room_name(building: Building, eye: ArrayLike) -> str:
    """Returns the name of the room in which a walker with this eye position (3,) stands, "" if it is in none."""
    floor = np.array(eye, dtype=np.float64) - [0.0, 0.0, building.walker.eye_height_m]
    place = int(building.surface.nearest(floor[None])[0])
    room = int(building.surface.room[place]) if place >= 0 else -1
    return building.rooms[room].name if room >= 0 else ""
