# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From a planned tour to a smooth, collision-free, timed walkthrough."""

from __future__ import annotations

from walk_trajopt.config import TimingConfig, TrajoptConfig
from walk_trajopt.optimiser import EditOutcome, Optimiser
from walk_trajopt.path import OptimisedPath, Stretch
from walk_trajopt.pipeline import optimise_path
from walk_trajopt.spline import spline_path
from walk_trajopt.timing import time_path
from walk_trajopt.trajectory import Trajectory

__all__ = [
    "EditOutcome",
    "OptimisedPath",
    "Optimiser",
    "Stretch",
    "TimingConfig",
    "Trajectory",
    "TrajoptConfig",
    "optimise_path",
    "spline_path",
    "time_path",
]
