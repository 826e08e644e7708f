# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The timed path."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Trajectory:
    """Where the eye is at what time, and where it looks. Read-only arrays of m samples.

    Every point of the path is a sample, and samples between two points lie on the line between them: a straight
    line between any two neighbouring samples is therefore one that the body was swept along.

    Attributes:
        t_s: (m,) time since the start, strictly rising [s].
        positions: (m, 3) eye positions [m].
        velocities: (m, 3) [m/s].
        accelerations: (m, 3) [m/s²].
        quat_xyzw: (m, 4) look direction: x axis ahead, z axis up; neighbours on the same side of the double cover.
        stop: (m,) whether the walker stands still.
    """

    t_s: NDArray[np.float64]
    positions: NDArray[np.float64]
    velocities: NDArray[np.float64]
    accelerations: NDArray[np.float64]
    quat_xyzw: NDArray[np.float64]
    stop: NDArray[np.bool_]

    @property
    def duration_s(self) -> float:
        """Time from start to end [s]."""
        return float(self.t_s[-1])

    @property
    def speed_mps(self) -> NDArray[np.float64]:
        """Speed at each sample (m,) [m/s]."""
        return np.asarray(np.linalg.norm(self.velocities, axis=1))
