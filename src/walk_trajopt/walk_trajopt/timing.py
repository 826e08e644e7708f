# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From a path to a trajectory: the clock and the look direction."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray

from walk_building.errors import ParameterError
from walk_trajopt.clock import Clock, clock_of
from walk_trajopt.config import TimingConfig
from walk_trajopt.curve import slopes, tangents
from walk_trajopt.heading import heading_of, on_even_grid
from walk_trajopt.look import look_angles, quaternion_xyzw
from walk_trajopt.path import OptimisedPath, read_only
from walk_trajopt.polyline import arc_lengths, interpolate
from walk_trajopt.trajectory import Trajectory

_SAME_M = 1e-6  # points nearer than this are one
_STILL_MPS = 1e-3  # slower than this is standing
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
    whole = arc_lengths(path.points)
    points, arc = _distinct(path.points, whole)
    keypoint_m = whole[path.keypoint_index]
    targets = _per_keypoint("look_at", look_at, (len(keypoint_m), 3), np.nan)
    dwell = _per_keypoint("dwell_s", dwell_s, (len(keypoint_m),), config.dwell_s)
    if not (np.isfinite(dwell) & (dwell >= 0.0)).all():
        raise ParameterError("dwell_s", dwell.tolist(), "times of at least 0 s")
    heading = heading_of(points, arc, config.lookahead_m, config.look_smoothing_m)
    stays = dwell > 0.0
    clock = clock_of(heading, keypoint_m[stays], dwell[stays], config)
    look = look_angles(heading, clock, (points, arc), targets, keypoint_m, config)
    samples = _samples(clock.t_s, clock.arc_m, arc, config.sample_s)
    return _trajectory(points, arc, clock, look, samples)


def _distinct(
    points: NDArray[np.float64], arc_m: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns the points without repeated ones, and their arc lengths."""
    step = np.diff(arc_m)
    if len(points) < 2 or step.min() <= _SAME_M:
        # Read-only as the path's own: for the compiled code, one that is not is another type.
        points = read_only(points[np.concatenate([[True], step > _SAME_M])])
        arc_m = arc_lengths(points)
    if len(points) < 2:
        raise ParameterError("path", f"{len(points)} different points", "at least 2")
    return points, arc_m


def _per_keypoint(name: str, values: ArrayLike | None, shape: tuple[int, ...], default: float) -> NDArray[np.float64]:
    if values is None:
        return np.full(shape, default)
    array = np.asarray(values, dtype=np.float64)
    if array.shape != shape:
        raise ParameterError(name, array.shape, f"an array of shape {shape}, one row for each keypoint of the path")
    return array


@numba.njit(cache=True, nogil=True)
def _samples(clock_t, clock_arc, arc_m, step_s):
    """Returns rising times and the arc lengths there: the moments at the points of the path, evenly divided between."""
    marks, places, last = np.empty(len(arc_m)), np.empty(len(arc_m)), 0
    marks[0], places[0] = clock_t[0], arc_m[0]
    tick = 0
    for i in range(1, len(arc_m) - 1):
        # Arc length does not rise while the walker stands; the first moment at a place is the one that counts.
        while tick < len(clock_arc) - 2 and clock_arc[tick + 1] < arc_m[i]:
            tick += 1
        gone = clock_arc[tick + 1] - clock_arc[tick]
        share = min(max((arc_m[i] - clock_arc[tick]) / gone, 0.0), 1.0) if gone > 0.0 else 0.0
        passed = clock_t[tick] + share * (clock_t[tick + 1] - clock_t[tick])
        if marks[last] + _APART_S < passed < clock_t[-1] - _APART_S:
            last += 1
            marks[last], places[last] = passed, arc_m[i]
    last += 1
    marks[last], places[last] = clock_t[-1], arc_m[-1]
    return _divided(marks[: last + 1], places[: last + 1], clock_t, clock_arc, step_s)


@numba.njit(cache=True, nogil=True)
def _divided(marks, places, clock_t, clock_arc, step_s):
    pieces = np.maximum(np.ceil(np.diff(marks) / step_s - 1e-9), 1.0).astype(np.int64)
    t, at = np.empty(pieces.sum() + 1), np.empty(pieces.sum() + 1)
    row, tick = 0, clock_t[1] - clock_t[0]
    for i in range(len(pieces)):
        # At the points themselves exactly, so that no sample cuts a corner.
        t[row], at[row] = marks[i], places[i]
        for k in range(1, pieces[i]):
            t[row + k] = marks[i] + k / pieces[i] * (marks[i + 1] - marks[i])
            cell = min(int(t[row + k] / tick), len(clock_t) - 2)
            share = (t[row + k] - clock_t[cell]) / tick
            there = clock_arc[cell] + share * (clock_arc[cell + 1] - clock_arc[cell])
            at[row + k] = min(max(there, at[row + k - 1]), places[i + 1])
        row += pieces[i]
    t[row], at[row] = marks[-1], places[-1]
    return t, at


def _trajectory(
    points: NDArray[np.float64],
    arc_m: NDArray[np.float64],
    clock: Clock,
    look: tuple[NDArray[np.float64], NDArray[np.float64]],
    samples: tuple[NDArray[np.float64], NDArray[np.float64]],
) -> Trajectory:
    t_s, at_m = samples
    moving = clock.speed_mps, clock.acceleration_mps2
    rows = _rows(points, arc_m, float(clock.t_s[1]), moving, look, t_s, at_m)
    positions, velocities, accelerations, quat_xyzw, stop = rows
    return Trajectory(
        t_s=read_only(t_s),
        positions=read_only(positions),
        velocities=read_only(velocities),
        accelerations=read_only(accelerations),
        quat_xyzw=read_only(quat_xyzw),
        stop=_locked(stop),
    )


@numba.njit(cache=True, nogil=True)
def _rows(points, arc_m, tick_s, moving, look, t_s, at_m):
    """Returns positions, velocities, accelerations (m, 3), quaternions (m, 4) and stops (m,).

    Args:
        points: (n, 3) the path.
        arc_m: (n,) of each, rising.
        tick_s: Time between ticks.
        moving: (k,), (k,) speed and acceleration at each tick.
        look: (k,), (k,) yaw and pitch at each tick.
        t_s: (m,) rising.
        at_m: (m,) arc length at each time, rising.
    """
    positions, direction = interpolate(at_m, arc_m, points), interpolate(at_m, arc_m, tangents(points, arc_m))
    quat, stop = np.empty((len(t_s), 4)), np.empty(len(t_s), np.bool_)
    for i in range(len(t_s)):
        x, y, z = direction[i]
        scale = 1.0 / max(np.sqrt(x * x + y * y + z * z), 1e-9)
        direction[i, 0], direction[i, 1], direction[i, 2] = scale * x, scale * y, scale * z
        quat[i] = quaternion_xyzw(on_even_grid(t_s[i], tick_s, look[0]), on_even_grid(t_s[i], tick_s, look[1]))
    turning = slopes(t_s, direction)
    velocities, accelerations = np.empty_like(direction), np.empty_like(direction)
    for i in range(len(t_s)):
        speed, gain = on_even_grid(t_s[i], tick_s, moving[0]), on_even_grid(t_s[i], tick_s, moving[1])
        stop[i] = speed < _STILL_MPS
        for c in range(3):
            # Along the path the clock knows the acceleration; across it, the direction's change does.
            accelerations[i, c] = turning[i, c] * speed + gain * direction[i, c]
            velocities[i, c] = speed * direction[i, c]
    return positions, velocities, accelerations, quat, stop


def _locked(flags: NDArray[np.bool_]) -> NDArray[np.bool_]:
    flags.setflags(write=False)
    return flags
