# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What to look at near each keypoint."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

LOOK_DISTANCE_M = 3.0
"""How far ahead of a keypoint its target lies: a room's width, so that it stays ahead while one walks up to it."""


def look_targets(eyes: NDArray[np.float64], quat_xyzw: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the point (M, 3) ahead of each keypoint, given eyes (M, 3) and view directions (M, 4) [m]."""
    x, y, z, w = np.asarray(quat_xyzw, dtype=np.float64).T
    ahead = np.column_stack([1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)])
    return np.asarray(eyes + LOOK_DISTANCE_M * ahead)
