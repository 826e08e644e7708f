# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Where the walker looks at each moment: ahead, turned towards what there is to see, never fast."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from walk_trajopt.clock import Clock
from walk_trajopt.config import TimingConfig
from walk_trajopt.heading import Heading


def look_angles(
    heading: Heading,
    clock: Clock,
    positions: NDArray[np.float64],
    targets: NDArray[np.float64],
    target_arc_m: NDArray[np.float64],
    config: TimingConfig,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns yaw and pitch of the look at each tick of the clock, within the limits of rate and its change.

    Args:
        heading: Directions of the path.
        clock: The times, k ticks.
        positions: (k, 3) of the eye at the ticks [m].
        targets: (M, 3) what to look at near each keypoint; nan for nothing [m].
        target_arc_m: (M,) arc lengths of the keypoints.
        config: Limits, reach and share of the targets.
    """
    ahead = np.interp(clock.arc_m, heading.arc_m, heading.look)
    yaw, pitch = ahead.copy(), np.zeros_like(ahead)
    for k in np.flatnonzero(np.isfinite(targets).all(axis=1)):
        weight = _weight(clock, target_arc_m, int(k), config)
        near = np.flatnonzero(weight)
        if len(near) == 0:
            continue
        to_target = targets[k] - positions[near]
        flat = np.hypot(to_target[:, 0], to_target[:, 1])
        # Whoever walks through a target sees it swing round; within arm's length the direction is held.
        held = np.maximum(flat, 1e-9) < 0.5
        bearing = np.arctan2(to_target[:, 1], to_target[:, 0])
        if held.all():
            continue
        bearing = np.interp(np.arange(len(near)), np.flatnonzero(~held), np.unwrap(bearing[~held]))
        # The side on which to turn is chosen once, where the target counts most.
        middle = int(np.argmax(weight[near]))
        turns = np.round((ahead[near[middle]] - bearing[middle]) / (2 * np.pi))
        yaw[near] += weight[near] * (bearing + 2 * np.pi * turns - ahead[near])
        rise = np.clip(np.arctan2(to_target[:, 2], np.maximum(flat, 0.5)), -config.max_pitch_rad, config.max_pitch_rad)
        pitch[near] += weight[near] * rise
    return _limited(yaw, clock, config), _limited(pitch, clock, config)


def _weight(clock: Clock, target_arc_m: NDArray[np.float64], k: int, config: TimingConfig) -> NDArray[np.float64]:
    """Returns how much keypoint `k` counts at each tick, 0 to 1; keypoints do not overlap."""
    here = target_arc_m[k]
    before = min([config.look_at_m, *(0.5 * (here - target_arc_m[:k]))[-1:]])
    after = min([config.look_at_m, *(0.5 * (target_arc_m[k + 1 :] - here))[:1]])
    reach = np.where(clock.arc_m < here, max(before, 1e-6), max(after, 1e-6))
    share = np.where(np.abs(clock.arc_m - here) < 0.01, _dwell_share(clock, here, config), config.look_at_share)
    bump = 0.5 * (1.0 + np.cos(np.pi * np.clip((clock.arc_m - here) / reach, -1.0, 1.0)))
    return np.asarray(share * bump)


def _dwell_share(clock: Clock, arc_m: float, config: TimingConfig) -> float:
    """Returns the share at the keypoint itself: full where the walker stands there."""
    standing = (np.abs(clock.arc_m - arc_m) < 1e-3) & (clock.speed_mps < 1e-3)
    return 1.0 if np.count_nonzero(standing) > 20 else config.look_at_share


def _limited(angle: NDArray[np.float64], clock: Clock, config: TimingConfig) -> NDArray[np.float64]:
    """Returns the angle that is nearest to the given one in its largest difference and within the turn limits.

    Of all functions with a rate of at most ω, the mean of the highest that lies below and the lowest that lies above
    is the nearest in the largest difference. A moving average then limits the change of the rate.
    """
    tick = float(clock.t_s[1] - clock.t_s[0])
    step = config.max_turn_rate_radps * tick
    low, high = angle.copy(), angle.copy()
    _envelopes(low, high, step)
    window = max(int(np.ceil(2.0 * config.max_turn_rate_radps / config.max_turn_acceleration_radps2 / tick)), 1)
    return np.asarray(uniform_filter1d(0.5 * (low + high), window, mode="nearest"))


@numba.njit(cache=True, nogil=True)
def _envelopes(low: NDArray[np.float64], high: NDArray[np.float64], step: float) -> None:
    """Lowers `low` and raises `high` until neither changes by more than `step` between neighbours."""
    for i in range(1, len(low)):
        low[i] = min(low[i], low[i - 1] + step)
        high[i] = max(high[i], high[i - 1] - step)
    for i in range(len(low) - 2, -1, -1):
        low[i] = min(low[i], low[i + 1] + step)
        high[i] = max(high[i], high[i + 1] - step)


def quaternions_xyzw(yaw: NDArray[np.float64], pitch: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns quaternions (k, 4) whose x axis looks along yaw and, for a positive pitch, up; without roll.

    The yaw must be unwrapped: half of it goes into the quaternion, so that neighbours never flip their sign.
    """
    cy, sy = np.cos(0.5 * yaw), np.sin(0.5 * yaw)
    # Looking up turns about −y in a frame whose x axis is ahead and whose z axis is up.
    cp, sp = np.cos(-0.5 * pitch), np.sin(-0.5 * pitch)
    return np.column_stack([-sy * sp, cy * sp, sy * cp, cy * cp])
