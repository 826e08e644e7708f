# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""When the walker is where: a speed profile within limits, smoothed to a limited jerk."""

from __future__ import annotations

import dataclasses
import math

import numba
import numpy as np
from numpy.typing import NDArray

from walk_building.errors import ParameterError
from walk_trajopt.config import TimingConfig
from walk_trajopt.heading import Heading, gradient

_TICK_S = 0.02
_APART = 3  # places of the grid between two rests, at least
_CREEP_MPS = 0.05  # slowest speed in the tightest turn: a corner of a polyline is passed, not stopped at
_BESIDE_M = 0.03  # on both sides of a turn on the spot
_STEP_S = 0.1  # a turn on the spot may change the velocity by what the lateral limit allows in this time


@dataclasses.dataclass(frozen=True, slots=True)
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
    # Of an even number of ticks, so that the average over it is in the middle; rather more than the jerk asks for.
    half = max(math.ceil(config.max_acceleration_mps2 / config.max_jerk_mps3 / _TICK_S - 1e-9), 1)
    limits = config.max_acceleration_mps2, config.max_lateral_acceleration_mps2, config.max_turn_rate_radps, speed_mps
    directions = heading.yaw, heading.look, heading.bend
    return Clock(*_profile(heading.arc_m, directions, (stops_m, dwell_s), limits, half))


@numba.njit(cache=True, nogil=True)
def _profile(arc_m, directions, stops, limits, half):
    """Returns times, arc lengths, speeds and accelerations (k,) on an even grid of times.

    Args:
        arc_m: (g,) places of the grid.
        directions: (g,), (g,), (g,) yaw, look and bend there.
        stops: (D,), (D,) where to stand still, and how long.
        limits: Of acceleration, of that to the side, of the turn rate, and of the speed.
        half: Ticks of half the average that limits the jerk.
    """
    acceleration, lateral, turn_rate, speed = limits
    spacing, smoothing = arc_m[1], 2 * half * _TICK_S
    limit = _limits(arc_m, directions[0], directions[1], directions[2], turn_rate, lateral, speed)
    limit = _widened(limit, spacing, acceleration, 0.5 * smoothing)
    at, rest = _rests(stops[0], stops[1], spacing, len(limit))
    limit[0] = limit[-1] = 0.0
    dwell = np.zeros(len(limit))
    for k in range(len(at)):
        limit[at[k]] = 0.0
        # The average eats as much of a rest as it lasts.
        dwell[at[k]] = rest[k] + smoothing
    _pass(limit, spacing, acceleration)
    arc, rate = _ticks(arc_m, limit, dwell)
    arc, rate, change = _smoothed(arc, rate, half)
    return _TICK_S * np.arange(len(arc)), arc, rate, change


@numba.njit(cache=True, nogil=True)
def _rests(stops_m, dwell_s, spacing, cells):
    """Returns the grid places of the rests and their times, those too near to each other to walk between as one."""
    at, rest, count = np.empty(len(stops_m), np.int64), np.empty(len(stops_m)), 0
    for k in range(len(stops_m)):
        here = int(np.rint(stops_m[k] / spacing))
        # Both ends are rests of their own.
        if here < _APART:
            here = 0
        elif here > cells - 1 - _APART:
            here = cells - 1
        if count > 0 and here - at[count - 1] < _APART:
            rest[count - 1] += dwell_s[k]
            continue
        at[count], rest[count] = here, dwell_s[k]
        count += 1
    return at[:count], rest[:count]


@numba.njit(cache=True, nogil=True)
def _limits(arc_m, yaw, look, bend, turn_rate, lateral_acceleration, speed):
    """Returns the highest speed (g,) at each place of the grid: in turns the body and the eyes have theirs."""
    spacing = arc_m[1]
    turning = gradient(look, spacing)
    limit = np.empty(len(arc_m))
    beside, last = _BESIDE_M / spacing, len(arc_m) - 1
    cells = int(beside)
    share = beside - cells
    for i in range(len(arc_m)):
        lateral = np.sqrt(lateral_acceleration / max(bend[i], 1e-9))
        # Where the path turns on the spot, curvature does not say how sudden that is; the change of direction does.
        on, back = min(i + cells, last), max(i - cells, 0)
        ahead = yaw[on] + share * (yaw[min(on + 1, last)] - yaw[on])
        behind = yaw[back] + share * (yaw[max(back - 1, 0)] - yaw[back])
        corner = min(abs(ahead - behind), np.pi)
        # The chord of a unit circle is no longer than its arc: most corners need no sine.
        sudden = lateral_acceleration * _STEP_S / max(corner, 1e-9)
        if sudden < speed:
            sudden = lateral_acceleration * _STEP_S / max(2.0 * np.sin(0.5 * corner), 1e-9)
        looking = turn_rate / max(abs(turning[i]), 1e-9)
        limit[i] = min(speed, max(min(lateral, sudden, looking), min(_CREEP_MPS, speed)))
    return limit


@numba.njit(cache=True, nogil=True)
def _widened(limit: NDArray[np.float64], spacing: float, acceleration: float, half_s: float) -> NDArray[np.float64]:
    """Lets each limit hold as far around its place as the walker comes in half the time of the smoothing.

    The average over time that follows the passes then stays within the limit that was there before.
    """
    out, highest = limit.copy(), limit.max()
    for i in range(len(limit)):
        if limit[i] >= highest:
            continue  # lowers none of its neighbours
        reach = int(np.ceil((limit[i] * half_s + 0.5 * acceleration * half_s**2) / spacing))
        for j in range(max(i - reach, 0), min(i + reach + 1, len(limit))):
            out[j] = min(out[j], limit[i])
    return out


@numba.njit(cache=True, nogil=True)
def _pass(speed: NDArray[np.float64], spacing: float, acceleration: float) -> None:
    """Lowers the speeds until neighbours can be reached from each other: once forward, once backward."""
    gain = 2.0 * acceleration * spacing
    square = speed * speed
    for i in range(1, len(speed)):
        square[i] = min(square[i], square[i - 1] + gain)
    for i in range(len(speed) - 2, -1, -1):
        square[i] = min(square[i], square[i + 1] + gain)
    speed[:] = np.sqrt(square)


@numba.njit(cache=True, nogil=True)
def _ticks(arc_m, speed, dwell_s):
    """Returns arc lengths and speeds every tick, with constant acceleration between places of the grid."""
    cells = len(arc_m) - 1
    leave = np.empty(cells + 1)
    leave[0] = dwell_s[0]
    for i in range(cells):
        leave[i + 1] = leave[i] + 2.0 * (arc_m[i + 1] - arc_m[i]) / (speed[i] + speed[i + 1]) + dwell_s[i + 1]
    count = int(np.ceil(leave[-1] / _TICK_S)) + 1
    arc, rate = np.empty(count), np.zeros(count)
    cell, entered = 0, -1
    for k in range(count):
        while cell < cells - 1 and leave[cell + 1] <= k * _TICK_S:
            cell += 1
        if cell != entered:
            entered = cell
            duration = leave[cell + 1] - dwell_s[cell + 1] - leave[cell]
            acceleration = (speed[cell + 1] - speed[cell]) / duration
        since = k * _TICK_S - leave[cell]
        going = min(max(since, 0.0), duration)
        arc[k] = min(arc_m[cell] + speed[cell] * going + 0.5 * acceleration * going**2, arc_m[-1])
        if 0.0 <= since <= duration:
            rate[k] = speed[cell] + acceleration * going
    return arc, rate


@numba.njit(cache=True, nogil=True)
def _smoothed(arc_m, speed_mps, half):
    """Returns arc length, its rate and the change of that, averaged over `half` ticks to both sides.

    Speed and acceleration stay within their limits, the jerk gets one.
    """
    last = len(arc_m) - 1
    count = len(arc_m) + 2 * half
    mean, rate, change = np.empty(count), np.empty(count), np.empty(count)
    window = 2 * half
    total, highest = 0.5 * window * (arc_m[0] + arc_m[0]), arc_m[0]
    for k in range(count):
        # The window of tick k reaches from `old` to `new`, at rest before the first tick and after the last.
        old, new = min(max(k - window, 0), last), min(k, last)
        if k > 0:
            # Trapezoids between the ticks, so that their differences are exactly the speed.
            before = min(k - 1, last), min(max(k - 1 - window, 0), last)
            total += 0.5 * (arc_m[before[0]] + arc_m[new]) - 0.5 * (arc_m[before[1]] + arc_m[old])
        highest = max(highest, min(total / window, arc_m[-1]))
        mean[k] = highest
        rate[k] = (arc_m[new] - arc_m[old]) / (window * _TICK_S)
        moving = (speed_mps[k] if k <= last else 0.0) - (speed_mps[k - window] if k >= window else 0.0)
        change[k] = moving / (window * _TICK_S)
    return mean, rate, change
