# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What the sequencer said last, put together from the three messages of a revision."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from numpy.typing import NDArray

from walk_ros.conversions import (
    KeypointMarks,
    LabelledKeypoints,
    Poses,
    TimedPath,
    keypoint_markers_from_msg,
    keypoint_marks_from_msg,
    keypoints_from_msg,
    tour_from_msg,
)
from walk_trajopt.config import TimingConfig
from walk_trajopt.live import Revision
from walk_trajopt.path import OptimisedPath
from walk_trajopt.targets import NOWHERE, look_targets
from walk_trajopt.timing import time_path
from walk_trajopt.trajectory import Trajectory


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Plan:
    """What the sequencer last said: three messages of one revision."""

    stamp_ns: int
    keypoints: Poses
    ids: tuple[int, ...]
    marks: KeypointMarks
    polyline: NDArray[np.float64]
    chosen: NDArray[np.float64]  # (M, 3) points to look at, nan rows for none
    ahead: NDArray[np.float64]  # (M, 3) from each keypoint to what lies ahead of it

    @property
    def revision(self) -> Revision:
        """What of it concerns the path."""
        locked = frozenset(self.marks.locked)
        return Revision(ids=self.ids, keypoints=self.keypoints.positions, polyline=self.polyline, locked=locked)

    @property
    def has_length(self) -> bool:
        """Whether there is anything to walk."""
        return len(np.unique(self.polyline, axis=0)) > 1

    def timed(self, path: OptimisedPath, keypoints: NDArray[np.float64], timing: TimingConfig) -> Trajectory:
        """Returns a path with the clock and the look that the plan's marks ask for.

        Args:
            path: Through all of the plan's keypoints.
            keypoints: (M, 3) where they are now [m].
            timing: What holds where no mark says anything else.
        """
        targets = np.where(np.isfinite(self.chosen), self.chosen, keypoints + self.ahead)
        dwell_s = [self.marks.dwell_s.get(i, timing.dwell_s) for i in self.ids] if self.marks.dwell_s else None
        return time_path(path, timing, look_at=targets, dwell_s=dwell_s)


class Inbox:
    """The newest of each of the three messages.

    Attributes:
        marks: Of the newest markers: a lock holds at once, whatever of its revision is still under way.
    """

    def __init__(self) -> None:
        self.marks = KeypointMarks()
        self._keypoints: Poses | None = None
        self._markers: LabelledKeypoints | None = None
        self._tour: TimedPath | None = None
        self._plan: Plan | None = None
        self._is_new = False

    def store(self, topic: str, msg: Any) -> None:
        """Takes in a message of `keypoints`, `keypoint_markers` or `tour`."""
        if topic == "keypoints":
            self._keypoints = keypoints_from_msg(msg)
        elif topic == "tour":
            self._tour = tour_from_msg(msg)
        else:
            # Before the keypoints: a plan takes both once its three messages agree.
            self.marks = keypoint_marks_from_msg(msg)
            self._markers = keypoint_markers_from_msg(msg)
        # Only now: another thread that looks in between would take the news for read.
        self._is_new = True

    def plan(self) -> Plan | None:
        """Returns what the sequencer last said in full: the newest revision of which all three messages are here."""
        if not self._is_new:
            return self._plan
        self._is_new = False
        keypoints, markers, tour = self._keypoints, self._markers, self._tour
        if (
            keypoints is not None
            and markers is not None
            and tour is not None
            and keypoints.stamp_ns == markers.poses.stamp_ns == tour.stamp_ns
            and len(markers.ids) == len(keypoints.positions)
        ):
            self._plan = Plan(
                stamp_ns=tour.stamp_ns,
                keypoints=keypoints,
                ids=markers.ids,
                marks=self.marks,
                polyline=tour.positions,
                ahead=look_targets(np.zeros_like(keypoints.positions), keypoints.quat_xyzw),
                chosen=np.array([self.marks.look_at.get(i, NOWHERE) for i in markers.ids]).reshape(-1, 3),
            )
        return self._plan
