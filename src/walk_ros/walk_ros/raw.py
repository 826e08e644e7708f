# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Messages as the bytes they travel in: what recording and replaying need, without turning one into Python."""

from __future__ import annotations

import bisect
import importlib
import time
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from rclpy.callback_groups import CallbackGroup
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message, serialize_message

from walk_ros.errors import ArgumentError
from walk_ros.topics import Topic

OnRaw = Callable[[str, bytes, int], None]
"""Called with the full topic name, the message's bytes (CDR) and when it came in [ns]."""


def message_type(name: str) -> Any:
    """Returns the class of a message type such as `nav_msgs/msg/Path`; raises ArgumentError if there is none here."""
    package, _, rest = name.partition("/")
    try:
        return getattr(importlib.import_module(f"{package}.msg"), rest.rpartition("/")[2])
    except (ImportError, AttributeError) as error:
        raise ArgumentError(f"message type {name!r} is not installed") from error


def to_bytes(msg: Any) -> bytes:
    """Returns the message as CDR bytes."""
    return bytes(serialize_message(msg))


def from_bytes(data: bytes, name: str) -> Any:
    """Returns the message of a type, such as `nav_msgs/msg/Path`, that the CDR bytes hold."""
    return deserialize_message(data, message_type(name))


class RawSubscriber(Node):
    """Hands every message of some topics on as bytes."""

    def __init__(self, name: str, topics: Mapping[str, Topic], on_raw: OnRaw, *, depth: int = 1) -> None:
        """Subscribes.

        Args:
            name: Of the node.
            topics: By full name.
            on_raw: Called for every message, in the thread of the executor.
            depth: How many messages of a topic may wait, where the topic's own profile has fewer: one who needs
                all of them cannot do with the newest.
        """
        super().__init__(name)
        for topic, spec in topics.items():
            self._listen(topic, spec, on_raw, depth)

    def _listen(self, topic: str, spec: Topic, on_raw: OnRaw, depth: int) -> None:
        def callback(data: bytes) -> None:
            on_raw(topic, bytes(data), self.get_clock().now().nanoseconds)

        qos = profile(**{**policies(spec.qos), "depth": max(int(spec.qos.depth), depth)})
        self.create_subscription(spec.type, topic, callback, qos, raw=True)


class RawCollector(Node):
    """Takes the messages of some topics as bytes, many at a time and whenever it is asked to.

    A message wakes nobody up: the middleware keeps it, with the time at which it came in, until `collect`.
    """

    def __init__(self, name: str, topics: Mapping[str, Topic], *, depth: int) -> None:
        """Subscribes.

        Args:
            name: Of the node.
            topics: By full name.
            depth: How many messages of a topic may wait, where the topic's own profile has fewer.
        """
        super().__init__(name)
        self._ahead: list[RawMessage] = []
        self._by_topic = {
            topic: self.create_subscription(
                spec.type,
                topic,
                _nobody,
                profile(**{**policies(spec.qos), "depth": max(int(spec.qos.depth), depth)}),
                callback_group=_NotByTheExecutor(),
                raw=True,
            )
            for topic, spec in topics.items()
        }

    def collect(self) -> list[RawMessage]:
        """Returns what has come in since the last call, by time."""
        now_ns = time.time_ns()
        found = self._ahead
        for topic, subscription in self._by_topic.items():
            with subscription.handle:
                while (taken := subscription.handle.take_message(subscription.msg_type, True)) is not None:
                    found.append(RawMessage(topic, bytes(taken[0]), taken[1]["received_timestamp"]))
        found.sort(key=_time_of)
        # Of what came in meanwhile, something earlier may still be on a topic that was asked before.
        cut = bisect.bisect_right(found, now_ns, key=_time_of)
        self._ahead = found[cut:]
        return found[:cut]

    def type_hash(self, topic: str) -> str:
        """Returns the type hash (`RIHS01_…`) that a publisher of the topic announces, "" if none is known."""
        infos = self.get_publishers_info_by_topic(topic)
        return str(infos[0].topic_type_hash) if infos else ""


class RawMessage(NamedTuple):
    """A message as bytes."""

    topic: str  # full name
    data: bytes  # CDR
    received_ns: int


def _time_of(message: RawMessage) -> int:
    return message.received_ns


def _nobody(data: bytes) -> None:
    raise AssertionError(f"{len(data)} bytes were taken by the executor")


class _NotByTheExecutor(CallbackGroup):
    """What is in it is left alone by the executor, which would wake up for each message."""

    def can_execute(self, entity: object) -> bool:  # noqa: ARG002  (the executor calls it so)
        return False


class RawPublisher(Node):
    """Publishes bytes."""

    def __init__(self, name: str, topics: Mapping[str, Topic]) -> None:
        """Makes the publishers.

        Args:
            name: Of the node.
            topics: By full name.
        """
        super().__init__(name)
        self._publishing = {topic: self.create_publisher(spec.type, topic, spec.qos) for topic, spec in topics.items()}

    def send(self, topic: str, data: bytes) -> None:
        """Publishes the CDR bytes; a node that is ending says no more."""
        if self.context.ok():
            self._publishing[topic].publish(data)

    def wait_until_received(self, timeout_s: float) -> bool:
        """Returns whether every subscriber has acknowledged every message within the time."""
        return all(p.wait_for_all_acked(Duration(seconds=timeout_s)) for p in self._publishing.values())

    def end(self) -> None:
        """Shuts the middleware down, from any thread: the executor returns."""
        self.context.try_shutdown()


def profile(*, latched: bool, reliable: bool, depth: int) -> QoSProfile:
    """Returns the QoS profile with these policies."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=max(depth, 1),
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )


def policies(qos: QoSProfile) -> dict[str, Any]:
    """Returns the arguments of `profile` that make the QoS profile."""
    return {
        "latched": qos.durability == DurabilityPolicy.TRANSIENT_LOCAL,
        "reliable": qos.reliability == ReliabilityPolicy.RELIABLE,
        "depth": int(qos.depth),
    }
