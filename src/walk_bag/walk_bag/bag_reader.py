# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Reads bags in all storages of rosbag2, and what their message types are, without a ROS installation."""

from __future__ import annotations

import contextlib
import functools
import heapq
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import yaml
from rosbags.interfaces import Connection, QosDurability, QosReliability
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_typestore
from rosbags.typesys.store import Typestore

from walk_bag.errors import BagError
from walk_bag.mcap_file import is_finished, is_mcap, read_whole_records
from walk_bag.metadata import METADATA
from walk_bag.topics import BagMessage, BagTopic


def read_bag(
    path: Path | str, topics: set[str] | None = None, *, start_ns: int = 0, stop_ns: int = 2**63 - 1
) -> Iterator[BagMessage]:
    """Yields the messages of a bag, a directory or a bare file, by time.

    A bag whose writer was killed gives the messages up to where it breaks off.

    Args:
        path: The bag: MCAP or SQLite, as rosbag2 writes them.
        topics: Full names of those to read; None for all.
        start_ns: Messages recorded before are left out.
        stop_ns: Those recorded then or later are left out.

    Raises:
        BagError: There is no such bag, or it is damaged.
    """
    path = _existing(path)
    if unfinished_file(path) is not None:
        for message in _whole_messages(path):
            if start_ns <= message.stamp_ns < stop_ns and (topics is None or message.topic.name in topics):
                yield message
        return
    with _reading(path) as readers:
        parts = [_messages(reader, topics, start_ns, stop_ns) for reader in readers]
        yield from heapq.merge(*parts, key=lambda message: message.stamp_ns)


def _messages(reader: Reader, topics: set[str] | None, start_ns: int, stop_ns: int) -> Iterator[BagMessage]:
    wanted = [c for c in reader.connections if topics is None or c.topic in topics]
    bag_topics = {c.id: _topic(c) for c in wanted}
    # Without connections the reader would give all.
    for connection, stamp_ns, data in reader.messages(wanted, start_ns, stop_ns) if wanted else ():
        yield BagMessage(topic=bag_topics[connection.id], stamp_ns=stamp_ns, data=bytes(data))


def read_topics(path: Path | str) -> tuple[BagTopic, ...]:
    """Returns the topics of a bag; raises BagError as `read_bag` does."""
    path = _existing(path)
    if unfinished_file(path) is not None:
        found = {message.topic.name: message.topic for message in _whole_messages(path)}
        return tuple(found.values())
    with _reading(path) as readers:
        return tuple({c.topic: _topic(c) for reader in readers for c in reader.connections}.values())


def read_counts(path: Path | str) -> dict[str, int]:
    """Returns how many messages each topic of a bag has; raises BagError as `read_bag` does."""
    path = _existing(path)
    counts: Counter[str] = Counter()
    if unfinished_file(path) is not None:
        counts.update(message.topic.name for message in _whole_messages(path))
        return dict(counts)
    with _reading(path) as readers:
        for connection in (c for reader in readers for c in reader.connections):
            counts[connection.topic] += connection.msgcount
    return dict(counts)


def read_span(path: Path | str) -> tuple[int, int]:
    """Returns when the first and the last message of a bag were recorded [ns]; (0, 0) where there are none."""
    path = _existing(path)
    if unfinished_file(path) is not None:
        stamps = [message.stamp_ns for message in _whole_messages(path)]
        return (min(stamps), max(stamps)) if stamps else (0, 0)
    with _reading(path) as readers:
        told = [reader for reader in readers if reader.message_count]
        # The library's end is one past the last message.
        return (min(r.start_time for r in told), max(r.end_time for r in told) - 1) if told else (0, 0)


def unfinished_file(path: Path) -> Path | None:
    """Returns the MCAP file of a bag whose writer did not get to close it, None if the bag is whole."""
    files = _mcap_files(path)
    broken = [file for file in files if is_mcap(file) and not is_finished(file)]
    if not broken and files and path.is_dir() and not (path / METADATA).exists():
        return files[-1]  # closed, but killed before the directory was complete
    return broken[0] if broken else None


def cut_off_note(path: Path) -> str:
    """Returns the sentence that says of a bag that its recording was cut off, "" for a whole one."""
    if unfinished_file(path) is None:
        return ""
    return f"the recording {path} was cut off: what stands before that is taken; ./walk recover makes a whole bag of it"


def _mcap_files(path: Path) -> list[Path]:
    """Returns the MCAP files of a bag in the order in which they were written: NAME_2.mcap before NAME_10.mcap."""
    return [path] if path.is_file() else sorted(path.glob("*.mcap"), key=lambda file: (len(file.name), file.name))


def _whole_messages(path: Path) -> Iterator[BagMessage]:
    # In the order of the files, which is that of time: a recorder writes as messages come.
    files = _mcap_files(path)
    for file in files:
        try:
            yield from read_whole_records(file)
        except ValueError as error:
            if len(files) == 1:
                raise BagError(path, f"is not a bag that can be read: {error}") from error
            # The last file of several may have been cut before its first record: the others are whole.


def _existing(path: Path | str) -> Path:
    if not Path(path).exists():
        raise BagError(path, "there is no such file or folder")
    return Path(path)


@contextlib.contextmanager
def _reading(path: Path) -> Iterator[list[Reader]]:
    """Opens the files of a bag that is whole."""
    with contextlib.ExitStack() as stack:
        try:
            yield [stack.enter_context(Reader(file)) for file in _storage_files(path)]
        except GeneratorExit:
            raise
        except Exception as error:  # a damaged file fails anywhere inside of the library
            raise BagError(path, f"is not a bag that can be read: {error or type(error).__name__}") from error


def _storage_files(path: Path) -> list[Path]:
    """Returns what the library has to open to read a bag: its files, or the directory where they are compressed.

    Asked for a directory, the library passes over a topic whose QoS in the directory's metadata is not to the letter
    that in the file, without a word; the files themselves are read as they are.
    """
    if path.is_file():
        return [path]
    metadata = path / METADATA
    if not metadata.exists():
        return sorted(path.glob("*.db3"), key=lambda file: (len(file.name), file.name)) or [path]
    about = yaml.safe_load(metadata.read_text(encoding="utf-8"))["rosbag2_bagfile_information"]
    if about.get("compression_mode", "").lower() not in ("", "none"):
        return [path]
    return [path / Path(name).name for name in about["relative_file_paths"]]


def _topic(connection: Connection) -> BagTopic:
    """Returns the topic with the QoS that its publisher offered; reliable and volatile where the bag says nothing."""
    profiles = list(getattr(connection.ext, "offered_qos_profiles", ()) or ())
    qos = profiles[0] if profiles else None
    return BagTopic(
        name=connection.topic,
        type_name=connection.msgtype,
        latched=qos is not None and qos.durability == QosDurability.TRANSIENT_LOCAL,
        reliable=qos is None or qos.reliability != QosReliability.BEST_EFFORT,
        depth=max(qos.depth, 1) if qos is not None else 10,
    )


def message_definition(type_name: str) -> str:
    """Returns the definition of a message type and of all it is made of, as bags and viewers hold it."""
    definition, _ = _types().generate_msgdef(type_name, ros_version=2)
    return str(definition)


def message_hash(type_name: str) -> str:
    """Returns the hash of a message type, `RIHS01_…`, as bags hold it."""
    return str(_types().hash_rihs01(type_name))


@functools.cache
def _types() -> Typestore:
    return get_typestore(Stores.ROS2_JAZZY)
