# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""MCAP files as they are written while things happen; the one place that knows the library of that format."""

from __future__ import annotations

import contextlib
import dataclasses
import os
import struct
from collections.abc import Iterator
from pathlib import Path

from mcap.exceptions import McapError
from mcap.records import Channel, McapRecord, Message, Schema
from mcap.stream_reader import StreamReader
from mcap.writer import Writer

from walk_bag.topics import BagMessage, BagTopic, qos_from_yaml, qos_to_yaml

CHUNK_BYTES = 4 << 20
"""Paths that follow each other while a keypoint is dragged differ little; chunks this long let zstd see that."""

ALONE_BYTES = 512 << 10
"""A message from this size on begins a chunk: what came before it is whole even if the file is cut within it."""

MAGIC = b"\x89MCAP0\r\n"
_ENCODING = "cdr"
_BROKEN_OFF = (McapError, EOFError, ValueError, struct.error)
"""What the library raises, depending on where in a record a file ends."""


@dataclasses.dataclass(slots=True)
class Counted:
    """A topic of the file with how many messages it has."""

    topic: BagTopic
    channel: int
    type_hash: str
    messages: int = 0


class McapFile:
    """Writes one MCAP file. What `flush` has returned from is in the file, whatever happens to the process."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.first_ns: int = 0
        self.last_ns: int = 0
        self.topics: dict[str, Counted] = {}
        self._schemas: dict[str, int] = {}
        self._whole = 0  # up to here the file holds whole records
        self._stream = path.open("xb")
        self._writer = Writer(self._stream, chunk_size=CHUNK_BYTES)
        self._writer.start(profile="ros2", library="walk_bag")
        self.flush()

    @property
    def message_count(self) -> int:
        """How many messages were written."""
        return sum(t.messages for t in self.topics.values())

    def add(self, topic: BagTopic, definition: str, type_hash: str) -> None:
        """Takes a topic in; its messages follow."""
        if topic.type_name not in self._schemas:
            self._schemas[topic.type_name] = self._writer.register_schema(
                topic.type_name, "ros2msg", definition.encode()
            )
        channel = self._writer.register_channel(
            topic.name,
            _ENCODING,
            self._schemas[topic.type_name],
            {"offered_qos_profiles": qos_to_yaml(topic), "topic_type_hash": type_hash},
        )
        self.topics[topic.name] = Counted(topic, channel, type_hash)

    def write(self, name: str, stamp_ns: int, data: bytes) -> None:
        """Appends a message of a topic that was taken in."""
        counted = self.topics[name]
        if len(data) >= ALONE_BYTES:
            self.flush()
        self._writer.add_message(counted.channel, stamp_ns, data, stamp_ns, sequence=counted.messages)
        self.first_ns = min(self.first_ns, stamp_ns) if self.message_count else stamp_ns
        self.last_ns = max(self.last_ns, stamp_ns)
        counted.messages += 1

    def flush(self) -> None:
        """Ends the chunk that is being filled and hands it to the operating system."""
        self._writer.flush()
        self._whole = self._stream.tell()

    def finish(self, metadata: str) -> None:
        """Writes the indexes and closes the file.

        Args:
            metadata: What rosbag2 keeps about a bag, as text; readers of the bare file find it there.
        """
        self.flush()
        self._writer.add_metadata("rosbag2", {"serialized_metadata": metadata})
        self._writer.finish()
        self._stream.close()

    def cut(self) -> None:
        """Closes the file after an error and takes away the record that is only in part in it."""
        with contextlib.suppress(OSError):
            self._stream.close()  # tries once more to write what it holds
        with contextlib.suppress(OSError):
            os.truncate(self.path, self._whole)


def is_finished(path: Path) -> bool:
    """Returns whether an MCAP file was closed by its writer: its last bytes say so."""
    with path.open("rb") as file:
        file.seek(0, os.SEEK_END)
        if file.tell() < 2 * len(MAGIC):
            return False
        file.seek(-len(MAGIC), os.SEEK_END)
        return file.read() == MAGIC


def is_mcap(path: Path) -> bool:
    """Returns whether a file begins as an MCAP file does."""
    with path.open("rb") as file:
        return file.read(len(MAGIC)) == MAGIC


def read_whole_records(path: Path) -> Iterator[BagMessage]:
    """Yields the messages of a file that was not closed: all up to where it breaks off.

    Raises:
        ValueError: Not even its beginning can be read.
    """
    schemas: dict[int, Schema] = {}
    topics: dict[int, BagTopic] = {}
    with path.open("rb") as file:
        records = StreamReader(file, validate_crcs=True).records
        try:
            next(records)  # the header
        except (*_BROKEN_OFF, StopIteration) as error:
            raise ValueError("nothing of it is whole") from error
        for record in _up_to_the_break(records):
            if isinstance(record, Schema):
                schemas[record.id] = record
            elif isinstance(record, Channel):
                topics[record.id] = _topic(record, schemas)
            elif isinstance(record, Message):
                yield BagMessage(topic=topics[record.channel_id], stamp_ns=record.log_time, data=record.data)


def _up_to_the_break(records: Iterator[McapRecord]) -> Iterator[McapRecord]:
    with contextlib.suppress(*_BROKEN_OFF):
        yield from records


def _topic(channel: Channel, schemas: dict[int, Schema]) -> BagTopic:
    schema = schemas.get(channel.schema_id)
    return BagTopic(
        name=channel.topic,
        type_name=schema.name if schema else "",
        **qos_from_yaml(channel.metadata.get("offered_qos_profiles", "")),
    )
