# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What became of keypoints that the tour does not pass where they are wished."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from walk_building.building import Building
from walk_sequencer.editing import EditingConfig
from walk_sequencer.tour import Tour


def misplaced(
    building: Building, keypoints: ArrayLike, tour: Tour, pull_m: float = EditingConfig().pull_m
) -> dict[int, str]:
    """Returns, by index, where a keypoint is wished and why it is left out or moved; the words follow its name.

    One that is pulled to a place beside a wall it touches, no farther than `pull_m`, is where it is wished.

    Args:
        building: Its file's coordinates are those that are told.
        keypoints: (K, 3) eye positions as they are wished [m].
        tour: Through them.
        pull_m: How far is too far.
    """
    positions = np.asarray(keypoints, dtype=np.float64).reshape(-1, 3)
    found = {left.index: f"is left out: {left.reason}" for left in tour.unreachable}
    pulled_m = np.linalg.norm(tour.stands[:, :2] - positions[:, :2], axis=1)
    for index in np.flatnonzero(pulled_m > pull_m).tolist():  # nan where it cannot stand, which is no distance
        found[index] = (
            f"is moved by {pulled_m[index]:.2f} m to the nearest place to stand on: it is in a wall or furniture, or "
            "too near to it for the walker's body"
        )
    there = building.to_file(positions)
    return {
        index: f"at ({', '.join(f'{value:.2f}' for value in there[index])}) {found[index]}" for index in sorted(found)
    }
