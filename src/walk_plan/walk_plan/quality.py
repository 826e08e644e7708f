# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The same report on every walk, ours and others': how long, how safe, how smooth, how much it shows."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from walk_building.building import Building
from walk_building.sweep import BodySweep
from walk_plan.along import every, walked_m
from walk_plan.clearance import SideClearance
from walk_plan.rooms import rooms_entered
from walk_plan.seen import seen_share
from walk_trajopt.trajectory import Trajectory

SAMPLE_SPACING_M = 0.1
"""Distance along a path between the places at which clearance and height are measured."""

LEVEL_RUN_M = 0.6
"""A floor counts as flat where it neither rises nor falls over this length of the path before and behind ..."""

LEVEL_RISE_M = 0.03
"""... by more than this. Our own; a step of a stair is 0.15 m and more, a ramp of 5 % rises 0.06 m."""

JERK_STEP_S = 0.1
"""Time over which changes of the velocity are taken [s]."""

WALKING_SHARE = 0.25
"""Samples slower than this share of the peak speed are starts and stops, not walking."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class PathQuality:
    """Figures of one walk; nan where a figure has no meaning, such as clearance without geometry around."""

    name: str
    length_m: float
    duration_s: float
    min_clearance_m: float  # between the standing body's surface and all of the building; 0 touches
    mean_clearance_m: float  # beside the body, up to clearance.LIMIT_M: floor and ceiling left out
    segments: int  # straight pieces of the path
    colliding_segments: int  # pieces along which the swept body meets the building
    rms_jerk_mps3: float  # see rms_jerk
    median_speed_mps: float  # while walking
    peak_speed_mps: float
    peak_turn_rate_radps: float  # of the view
    height_deviation_m: float  # largest, of the eye from its height above the floor, smooth over steps
    flat_height_std_m: float  # standard deviation of the eye's exact height above flat floors
    seen_share: float  # of the free space over the reachable floors
    rooms: tuple[int, ...]  # entered, indices into Building.rooms, in order


def measure(
    name: str,
    building: Building,
    sweep: BodySweep,
    beside: SideClearance,
    path: NDArray[np.float64],
    trajectory: Trajectory,
    free_space: NDArray[np.float64],
) -> PathQuality:
    """Returns the figures of a walk.

    Args:
        name: What the report calls it.
        building: Where it is walked.
        sweep: The walker's body against the building.
        beside: The space beside the body.
        path: (n, 3) eye positions, straight between [m].
        trajectory: The same path, timed.
        free_space: (s, 3) points that may be seen [m], the same for all walks that are compared.
    """
    eyes = every(path, SAMPLE_SPACING_M)
    free = sweep.segments_free(path)
    speed = np.linalg.norm(trajectory.velocities, axis=1)
    return PathQuality(
        name=name,
        length_m=float(walked_m(path)[-1]),
        duration_s=float(trajectory.t_s[-1] - trajectory.t_s[0]),
        min_clearance_m=float(sweep.standing_clearance(eyes).min()),
        mean_clearance_m=float(beside.at(eyes).mean()),
        segments=len(free),
        colliding_segments=int((~free).sum()),
        rms_jerk_mps3=rms_jerk(trajectory),
        median_speed_mps=float(np.median(speed[speed >= WALKING_SHARE * speed.max()])),
        peak_speed_mps=float(speed.max()),
        peak_turn_rate_radps=float(turn_rates(trajectory).max(initial=0.0)),
        height_deviation_m=_largest(np.abs(height_errors(building, eyes))),
        flat_height_std_m=flat_height_std(building, eyes),
        seen_share=seen_share(building.geometry, path, free_space),
        rooms=rooms_entered(building, eyes),
    )


@dataclasses.dataclass(frozen=True, slots=True)
class Measure:
    """Takes the figures of walks through one building, of all alike."""

    building: Building
    sweep: BodySweep
    beside: SideClearance
    free_space: NDArray[np.float64]

    def __call__(self, name: str, path: NDArray[np.float64], trajectory: Trajectory) -> PathQuality:
        """Returns the figures of one walk; see `measure`."""
        return measure(name, self.building, self.sweep, self.beside, path, trajectory, self.free_space)


def rms_jerk(trajectory: Trajectory) -> float:
    """Returns the root mean square over time of the rate at which the acceleration changes [m/s³].

    By second differences of the velocity over tenths of a second, what a person feels: closer samples would
    measure the corners of the polyline, and the same walk would be judged by how finely it is written down.
    """
    steps = max(round(float(trajectory.t_s[-1] - trajectory.t_s[0]) / JERK_STEP_S), 2)
    times = np.linspace(trajectory.t_s[0], trajectory.t_s[-1], steps + 1)
    velocity = np.column_stack([np.interp(times, trajectory.t_s, trajectory.velocities[:, i]) for i in range(3)])
    jerk = np.diff(velocity, n=2, axis=0) / (times[1] - times[0]) ** 2
    return float(np.sqrt((jerk**2).sum(axis=1).mean()))


def turn_rates(trajectory: Trajectory) -> NDArray[np.float64]:
    """Returns how fast the view turns between each sample and the next, (m - 1,) [rad/s]."""
    view = Rotation.from_quat(trajectory.quat_xyzw)
    angle = (view[:-1].inv() * view[1:]).magnitude() if len(view) > 1 else np.zeros(0)
    return np.asarray(angle / np.maximum(np.diff(trajectory.t_s), 1e-9))


def height_errors(building: Building, eyes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns how much higher each eye is than the walker's eye height over the floor, (n,) [m]; nan: no floor."""
    wanted = building.walker.eye_height_m
    return np.asarray(eyes[:, 2] - building.surface.floor_z(eyes, wanted) - wanted)


def flat_height_std(building: Building, eyes: NDArray[np.float64]) -> float:
    """Returns the standard deviation of the eye's exact height above the floor, where the floor is flat [m].

    Args:
        building: Gives the floor.
        eyes: (n, 3) evenly spaced on the path, `SAMPLE_SPACING_M` apart [m].
    """
    flat = flat_floor(building, eyes)
    height = building.geometry.height_above_floor(eyes[flat]) if flat.any() else np.zeros(0)
    height = height[np.isfinite(height)]
    return float(height.std()) if len(height) else float("nan")


def flat_floor(building: Building, eyes: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Returns at which of the evenly spaced eyes (n, 3) the floor is flat for a while before and behind, (n,)."""
    floor = building.surface.floor_z(eyes, building.walker.eye_height_m)
    reach = max(round(LEVEL_RUN_M / SAMPLE_SPACING_M), 1)
    padded = np.pad(floor, reach, mode="edge")
    around = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1)
    # A comparison with nan is false: no floor is not flat.
    return np.asarray(around.max(axis=1) - around.min(axis=1) <= LEVEL_RISE_M)


def _largest(values: NDArray[np.float64]) -> float:
    known = values[np.isfinite(values)]
    return float(known.max()) if len(known) else float("nan")
