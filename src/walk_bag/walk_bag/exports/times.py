# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Frames of a walk."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from walk_bag.exports.resample import Timed


def frame_times(ride: Timed, fps: float) -> NDArray[np.float64]:
    """Returns when each frame is seen (f,) [s], from the first sample on; the last one is the end of the walk."""
    count = int(np.ceil((ride.t_s[-1] - ride.t_s[0]) * fps - 1e-9)) + 1
    return np.asarray(np.minimum(ride.t_s[0] + np.arange(count) / fps, ride.t_s[-1]))
