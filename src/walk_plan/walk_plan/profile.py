# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What happens along the walk: a table over its length."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from walk_bag.exports.resample import resample
from walk_building.building import Building
from walk_plan.along import walked_m
from walk_plan.clearance import SideClearance
from walk_plan.quality import turn_rates
from walk_trajopt.trajectory import Trajectory

STEP_S = 0.1
"""Longest time between two rows of the table [s]."""

MAX_ROWS = 6000
"""A longer walk is sampled more coarsely: no picture has more columns than this."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Profile:
    """Columns of the table, a row for each sample of the trajectory."""

    walked_m: NDArray[np.float64]  # (m,) from the start
    positions: NDArray[np.float64]  # (m, 3) of the eye [m]
    height_m: NDArray[np.float64]  # (m,) of the eye above the surface straight below; nan: none
    clearance_m: NDArray[np.float64]  # (m,) beside the standing body, up to clearance.LIMIT_M
    speed_mps: NDArray[np.float64]  # (m,)
    turn_rate_radps: NDArray[np.float64]  # (m,) of the view
    storey: NDArray[np.int32]  # (m,) index into Building.storeys; -1: no floor near


def profile(building: Building, beside: SideClearance, trajectory: Trajectory) -> Profile:
    """Returns the table of a trajectory."""
    duration = float(trajectory.t_s[-1] - trajectory.t_s[0])
    samples = resample(trajectory, max(STEP_S, duration / MAX_ROWS))
    eyes = samples.positions
    height = building.geometry.height_above_floor(eyes)
    speed = np.linalg.norm(trajectory.velocities, axis=1)
    turn = np.append(turn_rates(trajectory), 0.0)
    held = np.clip(np.searchsorted(trajectory.t_s, samples.t_s, side="right") - 1, 0, len(turn) - 1)
    return Profile(
        walked_m=walked_m(eyes),
        positions=eyes,
        height_m=np.where(np.isfinite(height), height, np.nan),
        clearance_m=beside.at(eyes),
        speed_mps=np.interp(samples.t_s, trajectory.t_s, speed),
        turn_rate_radps=turn[held],
        storey=storeys_along(building, eyes),
    )


def storeys_along(building: Building, eyes: NDArray[np.float64]) -> NDArray[np.int32]:
    """Returns on which storey each eye (n, 3) walks, (n,) indices into Building.storeys."""
    feet = eyes - [0.0, 0.0, building.walker.eye_height_m]
    place = building.surface.nearest(feet)
    return np.where(place >= 0, building.surface.storey[place], -1).astype(np.int32)
