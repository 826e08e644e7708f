# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What to look at near each keypoint."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

LOOK_DISTANCE_M = 3.0
"""How far ahead of a keypoint its target lies: a room's width, so that it stays ahead while one walks up to it."""


NOWHERE = np.full(3, np.nan)
"""What stands for no chosen point."""


def look_targets(
    eyes: NDArray[np.float64], quat_xyzw: NDArray[np.float64], chosen: NDArray[np.float64] | None = None
) -> NDArray[np.float64]:
    """Returns what to look at near each keypoint: the point that a user has chosen, else the one ahead.

    Args:
        eyes: (M, 3) of the keypoints [m].
        quat_xyzw: (M, 4) view directions.
        chosen: (M, 3) chosen points, nan rows for none [m].
    """
    x, y, z, w = np.asarray(quat_xyzw, dtype=np.float64).T
    ahead = np.column_stack([1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)])
    points = np.asarray(eyes + LOOK_DISTANCE_M * ahead)
    return points if chosen is None else np.where(np.isfinite(chosen), chosen, points)
