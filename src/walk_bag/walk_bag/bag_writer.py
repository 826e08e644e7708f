# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Writes rosbag2 bags, in MCAP, without a ROS installation."""

from __future__ import annotations

from pathlib import Path
from types import TracebackType
from typing import Self

from walk_bag.bag_reader import message_definition, message_hash
from walk_bag.errors import BagError
from walk_bag.mcap_file import McapFile
from walk_bag.metadata import METADATA, embedded_yaml, metadata_yaml
from walk_bag.topics import BagTopic


class BagWriter:
    """Writes a bag; a context manager, complete once it is left.

    A path that ends in `.mcap` becomes a bare file, which plays as it is, and replaces one that is there. Any
    other becomes a rosbag2 directory, which must not be there yet.
    """

    def __init__(self, path: Path | str, *, keep: bool = False) -> None:
        """Begins the bag.

        Args:
            path: The bag.
            keep: Whether what was written before an error is worth keeping: a bare file is then written as
                `NAME.part.mcap`, a bag of its own, until it is complete.

        Raises:
            BagError: The bag cannot be written there.
        """
        self.path = Path(path)
        self._keep = keep or self.path.suffix != ".mcap"
        self._recording = keep
        try:
            self._file = McapFile(self._begin())
        except OSError as error:
            raise BagError(self.path, f"cannot be written: {error.strerror}") from error

    def _begin(self) -> Path:
        """Returns the file to write; makes the folders it needs."""
        if self.path.suffix != ".mcap":
            if self.path.exists():
                raise BagError(self.path, "exists already; name another bag or take it away")
            self.path.mkdir(parents=True)
            return self.path / f"{self.path.name}.mcap"
        self.path.parent.mkdir(parents=True, exist_ok=True)
        part = self.path.with_suffix(".part.mcap")
        if self._keep and part.exists():
            raise BagError(part, "is what is left of a recording that was cut off; recover it or take it away")
        part.unlink(missing_ok=True)
        return part

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if error is None or (self._recording and not isinstance(error, Exception)):
            self.close()  # a recording ends with Ctrl-C, wherever that comes
            return
        self._file.cut()
        if not self._keep:
            self._file.path.unlink()

    @property
    def message_count(self) -> int:
        """How many messages were written."""
        return self._file.message_count

    @property
    def duration_s(self) -> float:
        """Time from the first message to the last."""
        return (self._file.last_ns - self._file.first_ns) / 1e9

    def type_hash(self, type_name: str) -> str:
        """Returns the hash of a message type, `RIHS01_…`, as the bag will hold it."""
        return message_hash(type_name)

    def write(self, topic: BagTopic, stamp_ns: int, data: bytes) -> None:
        """Appends a message (CDR bytes) that was sent or came in at the time.

        Raises:
            BagError: The disk is full or gone.
        """
        try:
            if topic.name not in self._file.topics:
                self._file.add(topic, message_definition(topic.type_name), self.type_hash(topic.type_name))
            self._file.write(topic.name, stamp_ns, data)
        except OSError as error:
            raise _disk_error(self._file.path, error) from error

    def flush(self) -> None:
        """Hands what was written to the operating system; a process killed later loses none of it."""
        try:
            self._file.flush()
        except OSError as error:
            raise _disk_error(self._file.path, error) from error

    def close(self) -> None:
        """Finishes the bag: index and metadata."""
        try:
            self._file.finish(embedded_yaml(self._file))
            if self.path.suffix == ".mcap":
                self._file.path.replace(self.path)
            else:
                (self.path / METADATA).write_text(metadata_yaml(self._file), encoding="utf-8")
        except OSError as error:
            self._file.cut()
            raise _disk_error(self._file.path, error) from error


def _disk_error(path: Path, error: OSError) -> BagError:
    return BagError(
        path, f"cannot be written any more: {error.strerror}; what was written before is kept and can be read"
    )
