# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Whether an edit may be done at all: who holds the keypoint, what came before, what is locked."""

from __future__ import annotations

from collections.abc import Collection

from walk_ros.conversions.edits import EditKind, KeypointEdit
from walk_ros.holds import Holds


class EditRules:
    """The holds and the last accepted edits of one building's keypoints."""

    def __init__(self) -> None:
        self._holds = Holds()
        self._last_stamp: dict[int, int] = {}

    def objection(self, edit: KeypointEdit, ids: Collection[int], locked: Collection[int], now_s: float) -> str:
        """Returns why an edit is refused, "" if it is not; its editor then holds the keypoint.

        Args:
            edit: What is asked for.
            ids: Identities of the keypoints that there are.
            locked: Identities of those that are locked.
            now_s: A steady time.
        """
        if edit.keypoint < 0:
            return ""
        if edit.keypoint not in ids:
            return f"there is no keypoint {edit.keypoint}"
        # An edit without a stamp is never stale.
        if 0 < edit.stamp_ns < self._last_stamp.get(edit.keypoint, 0):
            return f"stale: a later edit of keypoint {edit.keypoint} has been accepted"
        # Asked first: whoever is refused a grab must not hold the keypoint, or nobody else could unlock it.
        if edit.kind in (EditKind.GRAB, EditKind.DRAG) and edit.keypoint in locked:
            return f"keypoint {edit.keypoint} is locked: unlock it first"
        holder = self._holds.take(edit.keypoint, edit.client_id, now_s)
        return f"keypoint {edit.keypoint} is held by {holder!r}" if holder else ""

    def keep(self, edit: KeypointEdit, now_s: float) -> None:
        """Lets an editor that is still there hold its keypoint on."""
        self._holds.take(edit.keypoint, edit.client_id, now_s)

    def release(self, edit: KeypointEdit) -> None:
        """Frees the keypoint if the editor holds it."""
        self._holds.release(edit.keypoint, edit.client_id)

    def accept(self, edit: KeypointEdit, keypoint: int) -> None:
        """Remembers that an edit was accepted, of an insertion for the new keypoint."""
        self._last_stamp[keypoint] = max(edit.stamp_ns, self._last_stamp.get(keypoint, 0))
