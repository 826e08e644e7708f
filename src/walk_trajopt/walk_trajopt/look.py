# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Where the walker looks at each moment: ahead, turned towards what there is to see, never fast."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from walk_trajopt.clock import Clock
from walk_trajopt.config import TimingConfig
from walk_trajopt.heading import Heading, on_even_grid
from walk_trajopt.polyline import interpolate
from walk_trajopt.smoothing import box

_ARM_M = 0.5  # a target nearer than this is not turned to
_STANDING_TICKS = 10  # a rest shorter than this is walking
_EVERY = 2  # ticks from one look at a target to the next, 0.04 s


def look_angles(
    heading: Heading,
    clock: Clock,
    path: tuple[NDArray[np.float64], NDArray[np.float64]],
    targets: NDArray[np.float64],
    target_arc_m: NDArray[np.float64],
    config: TimingConfig,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns yaw and pitch of the look at each tick of the clock, within the limits of rate and its change.

    Args:
        heading: Directions of the path.
        clock: The times, k ticks.
        path: Its points (n, 3) and their arc lengths (n,) [m].
        targets: (M, 3) what to look at near each keypoint; nan for nothing [m].
        target_arc_m: (M,) arc lengths of the keypoints, rising.
        config: Limits, reach and share of the targets.
    """
    angles = _wished(
        (heading.spacing_m, heading.look),
        (clock.arc_m, clock.speed_mps),
        path,
        (targets, target_arc_m),
        (config.look_at_m, config.look_at_share, config.max_pitch_rad),
    )
    tick = float(clock.t_s[1] - clock.t_s[0])
    rate = config.max_turn_rate_radps
    window = max(int(np.ceil(2.0 * rate / config.max_turn_acceleration_radps2 / tick)), 1)
    return _limited(angles[0], rate * tick, window), _limited(angles[1], rate * tick, window)


@numba.njit(cache=True, nogil=True)
def _wished(heading, ticks, path, keypoints, limits):
    """Returns yaw and pitch (2, k) of the look as it is wished: ahead, turned towards the targets near keypoints."""
    spacing, look = heading
    arc_m, speed_mps = ticks
    points, point_arc_m = path
    targets, target_arc_m = keypoints
    look_at, share, max_pitch = limits
    ahead, out = np.empty(len(arc_m)), np.zeros((2, len(arc_m)))
    for i in range(len(arc_m)):
        ahead[i] = on_even_grid(arc_m[i], spacing, look)
    out[0] = ahead
    for k in range(len(targets)):
        if not np.isfinite(targets[k]).all():
            continue
        begin, end, back, on = _near(arc_m, target_arc_m, k, look_at)
        if end - begin < 2:
            continue
        # What a target asks for changes slowly: every few ticks is often enough.
        marks = np.append(np.arange(begin, end - 1, _EVERY), end - 1)
        eyes = interpolate(arc_m[marks], point_arc_m, points)
        standing = _standing_ticks(arc_m[begin:end], speed_mps[begin:end], target_arc_m[k]) > _STANDING_TICKS
        weight = _weights(arc_m[marks], target_arc_m[k], (back, on), share, standing)
        _spread_turn(_turns(eyes, targets[k], weight, max_pitch, ahead[marks]), marks, out)
    return out


@numba.njit(cache=True, nogil=True)
def _spread_turn(turns, marks, out):
    """Adds turns (2, m) at some ticks to yaw and pitch (2, k), linear between these."""
    for m in range(len(marks) - 1):
        a, b = marks[m], marks[m + 1]
        for i in range(a, b):
            share = (i - a) / (b - a)
            for c in range(2):
                out[c, i] += turns[c, m] + share * (turns[c, m + 1] - turns[c, m])
    for c in range(2):
        out[c, marks[-1]] += turns[c, -1]


@numba.njit(cache=True, nogil=True)
def _near(arc_m, target_arc_m, k, look_at):
    """Returns the ticks at which keypoint `k` counts, and how far it reaches back and ahead: never over another."""
    here = target_arc_m[k]
    back = min(look_at, 0.5 * (here - target_arc_m[k - 1])) if k > 0 else look_at
    on = min(look_at, 0.5 * (target_arc_m[k + 1] - here)) if k + 1 < len(target_arc_m) else look_at
    back, on = max(back, 1e-6), max(on, 1e-6)
    begin = np.searchsorted(arc_m, here - back, side="right")
    return begin, np.searchsorted(arc_m, here + on, side="right"), back, on


@numba.njit(cache=True, nogil=True)
def _standing_ticks(arc_m, speed_mps, here_m):
    standing = 0
    for i in range(len(arc_m)):
        if abs(arc_m[i] - here_m) < 1e-3 and speed_mps[i] < 1e-3:
            standing += 1
    return standing


@numba.njit(cache=True, nogil=True)
def _weights(arc_m, here_m, reach_m, share, standing):
    """Returns how much a keypoint counts at each arc length (k,), 0 to 1: 1 only where the walker stands there."""
    weight = np.empty(len(arc_m))
    for i in range(len(arc_m)):
        off = arc_m[i] - here_m
        part = off / (reach_m[0] if off < 0.0 else reach_m[1])
        here = standing and abs(off) < 0.01
        weight[i] = (1.0 if here else share) * 0.5 * (1.0 + np.cos(np.pi * min(max(part, -1.0), 1.0)))
    return weight


@numba.njit(cache=True, nogil=True)
def _turns(positions, target, weight, max_pitch, ahead):
    """Returns how far yaw and pitch (2, k) turn from `ahead` (k,) towards a target, as the weights (k,) say."""
    out = np.zeros((2, len(weight)))
    bearing, known = _bearings(positions, target)
    if not known:
        return out
    # The side on which to turn is chosen once, where the target counts most.
    middle = np.argmax(weight)
    side = 2.0 * np.pi * np.rint((ahead[middle] - bearing[middle]) / (2.0 * np.pi))
    for i in range(len(weight)):
        x, y, z = target[0] - positions[i, 0], target[1] - positions[i, 1], target[2] - positions[i, 2]
        rise = np.arctan2(z, max(np.sqrt(x * x + y * y), _ARM_M))
        out[0, i] = weight[i] * (bearing[i] + side - ahead[i])
        out[1, i] = weight[i] * min(max(rise, -max_pitch), max_pitch)
    return out


@numba.njit(cache=True, nogil=True)
def _bearings(positions, target):
    """Returns the direction (k,) to a target, unwrapped, and whether it is ever known.

    Whoever walks through a target sees it swing round: within arm's length it goes over evenly from the last
    direction known to the next.
    """
    bearing, last = np.empty(len(positions)), -1
    for i in range(len(positions)):
        x, y = target[0] - positions[i, 0], target[1] - positions[i, 1]
        if x * x + y * y < _ARM_M**2:
            continue
        bearing[i] = np.arctan2(y, x)
        if last < 0:
            bearing[:i] = bearing[i]
        else:
            bearing[i] -= 2.0 * np.pi * np.rint((bearing[i] - bearing[last]) / (2.0 * np.pi))
            for j in range(last + 1, i):
                bearing[j] = bearing[last] + (bearing[i] - bearing[last]) * (j - last) / (i - last)
        last = i
    if last >= 0:
        bearing[last:] = bearing[last]
    return bearing, last >= 0


@numba.njit(cache=True, nogil=True)
def _limited(angle, step, window):
    """Returns the angle that is nearest to the given one in its largest difference and within the turn limits.

    Of all functions with a change of at most `step` a tick, the mean of the highest that lies below and the lowest that
    lies above is the nearest in the largest difference. An average over `window` ticks then limits the rate's change.
    """
    if (angle == 0.0).all():
        return angle.copy()
    low, high = angle.copy(), angle.copy()
    for i in range(1, len(low)):
        low[i] = min(low[i], low[i - 1] + step)
        high[i] = max(high[i], high[i - 1] - step)
    for i in range(len(low) - 2, -1, -1):
        low[i] = min(low[i], low[i + 1] + step)
        high[i] = max(high[i], high[i + 1] - step)
    half = (window - 1) // 2
    return box(0.5 * (low + high), half, 0.5 * (window - 1 - 2 * half))


@numba.njit(cache=True, nogil=True)
def quaternion_xyzw(yaw, pitch):
    """Returns the quaternion whose x axis looks along yaw and, for a positive pitch, up; without roll.

    The yaw must be unwrapped: half of it goes into the quaternion, so that neighbours never flip their sign.
    """
    cy, sy = np.cos(0.5 * yaw), np.sin(0.5 * yaw)
    # Looking up turns about −y in a frame whose x axis is ahead and whose z axis is up.
    cp, sp = np.cos(-0.5 * pitch), np.sin(-0.5 * pitch)
    return -sy * sp, cy * sp, sy * cp, cy * cp
