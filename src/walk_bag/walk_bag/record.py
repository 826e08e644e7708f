# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The executable that records a running walkthrough as a bag until Ctrl-C."""

from __future__ import annotations

import argparse
import contextlib
import datetime
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from walk_bag import parameter_watch
from walk_bag.errors import BagError
from walk_bag.spool import Spool
from walk_bag.storage import BagWriter
from walk_bag.topics import BagTopic
from walk_ros.raw import RawSubscriber, policies
from walk_ros.runner import run_node, user_arguments
from walk_ros.topics import NAMESPACE, TOPICS, Topic, absolute_name, type_name

QUEUE_DEPTH = 500
"""Messages of a topic that may wait: five seconds of a drag at a headset's rate."""

NICENESS = 10
"""The nodes that answer edits go first."""

EXIT_DISK = 1


class Recorder(RawSubscriber):
    """Writes every message of the walkthrough's topics, and the nodes' parameters, to a bag as they come in.

    Attributes:
        failed: Whether the bag could not be written to its end.
    """

    failed = False

    def __init__(self, writer: BagWriter, topics: dict[str, Topic], namespace: str) -> None:
        self._writer = writer
        self._topics = {
            name: BagTopic(name=name, type_name=type_name(spec.type), **policies(spec.qos))
            for name, spec in topics.items()
        }
        self._seen: set[str] = set()
        self._spool = Spool(writer, self._stop)
        super().__init__("record", topics, self._take, depth=QUEUE_DEPTH)
        if parameter_watch.TOPIC in topics:
            self._watch = parameter_watch.ParameterWatch(self, namespace, self._take_parameters)
        self.get_logger().info(f"recording {len(topics)} topics to {writer.path}; Ctrl-C ends it")

    def destroy_node(self) -> None:
        """Writes what has come in, then ends the node."""
        self._spool.close()
        super().destroy_node()

    def _take(self, topic: str, data: bytes, received_ns: int) -> None:
        if topic not in self._seen:
            self._seen.add(topic)
            self.get_logger().info(f"first of {topic}")
            self._check_type(topic)
        self._spool.put(self._topics[topic], received_ns, data)

    def _take_parameters(self, data: bytes) -> None:
        self._take(parameter_watch.TOPIC, data, self.get_clock().now().nanoseconds)

    def _stop(self, error: BagError) -> None:
        """Ends the recording, and nothing else of the graph."""
        self.get_logger().error(str(error))
        self.failed = True
        self.context.try_shutdown()

    def _check_type(self, topic: str) -> None:
        """Warns if the publisher's message type is not the one that the bag will name."""
        sent, kept = self.type_hash(topic), self._writer.type_hash(self._topics[topic].type_name)
        if sent and sent != kept:
            self.get_logger().warning(f"{topic}: the publisher's type is {sent}, the bag names {kept}")


def chosen_topics(namespace: str, names: Sequence[str]) -> dict[str, Topic]:
    """Returns the topics to record by full name: those named, or all of the table and the parameters."""
    if names:
        return {absolute_name(name, namespace): TOPICS[name] for name in names}
    return {absolute_name(name, namespace): spec for name, spec in TOPICS.items()} | {
        parameter_watch.TOPIC: parameter_watch.SPEC
    }


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
    with contextlib.suppress(OSError):
        os.nice(NICENESS)
    made: list[Recorder] = []
    try:
        # Left on every way out of the node, so that the bag is always complete.
        with BagWriter(options.out, keep=True) as writer:

            def factory() -> Recorder:
                made.append(Recorder(writer, chosen_topics(options.namespace, options.topics), options.namespace))
                return made[0]

            code = run_node(factory, argv)
    except BagError as error:
        sys.stderr.write(f"{error}\n")
        return EXIT_DISK if made else 2
    if made and made[0].failed:
        return EXIT_DISK
    size_mb = sum(f.stat().st_size for f in _files(options.out)) / 1e6
    sys.stdout.write(
        f"walk: {writer.message_count} messages in {writer.duration_s:.0f} s, {size_mb:.1f} MB, in {options.out}\n"
    )
    return code


def _files(bag: Path) -> list[Path]:
    return [bag] if bag.is_file() else [file for file in bag.iterdir() if file.is_file()]


if __name__ == "__main__":
    sys.exit(main())
