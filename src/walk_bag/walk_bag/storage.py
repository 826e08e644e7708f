# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""rosbag2 bags: written in MCAP, read in all storages of rosbag2, without a ROS installation."""

from __future__ import annotations

import contextlib
import functools
import heapq
import itertools
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType
from typing import Self

import yaml
from rosbags.interfaces import Connection, QosDurability, QosReliability
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_typestore
from rosbags.typesys.store import Typestore

from walk_bag.errors import BagError
from walk_bag.mcap_file import McapFile, is_finished, is_mcap, read_whole_records
from walk_bag.metadata import embedded_yaml, metadata_yaml
from walk_bag.topics import BagMessage, BagTopic

_METADATA = "metadata.yaml"


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
        return str(_types().hash_rihs01(type_name))

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
                (self.path / _METADATA).write_text(metadata_yaml(self._file), encoding="utf-8")
        except OSError as error:
            self._file.cut()
            raise _disk_error(self._file.path, error) from error


def message_definition(type_name: str) -> str:
    """Returns the definition of a message type and of all it is made of, as bags and viewers hold it."""
    definition, _ = _types().generate_msgdef(type_name, ros_version=2)
    return str(definition)


@functools.cache
def _types() -> Typestore:
    return get_typestore(Stores.ROS2_JAZZY)


def _disk_error(path: Path, error: OSError) -> BagError:
    return BagError(
        path, f"cannot be written any more: {error.strerror}; what was written before is kept and can be read"
    )


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
    if not broken and files and path.is_dir() and not (path / _METADATA).exists():
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


def recover_bag(path: Path | str, out: Path | str) -> int:
    """Writes what can be read of a broken bag as a whole one; returns how many messages that is.

    Raises:
        BagError: There is nothing to read, or `out` cannot be written.
    """
    messages = read_bag(path)
    first = next(messages, None)
    if first is None:
        raise BagError(path, "is cut within its first messages: there is nothing to recover")
    with BagWriter(out) as writer:
        for message in itertools.chain([first], messages):
            writer.write(message.topic, message.stamp_ns, message.data)
        return writer.message_count


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
    metadata = path / _METADATA
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
