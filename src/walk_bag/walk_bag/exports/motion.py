# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Speed and acceleration of a ride, which recordings of a camera do not hold."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from walk_bag.exports.resample import Timed


def motion_of(ride: Timed) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns velocities (m, 3) [m/s] and accelerations (m, 3) [m/s²] as central differences of the samples."""
    if len(ride.t_s) < 2:
        return np.zeros_like(ride.positions), np.zeros_like(ride.positions)
    velocities = np.gradient(ride.positions, ride.t_s, axis=0)
    return velocities, np.asarray(np.gradient(velocities, ride.t_s, axis=0))
