# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The keypoints with their past: every edit can be taken back and done again, without limit."""

from __future__ import annotations

import dataclasses

from walk_sequencer.changes import EDITS, Entry, changed
from walk_sequencer.kept import Kept
from walk_sequencer.keypoints import Keypoints

UNDO: Entry = {"kind": "undo"}
REDO: Entry = {"kind": "redo"}


class History:
    """The present keypoints, those before each edit, and those that were taken back.

    Undo restores the very values, bit for bit; each is kept as what its neighbour lacks, so that hours of editing need
    little memory. Orders that the planner finds in between change no array, so the neighbour stays one.

    Attributes:
        present: The keypoints now.
    """

    def __init__(self) -> None:
        self.present = Keypoints()
        self._past: list[Kept] = []
        self._future: list[Kept] = []

    @property
    def can_undo(self) -> bool:
        """Whether there is an edit to take back."""
        return bool(self._past)

    @property
    def can_redo(self) -> bool:
        """Whether there is an edit to do again."""
        return bool(self._future)

    def after(self, entry: Entry) -> Keypoints:
        """Returns the keypoints after a change, which is not made yet.

        Raises:
            KeyError, ValueError, TypeError: The entry is none, or does not fit.
        """
        if entry["kind"] in ("undo", "redo"):
            source = self._past if entry["kind"] == "undo" else self._future
            if not source:
                raise ValueError(f"nothing to {entry['kind']}")
            # Only the identities go on: one that was used and taken back is never another keypoint's.
            value = source[-1].restored(self.present)
            return dataclasses.replace(value, next_id=max(value.next_id, self.present.next_id))
        return changed(self.present, entry)

    def apply(self, entry: Entry) -> Keypoints:
        """Makes a change and returns the keypoints after it; raises as `after` does, and is then as before."""
        new = self.after(entry)
        kind = entry["kind"]
        if kind == "undo":
            self._future.append(Kept.of(self.present, new))
            self._past.pop()
        elif kind == "redo":
            self._past.append(Kept.of(self.present, new))
            self._future.pop()
        elif kind in EDITS:
            self._past.append(Kept.of(self.present, new))
            self._future.clear()
        elif kind in ("suggested", "opened"):
            self._past.clear()
            self._future.clear()
        self.present = new
        return new
