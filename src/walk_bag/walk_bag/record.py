# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The executable that records a running walkthrough as a bag until Ctrl-C."""

from __future__ import annotations

import argparse
import datetime
import sys
from collections.abc import Sequence
from pathlib import Path

from walk_bag.errors import BagError
from walk_bag.storage import BagTopic, BagWriter
from walk_ros.raw import RawSubscriber, policies
from walk_ros.runner import run_node, user_arguments
from walk_ros.topics import NAMESPACE, TOPICS, Topic, absolute_name, type_name


class Recorder(RawSubscriber):
    """Writes every message of the walkthrough's topics to a bag as it comes in."""

    def __init__(self, writer: BagWriter, topics: dict[str, Topic]) -> None:
        self._writer = writer
        self._topics = {
            name: BagTopic(name=name, type_name=type_name(spec.type), **policies(spec.qos))
            for name, spec in topics.items()
        }
        self._seen: set[str] = set()
        super().__init__("record", topics, self._write)
        self.get_logger().info(f"recording {len(topics)} topics to {writer.path}; Ctrl-C ends it")

    def _write(self, topic: str, data: bytes, received_ns: int) -> None:
        if topic not in self._seen:
            self._seen.add(topic)
            self.get_logger().info(f"first of {topic}")
            self._check_type(topic)
        self._writer.write(self._topics[topic], received_ns, data)

    def _check_type(self, topic: str) -> None:
        """Warns if the publisher's message type is not the one that the bag will name."""
        sent, kept = self.type_hash(topic), self._writer.type_hash(self._topics[topic].type_name)
        if sent and sent != kept:
            self.get_logger().warning(f"{topic}: the publisher's type is {sent}, the bag names {kept}")


def chosen_topics(namespace: str, names: Sequence[str]) -> dict[str, Topic]:
    """Returns the topics of the table by full name: all, or those named."""
    return {absolute_name(name, namespace): TOPICS[name] for name in (names or TOPICS)}


def parse(argv: Sequence[str]) -> argparse.Namespace:
    """Returns the options of the command line."""
    parser = argparse.ArgumentParser(prog="record", description="Record a walkthrough as a rosbag2 (MCAP) bag.")
    parser.add_argument("--out", type=Path, help="directory, or file ending in .mcap (default: named by the time)")
    parser.add_argument("--namespace", default=NAMESPACE, help="of the nodes (default: %(default)s)")
    parser.add_argument("--topics", nargs="+", default=[], choices=list(TOPICS), help="only these", metavar="TOPIC")
    options = parser.parse_args(argv)
    options.out = options.out or Path(f"walkthrough-{datetime.datetime.now():%Y%m%d-%H%M%S}")
    return options


def main(argv: Sequence[str] | None = None) -> int:
    """Records until SIGINT or SIGTERM; returns the exit code."""
    argv = list(sys.argv if argv is None else argv)
    options = parse(user_arguments(argv)[1:])
    try:
        # Left on every way out of the node, so that the bag is always complete.
        with BagWriter(options.out) as writer:
            return run_node(lambda: Recorder(writer, chosen_topics(options.namespace, options.topics)), argv)
    except BagError as error:
        sys.stderr.write(f"{error}\n")
        return 2


if __name__ == "__main__":
    sys.exit(main())
