# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Journals of edits as a project keeps them: read while a sequencer writes them, begun with a saved tour."""

from __future__ import annotations

import json
from pathlib import Path

from walk_bringup.projects.errors import ProjectError
from walk_sequencer.changes import EDITS, opened_entry
from walk_sequencer.history import History
from walk_sequencer.keypoints import Keypoints
from walk_sequencer.whole import plain

_HANDS = {*EDITS, "undo", "redo"}


def read_journal(path: Path) -> tuple[bytes, Keypoints]:
    """Returns the whole lines of a journal that can be replayed, and the keypoints after them; changes nothing.

    Raises:
        ProjectError: It cannot be read.
    """
    try:
        text = path.read_bytes() if path.exists() else b""
    except OSError as error:
        raise ProjectError(path, f"cannot be read: {error.strerror or error}") from error
    history, good = History(), 0
    for line in text.splitlines(keepends=True):
        try:
            if not line.endswith(b"\n"):
                break
            history.apply(json.loads(line))
        except (ValueError, KeyError, TypeError, AttributeError):
            break
        good += len(line)
    return text[:good], history.present


def begun_with(keypoints: Keypoints) -> bytes:
    """Returns a journal whose first line is a saved tour."""
    return (json.dumps(opened_entry(keypoints), allow_nan=False) + "\n").encode()


def same(a: Keypoints, b: Keypoints) -> bool:
    """Returns whether two sets of keypoints make the same tour."""
    left, right = plain(a), plain(b)
    # An identity that is free already may be used up in one of them.
    return {**left, "next_id": 0} == {**right, "next_id": 0}


def edits_in(text: bytes) -> int:
    """Returns how many lines of a journal are a user's."""
    return sum(json.loads(line).get("kind") in _HANDS for line in text.splitlines())
