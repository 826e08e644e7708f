# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""When the walker is where: a speed profile within limits, smoothed to a limited jerk."""

from __future__ import annotations

import dataclasses

import numba
import numpy as np
from numpy.typing import NDArray

from walk_building.errors import ParameterError
from walk_trajopt.config import TimingConfig
from walk_trajopt.heading import Heading

_TICK_S = 0.01
_APART = 3  # places of the grid between two rests, at least
_CREEP_MPS = 0.05  # slowest speed in the tightest turn: a corner of a polyline is passed, not stopped at
_BESIDE_M = 0.03  # on both sides of a turn on the spot
_STEP_S = 0.1  # a turn on the spot may change the velocity by what the lateral limit allows in this time


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Clock:
    """Arc length by time, on an even grid of times from 0 to the end; at rest at both ends."""

    t_s: NDArray[np.float64]  # (k,)
    arc_m: NDArray[np.float64]  # (k,) never falling
    speed_mps: NDArray[np.float64]  # (k,)
    acceleration_mps2: NDArray[np.float64]  # (k,)


def clock_of(
    heading: Heading, stops_m: NDArray[np.float64], dwell_s: NDArray[np.float64], config: TimingConfig
) -> Clock:
    """Returns the clock of a path that stops at some arc lengths.

    Args:
        heading: Directions of the path.
        stops_m: (D,) arc lengths at which to stand still, rising.
        dwell_s: (D,) how long, above zero [s].
        config: Speed and limits; with `duration_s` the wished speed follows from it.

    Raises:
        ParameterError: The wished duration is shorter than the limits allow.
    """
    if config.duration_s == 0.0:
        return _at_speed(heading, stops_m, dwell_s, config, config.speed_mps)
    fastest = _at_speed(heading, stops_m, dwell_s, config, config.max_speed_mps)
    if fastest.t_s[-1] > config.duration_s + 1.0:
        expected = (
            f"at least {fastest.t_s[-1]:.0f} s, or 0: the limits of speed and turn rate allow no less on this path"
        )
        raise ParameterError("duration_s", config.duration_s, expected)
    low, high = 1e-3, config.max_speed_mps
    best = fastest
    for _ in range(30):
        middle = 0.5 * (low + high)
        best = _at_speed(heading, stops_m, dwell_s, config, middle)
        low, high = (middle, high) if best.t_s[-1] > config.duration_s else (low, middle)
        if abs(best.t_s[-1] - config.duration_s) < 2 * _TICK_S:
            break
    return best


def _at_speed(
    heading: Heading, stops_m: NDArray[np.float64], dwell_s: NDArray[np.float64], config: TimingConfig, speed_mps: float
) -> Clock:
    smoothing_s = 2.0 * config.max_acceleration_mps2 / config.max_jerk_mps3
    limit = _limits(heading, config, speed_mps)
    limit = _widened(limit, heading.spacing_m, config.max_acceleration_mps2, 0.5 * smoothing_s)
    at, rest_s = _rests(np.rint(stops_m / heading.spacing_m).astype(np.int64), dwell_s, len(limit))
    limit[at] = limit[0] = limit[-1] = 0.0
    _pass(limit, heading.spacing_m, config.max_acceleration_mps2)
    dwell = np.zeros(len(limit))
    # The average eats as much of a rest as it lasts.
    dwell[at] = rest_s + smoothing_s
    arc, speed = _ticks(heading, limit, dwell)
    return _smoothed(arc, speed, smoothing_s)


def _rests(
    at: NDArray[np.int64], dwell_s: NDArray[np.float64], cells: int
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Returns the grid places of the rests and their times, those too near to each other to walk between as one."""
    rests: dict[int, float] = {}
    last = -_APART
    for place, dwell in zip(at.tolist(), dwell_s.tolist(), strict=True):
        # Both ends are rests of their own.
        here = 0 if place < _APART else cells - 1 if place > cells - 1 - _APART else place
        here = last if here - last < _APART else here
        rests[here] = rests.get(here, 0.0) + dwell
        last = here
    return np.array(list(rests), dtype=np.int64), np.array(list(rests.values()), dtype=np.float64)


def _limits(heading: Heading, config: TimingConfig, speed_mps: float) -> NDArray[np.float64]:
    """Returns the highest speed (g,) at each place of the grid: in turns the body and the eyes have theirs."""
    lateral = np.sqrt(config.max_lateral_acceleration_mps2 / np.maximum(heading.bend, 1e-9))
    turning = np.abs(np.gradient(heading.look, heading.spacing_m))
    # Where the path turns on the spot, curvature does not say how sudden that is; the change of direction does.
    ahead, behind = (np.interp(heading.arc_m + side, heading.arc_m, heading.yaw) for side in (_BESIDE_M, -_BESIDE_M))
    corner = np.minimum(np.abs(ahead - behind), np.pi)
    sudden = config.max_lateral_acceleration_mps2 * _STEP_S / np.maximum(2.0 * np.sin(0.5 * corner), 1e-9)
    lateral = np.minimum(lateral, sudden)
    looking = config.max_turn_rate_radps / np.maximum(turning, 1e-9)
    return np.minimum(speed_mps, np.maximum(np.minimum(lateral, looking), min(_CREEP_MPS, speed_mps)))


@numba.njit(cache=True, nogil=True)
def _widened(limit: NDArray[np.float64], spacing: float, acceleration: float, half_s: float) -> NDArray[np.float64]:
    """Lets each limit hold as far around its place as the walker comes in half the time of the smoothing.

    The average over time that follows the passes then stays within the limit that was there before.
    """
    out = limit.copy()
    for i in range(len(limit)):
        reach = int(np.ceil((limit[i] * half_s + 0.5 * acceleration * half_s**2) / spacing))
        for j in range(max(i - reach, 0), min(i + reach + 1, len(limit))):
            out[j] = min(out[j], limit[i])
    return out


@numba.njit(cache=True, nogil=True)
def _pass(speed: NDArray[np.float64], spacing: float, acceleration: float) -> None:
    """Lowers the speeds until neighbours can be reached from each other: once forward, once backward."""
    gain = 2.0 * acceleration * spacing
    for i in range(1, len(speed)):
        speed[i] = min(speed[i], np.sqrt(speed[i - 1] ** 2 + gain))
    for i in range(len(speed) - 2, -1, -1):
        speed[i] = min(speed[i], np.sqrt(speed[i + 1] ** 2 + gain))


def _ticks(
    heading: Heading, speed: NDArray[np.float64], dwell_s: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns arc lengths and speeds every tick, with constant acceleration between places of the grid."""
    duration = 2.0 * heading.spacing_m / (speed[:-1] + speed[1:])
    arrive = np.concatenate([[0.0], np.cumsum(duration + dwell_s[1:])]) + dwell_s[0]
    arrive[1:] -= dwell_s[1:]
    leave = arrive + dwell_s
    total = leave[-1]
    t = _TICK_S * np.arange(int(np.ceil(total / _TICK_S)) + 1, dtype=np.float64)
    cell = np.clip(np.searchsorted(leave, t, side="right") - 1, 0, len(duration) - 1)
    since = np.clip(t - leave[cell], 0.0, duration[cell])
    acceleration = (speed[1:] - speed[:-1]) / duration
    arc = heading.arc_m[cell] + speed[cell] * since + 0.5 * acceleration[cell] * since**2
    going = (t >= leave[cell]) & (t <= leave[cell] + duration[cell])
    return np.minimum(arc, heading.arc_m[-1]), np.where(going, speed[cell] + acceleration[cell] * since, 0.0)


def _smoothed(arc_m: NDArray[np.float64], speed_mps: NDArray[np.float64], smoothing_s: float) -> Clock:
    """Averages arc length over time: speed and acceleration stay within their limits, the jerk gets one."""
    half = max(round(0.5 * smoothing_s / _TICK_S), 1)
    arc = np.concatenate([np.full(2 * half, arc_m[0]), arc_m, np.full(2 * half, arc_m[-1])])
    speed = np.concatenate([np.zeros(2 * half), speed_mps, np.zeros(2 * half)])
    window = 2 * half * _TICK_S
    # Trapezoids between the ticks, so that their differences are exactly the speed.
    total = np.concatenate([[0.0], np.cumsum(0.5 * (arc[1:] + arc[:-1]))]) * _TICK_S
    mean = (total[2 * half :] - total[: -2 * half]) / window
    rate = (arc[2 * half :] - arc[: -2 * half]) / window
    change = (speed[2 * half :] - speed[: -2 * half]) / window
    mean = np.maximum.accumulate(np.clip(mean, arc_m[0], arc_m[-1]))
    return Clock(
        t_s=_TICK_S * np.arange(len(mean), dtype=np.float64), arc_m=mean, speed_mps=rate, acceleration_mps2=change
    )
