# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Where the eye is while the tour is played back: one playback for everybody. Knows no ROS."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from numpy.typing import NDArray

MAX_SPEED = 4.0
_PER_SECOND_M = 0.05
"""A new trajectory is joined where the eye is; a second of distance in time weighs as much as this distance."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Timeline:
    """A trajectory to be played: n rows, times rise."""

    stamp_ns: int
    t_s: NDArray[np.float64]  # (n,) from 0 [s]
    positions: NDArray[np.float64]  # (n, 3) [m]
    quat_xyzw: NDArray[np.float64]  # (n, 4)

    @property
    def duration_s(self) -> float:
        """From the first row to the last [s]."""
        return float(self.t_s[-1]) if len(self.t_s) else 0.0

    def sample(self, t_s: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Returns position (3,) and orientation xyzw (4,) at a time; there must be rows."""
        position = np.array([np.interp(t_s, self.t_s, self.positions[:, k]) for k in range(3)])
        after = min(max(int(np.searchsorted(self.t_s, t_s)), 1), len(self.t_s) - 1)
        if after < 1:
            return position, self.quat_xyzw[0]
        begin, end = self.quat_xyzw[after - 1], self.quat_xyzw[after]
        span = self.t_s[after] - self.t_s[after - 1]
        share = min(max((t_s - self.t_s[after - 1]) / span, 0.0), 1.0) if span > 0 else 1.0
        # Rows are close together: the straight way between two turns, brought back to length 1.
        quat = (1 - share) * begin + share * (end if begin @ end >= 0 else -end)
        return position, quat / np.linalg.norm(quat)

    def closest(self, position: NDArray[np.float64], t_s: float) -> float:
        """Returns the time at which the trajectory comes closest to a place, preferring times near `t_s`."""
        away = np.linalg.norm(self.positions - position, axis=1) + _PER_SECOND_M * np.abs(self.t_s - t_s)
        return float(self.t_s[int(np.argmin(away))])


class Player:
    """Plays the newest timeline; times are those of a steady clock [s]."""

    def __init__(self) -> None:
        self.timeline: Timeline | None = None
        self.playing = False
        self.speed = 1.0
        self._t_s = 0.0
        self._at_s = 0.0

    def take(self, timeline: Timeline | None, now_s: float) -> None:
        """Goes on on another timeline, where it is closest to where the eye is; an end stays that end.

        Whoever waits at the beginning waits for the walk from its beginning, however an edit has moved that.
        """
        old, t_s = self.timeline, self.time(now_s)
        self.timeline = timeline if timeline is not None and len(timeline.t_s) else None
        if self.timeline is None:
            self.playing, t_s = False, 0.0
        elif old is not None and not self.playing and t_s in (0.0, old.duration_s):
            t_s = self.timeline.duration_s if t_s else 0.0
        elif old is not None:
            t_s = self.timeline.closest(old.sample(t_s)[0], t_s)
        self._set(t_s, now_s)

    def time(self, now_s: float) -> float:
        """Returns how far it is [s]; stops at either end."""
        if self.timeline is None:
            return 0.0
        t_s = self._t_s + (now_s - self._at_s) * self.speed if self.playing else self._t_s
        inside = min(max(t_s, 0.0), self.timeline.duration_s)
        if self.playing and inside != t_s:
            self.playing = False
            self._set(inside, now_s)
        return inside

    def play(self, now_s: float) -> bool:
        """Plays on, from the beginning if it was at the end; returns whether there is anything to play."""
        if self.timeline is None:
            return False
        t_s = self.time(now_s)
        if self.speed >= 0 and t_s >= self.timeline.duration_s:
            t_s = 0.0
        elif self.speed < 0 and t_s <= 0.0:
            t_s = self.timeline.duration_s
        self.playing = True
        self._set(t_s, now_s)
        return True

    def pause(self, now_s: float) -> None:
        """Stays where it is."""
        self._set(self.time(now_s), now_s)
        self.playing = False

    def seek(self, t_s: float, now_s: float) -> None:
        """Goes to a time, or to the end that is nearer to it."""
        limit = self.timeline.duration_s if self.timeline is not None else 0.0
        self._set(min(max(t_s, 0.0), limit), now_s)

    def set_speed(self, speed: float, now_s: float) -> None:
        """Goes on so many times as fast, backwards below 0."""
        self._set(self.time(now_s), now_s)
        self.speed = min(max(speed, -MAX_SPEED), MAX_SPEED)

    def state(self, now_s: float) -> dict[str, Any]:
        """Returns what the topic `playback` says."""
        t_s = self.time(now_s)
        return {
            "playing": self.playing,
            "t_s": t_s,
            "speed": self.speed,
            "duration_s": self.timeline.duration_s if self.timeline is not None else 0.0,
            "trajectory_ns": str(self.timeline.stamp_ns) if self.timeline is not None else "",
        }

    def _set(self, t_s: float, now_s: float) -> None:
        self._t_s, self._at_s = t_s, now_s
