# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Plausible moves of a hand: from a keypoint over the floor to a place that can be walked to in a line, and back."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building

NEAR_M, FAR_M = 0.4, 1.6
"""How far a hand takes a keypoint."""

_TRIES = 200


def stroke(
    building: Building,
    eye: NDArray[np.float64],
    count: int,
    speed_mps: float,
    rate_hz: float,
    dice: np.random.Generator,
) -> NDArray[np.float64]:
    """Returns the eye positions (count, 3) of a drag that begins at a keypoint's eye position (3,).

    The hand goes to a place drawn at random, slows down, and goes to the next one; where no place is near it stays
    and trembles by a millimetre.
    """
    rows: list[NDArray[np.float64]] = []
    here, length = eye, 0
    while length < count:
        there = _reachable(building, here, dice)
        if there is None:
            piece = here + dice.uniform(-1e-3, 1e-3, (count - length, 3)) * [1.0, 1.0, 0.0]
        else:
            steps = max(int(np.linalg.norm(there - here) / speed_mps * rate_hz), 2)
            share = 0.5 - 0.5 * np.cos(np.pi * np.arange(1, steps + 1) / steps)
            piece = here + share[:, None] * (there - here)
            here = there
        rows.append(piece)
        length += len(piece)
    return np.concatenate(rows)[:count]


def _reachable(building: Building, eye: NDArray[np.float64], dice: np.random.Generator) -> NDArray[np.float64] | None:
    """Returns the eye over a place near, in a straight walk from below the eye; None where none is found."""
    surface = building.surface
    feet = eye - [0.0, 0.0, building.walker.eye_height_m]
    gap = np.linalg.norm(surface.places - feet, axis=1)
    near = np.flatnonzero(building.reachable & (gap >= NEAR_M) & (gap <= FAR_M))
    own = int(surface.nearest(feet[None], building.reachable)[0])
    for place in dice.permutation(near)[:_TRIES].tolist():
        if surface.segment_walkable(own, place, building.reachable):
            return np.asarray(building.eyes(np.array([place]))[0])
    return None
