# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Accepted changes on disk: a line of JSON each, written through before the change is confirmed."""

from __future__ import annotations

import errno
import itertools
import json
import logging
import os
from collections.abc import Iterator
from io import FileIO
from pathlib import Path

from walk_building.errors import WalkError
from walk_sequencer.changes import Entry
from walk_sequencer.history import History

_log = logging.getLogger(__name__)


class JournalError(WalkError):
    """A journal that cannot be read or written.

    Attributes:
        path: The file.
        reason: What the system says.
    """

    def __init__(self, path: Path, reason: str) -> None:
        self.path = path
        self.reason = reason
        super().__init__(f"{path}: the journal of edits cannot be kept: {reason}; set 'state_dir' to another folder")


def default_state_dir() -> Path:
    """Returns the folder for what a program keeps between runs, by the XDG base directory specification."""
    home = os.environ.get("XDG_STATE_HOME", "")
    return (Path(home) if Path(home).is_absolute() else Path.home() / ".local" / "state") / "walk"


class Journal:
    """The changes of one building's keypoints. One process writes it."""

    def __init__(self, folder: Path, building_hash: str) -> None:
        """Opens the journal; `replay` reads it and must come before `append`."""
        self.path = folder / f"{building_hash}.jsonl"

    def replay(self) -> History:
        """Returns the keypoints after all changes in the journal, with their past; none where there is no journal.

        A last line that was cut off by a crash was never confirmed and is taken off. From a line on that does not
        fit for another reason the journal is put aside, and what stands before it counts.

        Raises:
            JournalError: The folder or the file cannot be read or written.
        """
        try:
            return self._replay()
        except OSError as error:
            raise JournalError(self.path, error.strerror or str(error)) from error

    def append(self, entry: Entry) -> None:
        """Writes a change through to the disk; it may be confirmed after this.

        Raises:
            JournalError: The file cannot be written; it is as before.
        """
        line = (json.dumps(dict(entry), allow_nan=False) + "\n").encode()
        try:
            new = not self.path.exists()
            # Unbuffered: what could not be written must not follow when the file is closed.
            with self.path.open("ab", buffering=0) as file:
                self._write_through(file, line)
            if new:
                self._sync_folder()
        except OSError as error:
            raise JournalError(self.path, error.strerror or str(error)) from error

    def written_after(self, time_s: float) -> bool:
        """Returns whether there is a journal whose last change came after a time [s since 1970]; 0 is no time."""
        try:
            return 0.0 < time_s < self.path.stat().st_mtime
        except OSError:
            return False

    def put_aside(self) -> Path | None:
        """Renames the journal, so that the next start begins without it; returns the new name, or None for no journal.

        It ends in `.old`, or `.2.old` and so on: what was put aside before stays.
        """
        numbers = itertools.chain([""], (f".{k}" for k in itertools.count(2)))
        names = (self.path.with_suffix(f"{number}.old") for number in numbers)
        try:
            return self.path.rename(next(n for n in names if not n.exists())) if self.path.exists() else None
        except OSError as error:
            raise JournalError(self.path, error.strerror or str(error)) from error

    def _write_through(self, file: FileIO, line: bytes) -> None:
        end = file.tell()
        try:
            if file.write(line) < len(line):
                raise OSError(errno.ENOSPC, "only a part of the change could be written")
            os.fsync(file.fileno())
        except OSError:
            # A refused change must not come back at the next start, and half a line would spoil the one behind it.
            file.truncate(end)
            raise

    def _sync_folder(self) -> None:
        """Writes the file's name through to the disk, which the file's own fsync does not."""
        folder = os.open(self.path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)

    def _replay(self) -> History:
        self.path.parent.mkdir(parents=True, exist_ok=True)
        history = History()
        if not self.path.exists():
            return history
        text = self.path.read_bytes()
        good = 0
        for end, line in _lines(text):
            try:
                history.apply(json.loads(line))
            except (ValueError, KeyError, TypeError, AttributeError):
                break
            good = end
        if good < len(text):
            self._cut(text, good)
        return history

    def _cut(self, text: bytes, good: int) -> None:
        """Keeps the first `good` bytes; a whole copy is put aside unless only the last line is missing its end."""
        torn = b"\n" not in text[good:]
        if not torn:
            aside = self.path.with_suffix(".damaged")
            aside.write_bytes(text)
            _log.warning("%s is damaged; what stands before the damage counts, a copy is in %s", self.path, aside)
        with self.path.open("r+b") as file:
            file.truncate(good)
            file.flush()
            os.fsync(file.fileno())


def _lines(text: bytes) -> Iterator[tuple[int, bytes]]:
    """Yields whole lines with the offset of their end."""
    start = 0
    while (end := text.find(b"\n", start)) >= 0:
        yield end + 1, text[start:end]
        start = end + 1
