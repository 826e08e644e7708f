# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Edits on their way: which are to be followed, and which of those that were followed the authority has refused."""

from __future__ import annotations

from collections import deque

from walk_ros.conversions import EditKind, KeypointEdit, Outcome, edit_from_bytes, edit_result_from_msg
from walk_ros.holds import Holds
from walk_ros.raw import from_bytes


class Edits:
    """What has come in and nobody has worked on. Filled by one thread, emptied by another."""

    def __init__(self) -> None:
        self._waiting: deque[tuple[KeypointEdit, float]] = deque()
        self._holds = Holds()
        self._followed: dict[int, str] = {}
        self._refused: deque[int] = deque()

    def __bool__(self) -> bool:
        return bool(self._waiting)

    @property
    def any_refused(self) -> bool:
        """Whether there is something to take back."""
        return bool(self._refused)

    def store(self, data: bytes, locked: frozenset[int], now_s: float) -> None:
        """Takes in a serialised edit; raises MessageError where it is not sound."""
        edit = edit_from_bytes(data)
        # All but moving is the sequencer's: the path follows with its next revision.
        if edit.kind is EditKind.CHANGE or edit.keypoint in locked:
            return
        # The sequencer refuses an edit of what another editor holds; it is not followed here either.
        if self._holds.take(edit.keypoint, edit.client_id, now_s):
            return
        if edit.kind is EditKind.RELEASE:
            self._holds.release(edit.keypoint, edit.client_id)
        if edit.kind in (EditKind.DRAG, EditKind.RELEASE):
            self._followed[edit.keypoint] = edit.client_id
            self._waiting.append((edit, now_s))

    def store_result(self, data: bytes) -> bool:
        """Takes in a serialised answer of the authority; returns whether something is to be taken back."""
        # Every drag is answered; only a refusal is of use here, and is worth reading.
        if Outcome.REFUSED.value.encode() not in bytes(data):
            return False
        result = edit_result_from_msg(from_bytes(data, "diagnostic_msgs/msg/DiagnosticStatus"))
        refused = result.outcome is Outcome.REFUSED and result.keypoint.isdigit()
        if not refused or self._followed.pop(int(result.keypoint), None) != result.client_id:
            return False
        self._refused.append(int(result.keypoint))
        return True

    def latest(self) -> tuple[list[tuple[KeypointEdit, float]], int]:
        """Returns the latest edit of each keypoint and when it came, and how many were dropped for a later one."""
        latest: dict[int, tuple[KeypointEdit, float]] = {}
        dropped = 0
        while self._waiting:
            edit, came_s = self._waiting.popleft()
            dropped += edit.keypoint in latest
            latest[edit.keypoint] = (edit, came_s)
        return list(latest.values()), dropped

    def refused(self) -> list[int]:
        """Returns the keypoints that are to be taken back, each told once."""
        out = []
        while self._refused:
            out.append(self._refused.popleft())
        return out
