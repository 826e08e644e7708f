# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The trajectory as comma separated values, for spreadsheets and other programs."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from walk_building.building import Building
from walk_plan.resample import resample
from walk_trajopt.trajectory import Trajectory

MAX_STEP_S = 0.1
"""Longest time between two rows [s]."""

HEADER = "t,x,y,z,qx,qy,qz,qw,stop"


def write_trajectory_csv(path: Path, building: Building, trajectory: Trajectory) -> None:
    """Writes `t,x,y,z,qx,qy,qz,qw,stop` rows at most 0.1 s apart.

    Seconds; metres, z up, in the building file's own coordinates; the eye's pose with x ahead and z up;
    stop is 1 while the walker stands at a keypoint.
    """
    # A hair shorter, so that rounding the times cannot make a step too long.
    samples = resample(trajectory, 0.999 * MAX_STEP_S)
    table = np.column_stack([samples.t_s, building.to_file(samples.positions), samples.quat_xyzw, samples.stop])
    formats = ["%.4f"] * 4 + ["%.7f"] * 4 + ["%d"]
    np.savetxt(path, table, fmt=formats, delimiter=",", header=HEADER, comments="")
