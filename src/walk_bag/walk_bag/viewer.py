# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The executable that shows the running graph to Foxglove, which then needs no ROS of its own."""

from __future__ import annotations

import sys
import threading
from collections import deque
from collections.abc import Mapping, Sequence

from foxglove.websocket import ChannelView, Client, ServerListener
from rcl_interfaces.msg import IntegerRange, ParameterDescriptor

import foxglove
from foxglove import Channel, Schema
from walk_bag.bag_reader import message_definition
from walk_ros.errors import ArgumentError
from walk_ros.raw import RawSubscriber, policies
from walk_ros.runner import run_node
from walk_ros.topics import TOPICS, Topic, type_name

PORT = 8766
"""One above the page's."""

HOST = "127.0.0.1"
"""This machine only: Foxglove's protocol knows no token."""


class Viewer(RawSubscriber):
    """Hands every message on as it is; who comes late gets what is latched."""

    def __init__(self) -> None:
        # Relative names: the middleware puts the namespace of the command line in front.
        super().__init__("viewer", TOPICS, self._pass_on)
        self._names = {name: self.resolve_topic_name(name) for name in TOPICS}
        topics = {self._names[name]: spec for name, spec in TOPICS.items()}
        self._channels = make_channels(topics)
        self._latest = Latest(topics)
        described = ParameterDescriptor(
            description="port that Foxglove connects to",
            integer_range=[IntegerRange(from_value=0, to_value=65535, step=1)],
            read_only=True,
        )
        port = int(self.declare_parameter("viewer_port", PORT, described).value)
        try:
            self._server = foxglove.start_server(
                name="walkthrough", host=HOST, port=port, server_listener=_Latched(self._channels, self._latest)
            )
        except (RuntimeError, OSError) as error:
            raise ArgumentError(f"viewer_port: {port} cannot be listened on: {error}; name another one") from error
        self.get_logger().info(f"Foxglove: open the connection ws://localhost:{self._server.port}")

    def destroy_node(self) -> None:
        """Closes the connections, then the node."""
        self._server.stop()
        super().destroy_node()

    def _pass_on(self, topic: str, data: bytes, received_ns: int) -> None:
        name = self._names[topic]
        self._latest.keep(name, data, received_ns)
        self._channels[name].log(data, log_time=received_ns)


class Latest:
    """The messages of latched topics that somebody who comes late has to get."""

    def __init__(self, topics: Mapping[str, Topic]) -> None:
        kept = {name: policies(spec.qos) for name, spec in topics.items()}
        self._messages: dict[str, deque[tuple[bytes, int]]] = {
            name: deque(maxlen=qos["depth"]) for name, qos in kept.items() if qos["latched"]
        }
        self._lock = threading.Lock()

    def keep(self, topic: str, data: bytes, received_ns: int) -> None:
        """Takes a message in, if its topic is latched."""
        if topic in self._messages:
            with self._lock:
                self._messages[topic].append((data, received_ns))

    def of(self, topic: str) -> Sequence[tuple[bytes, int]]:
        """Returns the messages of a topic with when they came [ns], oldest first."""
        with self._lock:
            return tuple(self._messages.get(topic, ()))


class _Latched(ServerListener):
    def __init__(self, channels: Mapping[str, Channel], latest: Latest) -> None:
        self._channels = channels
        self._latest = latest

    def on_subscribe(self, client: Client, channel: ChannelView) -> None:  # noqa: ARG002  (the library calls it so)
        # To all: the library does not tell which of its sinks is the client's. Those who have it get it once more.
        for data, received_ns in self._latest.of(channel.topic):
            self._channels[channel.topic].log(data, log_time=received_ns)


def make_channels(topics: Mapping[str, Topic]) -> dict[str, Channel]:
    """Returns a channel for each topic, with the definition of its messages."""
    channels = {}
    for name, spec in topics.items():
        definition = message_definition(type_name(spec.type))
        schema = Schema(name=type_name(spec.type), encoding="ros2msg", data=definition.encode())
        channels[name] = Channel(name, schema=schema, message_encoding="cdr")
    return channels


def main(argv: Sequence[str] | None = None) -> int:
    """Shows the graph until SIGINT or SIGTERM; returns the exit code."""
    return run_node(Viewer, argv)


if __name__ == "__main__":
    sys.exit(main())
