# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Edits on their way: which are to be followed, and which of those that were followed are to be taken back again."""

from __future__ import annotations

import dataclasses
import threading
from collections import deque

from walk_ros.conversions import EditKind, EditResult, KeypointEdit, Outcome, edit_from_bytes, edit_result_from_msg
from walk_ros.holds import Holds
from walk_ros.raw import from_bytes

_FINAL = tuple(outcome.value.encode() for outcome in (Outcome.REFUSED, Outcome.ACCEPTED))


@dataclasses.dataclass(slots=True, kw_only=True)
class Followed:
    """An edit that is shown, or is going to be."""

    edit: KeypointEdit
    came_s: float
    accepted_ns: int = 0  # the revision that has it; 0: not answered yet
    over: Outcome | None = None  # how it was answered; it is not to be shown from then on


class Edits:
    """What has come in and nobody has worked on, and what the authority said of it. Safe between threads."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._waiting: deque[Followed] = deque()
        self._holds = Holds()
        self._latest: dict[int, Followed] = {}  # of each keypoint, until it is over
        self._refused: list[int] = []
        self._refused_early: dict[int, tuple[str, int]] = {}  # client and stamp of a refusal without its edit

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
        if edit.kind not in (EditKind.DRAG, EditKind.RELEASE):
            return
        with self._lock:
            # Two topics keep no order between them: the refusal may have come first, and comes but once.
            early = self._refused_early.get(edit.keypoint) == (edit.client_id, edit.stamp_ns)
            followed = Followed(edit=edit, came_s=now_s, over=Outcome.REFUSED if early else None)
            self._latest[edit.keypoint] = followed
            self._waiting.append(followed)
            if early:
                self._refused.append(edit.keypoint)
                del self._latest[edit.keypoint], self._refused_early[edit.keypoint]

    def store_result(self, data: bytes) -> bool:
        """Takes in a serialised answer of the authority; returns whether something may have to be taken back."""
        # Every drag is answered; only what is final is of use here, and is worth reading.
        raw = bytes(data)
        if not any(word in raw for word in _FINAL):
            return False
        result = edit_result_from_msg(from_bytes(data, "diagnostic_msgs/msg/DiagnosticStatus"))
        if result.outcome is Outcome.FOLLOWED or not result.keypoint.isdigit():
            return False
        with self._lock:
            return self._answered(int(result.keypoint), result)

    def _answered(self, keypoint: int, result: EditResult) -> bool:
        latest = self._latest.get(keypoint)
        mine = latest if latest is not None and latest.edit.client_id == result.client_id else None
        # An edit that could not be read is refused without its stamp, and others come without one.
        answered = mine if mine is not None and result.edit_stamp_ns in (0, mine.edit.stamp_ns) else None
        if result.outcome is Outcome.ACCEPTED:
            if answered is not None:
                answered.accepted_ns = result.revision_ns
            return answered is not None
        if answered is not None:
            # It may still wait to be shown: from then on nothing would take it back.
            answered.over = Outcome.REFUSED
            del self._latest[keypoint]
        elif result.edit_stamp_ns:
            self._refused_early[keypoint] = result.client_id, result.edit_stamp_ns
        if mine is not None:
            self._refused.append(keypoint)
        return mine is not None

    def latest(self) -> tuple[list[Followed], int]:
        """Returns the latest edit of each keypoint, and how many were dropped for a later one."""
        latest: dict[int, Followed] = {}
        dropped = 0
        while self._waiting:
            followed = self._waiting.popleft()
            dropped += followed.edit.keypoint in latest
            latest[followed.edit.keypoint] = followed
        return list(latest.values()), dropped

    def refused(self) -> list[int]:
        """Returns the keypoints that are to be taken back, each told once."""
        with self._lock:
            out, self._refused = list(dict.fromkeys(self._refused)), []
        return out

    def confirmed(self, revision_ns: int) -> list[int]:
        """Returns the keypoints whose latest edit is in this revision or an earlier one, each told once.

        From then on the revision alone says where they are, also where it has taken the edit back already.
        """
        with self._lock:
            out = [k for k, followed in self._latest.items() if 0 < followed.accepted_ns <= revision_ns]
            for keypoint in out:
                self._latest.pop(keypoint).over = Outcome.ACCEPTED
        return out
