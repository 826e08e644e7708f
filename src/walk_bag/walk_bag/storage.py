# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""rosbag2 bags in MCAP, without a ROS installation; the one place that knows the bag library."""

from __future__ import annotations

import dataclasses
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType
from typing import Literal, Self

from rosbags.highlevel import AnyReader
from rosbags.interfaces import (
    Connection,
    Qos,
    QosDurability,
    QosHistory,
    QosLiveliness,
    QosReliability,
    QosTime,
)
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from walk_bag.errors import BagError

VERSION: Literal[8] = 8
"""Of the metadata: what the readers of Humble's time understand, too."""

_ANY_TIME = QosTime(2147483647, 4294967295)  # how rosbag2 writes "infinite"


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class BagTopic:
    """A topic of a bag and the QoS its publisher offered."""

    name: str  # full, such as /walk/path
    type_name: str  # such as nav_msgs/msg/Path
    latched: bool
    reliable: bool
    depth: int


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class BagMessage:
    """A message of a bag."""

    topic: BagTopic
    stamp_ns: int  # when it was recorded
    data: bytes  # CDR


class BagWriter:
    """Writes a bag; a context manager, complete once it is left.

    A path that ends in `.mcap` becomes a bare file, which plays as it is, and replaces one that is there. Any
    other becomes a rosbag2 directory, which must not be there yet.
    """

    def __init__(self, path: Path | str) -> None:
        self.path = Path(path)
        self._bare = self.path.suffix == ".mcap"
        self._types = get_typestore(Stores.ROS2_JAZZY)
        self._connections: dict[str, Connection] = {}
        self._folder: Path | None = None
        try:
            if self._bare:
                self.path.parent.mkdir(parents=True, exist_ok=True)
                # Beside the target, so that moving it there is one step on one file system.
                self._folder = Path(tempfile.mkdtemp(prefix=".bag-", dir=self.path.parent))
            elif self.path.exists():
                raise BagError(self.path, "exists already; name another bag or take it away")
            directory = self.path if self._folder is None else self._folder / self.path.stem
            self._writer = Writer(directory, version=VERSION, storage_plugin=StoragePlugin.MCAP)
            self._writer.open()
        except OSError as error:
            raise BagError(self.path, f"cannot be written: {error.strerror}") from error

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if error is not None and self._folder is not None:
            # Half a file must not replace a whole one.
            self._writer.abort()
            shutil.rmtree(self._folder)
        else:
            self.close()

    def type_hash(self, type_name: str) -> str:
        """Returns the hash of a message type, `RIHS01_…`, as the bag will hold it."""
        return str(self._types.hash_rihs01(type_name))

    def write(self, topic: BagTopic, stamp_ns: int, data: bytes) -> None:
        """Appends a message (CDR bytes) that was sent or came in at the time."""
        if topic.name not in self._connections:
            self._connections[topic.name] = self._writer.add_connection(
                topic.name, topic.type_name, typestore=self._types, offered_qos_profiles=[_offered(topic)]
            )
        self._writer.write(self._connections[topic.name], stamp_ns, data)

    def close(self) -> None:
        """Finishes the bag: index and metadata."""
        self._writer.close()
        if self._folder is not None:
            (self._folder / self.path.stem / f"{self.path.stem}.mcap").replace(self.path)
            shutil.rmtree(self._folder)


def _existing(path: Path | str) -> Path:
    if not Path(path).exists():
        raise BagError(path, "there is no such file or folder")
    return Path(path)


def read_bag(path: Path | str) -> Iterator[BagMessage]:
    """Yields the messages of a bag, a directory or a bare `.mcap`, by time.

    Raises:
        BagError: There is no such bag, or it is damaged.
    """
    path = _existing(path)
    try:
        with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as reader:
            topics = {c.id: _topic(c) for c in reader.connections}
            for connection, stamp_ns, data in reader.messages():
                yield BagMessage(topic=topics[connection.id], stamp_ns=stamp_ns, data=bytes(data))
    except Exception as error:  # a damaged file fails anywhere inside of the library
        raise BagError(path, f"is not a bag that can be read: {error or type(error).__name__}") from error


def read_topics(path: Path | str) -> tuple[BagTopic, ...]:
    """Returns the topics of a bag; raises BagError as `read_bag` does."""
    path = _existing(path)
    try:
        with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as reader:
            return tuple(_topic(c) for c in reader.connections)
    except Exception as error:  # a damaged file fails anywhere inside of the library
        raise BagError(path, f"is not a bag that can be read: {error or type(error).__name__}") from error


def _offered(topic: BagTopic) -> Qos:
    return Qos(
        history=QosHistory.KEEP_LAST,
        depth=topic.depth,
        reliability=QosReliability.RELIABLE if topic.reliable else QosReliability.BEST_EFFORT,
        durability=QosDurability.TRANSIENT_LOCAL if topic.latched else QosDurability.VOLATILE,
        deadline=_ANY_TIME,
        lifespan=_ANY_TIME,
        liveliness=QosLiveliness.AUTOMATIC,
        liveliness_lease_duration=_ANY_TIME,
        avoid_ros_namespace_conventions=False,
    )


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
