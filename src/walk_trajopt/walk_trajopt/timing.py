# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From a path to a trajectory: the clock and the look direction."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from walk_building.errors import ParameterError
from walk_trajopt.clock import Clock, clock_of
from walk_trajopt.config import TimingConfig
from walk_trajopt.curve import tangents
from walk_trajopt.heading import heading_of
from walk_trajopt.look import look_angles, quaternions_xyzw
from walk_trajopt.path import OptimisedPath, read_only
from walk_trajopt.polyline import interpolate
from walk_trajopt.trajectory import Trajectory

_APART_S = 1e-3  # samples nearer than this to a point of the path are left out


def time_path(
    path: OptimisedPath,
    config: TimingConfig | None = None,
    look_at: ArrayLike | None = None,
    dwell_s: ArrayLike | None = None,
) -> Trajectory:
    """Returns the path with times and look directions, at rest at both ends.

    Args:
        path: The path; its points become samples.
        config: Speeds, limits and look.
        look_at: (M, 3) what to look at near each keypoint of the path, nan rows for nothing; None for nowhere.
        dwell_s: (M,) how long to stand at each keypoint, instead of the config's one value for all [s].

    Raises:
        ParameterError: A path without length, arrays of another size, or a duration that cannot be met.
    """
    config = config or TimingConfig()
    points, arc = _distinct(path.points)
    keypoint_m = _arc(path.points)[path.keypoint_index]
    targets = _per_keypoint("look_at", look_at, (len(keypoint_m), 3), np.nan)
    dwell = _per_keypoint("dwell_s", dwell_s, (len(keypoint_m),), config.dwell_s)
    if not (np.isfinite(dwell) & (dwell >= 0.0)).all():
        raise ParameterError("dwell_s", dwell.tolist(), "times of at least 0 s")
    heading = heading_of(points, arc, config.lookahead_m, config.look_smoothing_m)
    stays = dwell > 0.0
    clock = clock_of(heading, keypoint_m[stays], dwell[stays], config)
    eyes = interpolate(clock.arc_m, arc, points)
    yaw, pitch = look_angles(heading, clock, eyes, targets, keypoint_m, config)
    t, at = _samples(clock, arc, config.sample_s)
    return _trajectory(points, arc, clock, t, at, np.interp(t, clock.t_s, yaw), np.interp(t, clock.t_s, pitch))


def _arc(points: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])


def _distinct(points: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns the points without repeated ones, and their arc lengths."""
    keep = np.concatenate([[True], np.linalg.norm(np.diff(points, axis=0), axis=1) > 1e-6])
    points = points[keep]
    if len(points) < 2:
        raise ParameterError("path", f"{len(points)} different points", "at least 2")
    return points, _arc(points)


def _per_keypoint(name: str, values: ArrayLike | None, shape: tuple[int, ...], default: float) -> NDArray[np.float64]:
    if values is None:
        return np.full(shape, default)
    array = np.asarray(values, dtype=np.float64)
    if array.shape != shape:
        raise ParameterError(name, array.shape, f"an array of shape {shape}, one row for each keypoint of the path")
    return array


def _samples(
    clock: Clock, arc_m: NDArray[np.float64], step_s: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns rising times and the arc lengths there: the moments at the points of the path, evenly divided between."""
    # Arc length does not rise while the walker stands; the first moment at a place is the one that counts.
    rising = np.concatenate([[True], np.diff(clock.arc_m) > 1e-12])
    passed = np.interp(arc_m[1:-1], clock.arc_m[rising], clock.t_s[rising])
    inner = (passed > clock.t_s[0] + _APART_S) & (passed < clock.t_s[-1] - _APART_S)
    inner &= np.diff(passed, prepend=-np.inf) > _APART_S
    marks = np.concatenate([clock.t_s[:1], passed[inner], clock.t_s[-1:]])
    places = np.concatenate([arc_m[:1], arc_m[1:-1][inner], arc_m[-1:]])
    pieces = np.maximum(np.ceil(np.diff(marks) / step_s - 1e-9), 1).astype(np.int64)
    gap = np.repeat(np.arange(len(pieces)), pieces)
    share = (np.arange(len(gap)) - np.repeat(np.cumsum(pieces) - pieces, pieces)) / pieces[gap]
    t = np.append(marks[gap] + share * np.diff(marks)[gap], marks[-1])
    at = np.interp(t, clock.t_s, clock.arc_m)
    # At the points themselves exactly, so that no sample cuts a corner.
    at[np.append(share == 0.0, True)] = places
    return t, np.maximum.accumulate(at)


def _trajectory(
    points: NDArray[np.float64],
    arc_m: NDArray[np.float64],
    clock: Clock,
    t_s: NDArray[np.float64],
    at_m: NDArray[np.float64],
    yaw: NDArray[np.float64],
    pitch: NDArray[np.float64],
) -> Trajectory:
    direction = interpolate(at_m, arc_m, tangents(points, arc_m))
    direction /= np.maximum(np.linalg.norm(direction, axis=1), 1e-9)[:, None]
    speed = np.interp(t_s, clock.t_s, clock.speed_mps)
    velocities = speed[:, None] * direction
    # Along the path the clock knows the acceleration; across it, the direction's change does.
    across = np.gradient(direction, t_s, axis=0) * speed[:, None]
    along = np.interp(t_s, clock.t_s, clock.acceleration_mps2)[:, None] * direction
    return Trajectory(
        t_s=read_only(t_s),
        positions=read_only(interpolate(at_m, arc_m, points)),
        velocities=read_only(velocities),
        accelerations=read_only(along + across),
        quat_xyzw=read_only(quaternions_xyzw(yaw, pitch)),
        stop=_locked(speed < 1e-3),
    )


def _locked(flags: NDArray[np.bool_]) -> NDArray[np.bool_]:
    flags.setflags(write=False)
    return flags
