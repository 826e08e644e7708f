# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The trajectory as comma separated values, for spreadsheets and other programs."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from walk_bag.exports.resample import resample
from walk_bag.exports.ride import ExportConfig, Ride
from walk_building.progress import Progress, no_progress

MAX_STEP_S = 0.1
"""Longest time between two rows [s]."""

HEADER = "t,x,y,z,qx,qy,qz,qw,stop"


def write_trajectory_csv(
    path: Path,
    ride: Ride,
    config: ExportConfig | None = None,  # noqa: ARG001  (all exporters are called alike)
    progress: Progress = no_progress,
) -> None:
    """Writes `t,x,y,z,qx,qy,qz,qw,stop` rows at most 0.1 s apart.

    Seconds; metres, z up, in the building file's own coordinates; the eye's pose with x ahead and z up;
    stop is 1 while the walker stands at a keypoint.
    """
    # A hair shorter, so that rounding the times cannot make a step too long.
    samples = resample(ride, 0.999 * MAX_STEP_S)
    table = np.column_stack([samples.t_s, ride.to_file(samples.positions), samples.quat_xyzw, samples.stop])
    formats = ["%.4f"] * 4 + ["%.7f"] * 4 + ["%d"]
    np.savetxt(path, table, fmt=formats, delimiter=",", header=HEADER, comments="")
    progress("write", 1.0)
