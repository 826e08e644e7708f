# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The executable that records a running walkthrough as a bag until Ctrl-C."""

from __future__ import annotations

import argparse
import contextlib
import datetime
import os
import sys
import threading
from collections.abc import Sequence
from pathlib import Path

from walk_bag import parameter_watch
from walk_bag.bag_writer import BagWriter
from walk_bag.errors import BagError
from walk_bag.spool import FLUSH_S, Spool
from walk_bag.topics import BagTopic
from walk_ros.raw import RawCollector, policies
from walk_ros.runner import run_node, user_arguments
from walk_ros.topics import NAMESPACE, TOPICS, Topic, absolute_name, type_name

QUEUE_DEPTH = 500
"""Messages of a topic that may wait: five seconds of a drag at a headset's rate."""

COLLECT_S = 0.05
"""Messages are taken all this long together: once for each would cost the graph the processor's time."""

PREVIEWED = ("path", "trajectory")
"""States that come anew with every move of a hand, each large and replaced by the next."""

PREVIEWS_HZ = 2.0
"""The default: ten minutes of editing stay under 50 MB; what lies between follows from the edits."""

NICENESS = 10
"""The nodes that answer edits go first."""

EXIT_DISK = 1
_LOW_HZ, _HIGH_HZ = 0.5, 50.0


class Recorder(RawCollector):
    """Writes every message of the walkthrough's topics, and the nodes' parameters, to a bag as they come in.

    Attributes:
        failed: Whether the bag could not be written to its end.
    """

    failed = False

    def __init__(self, writer: BagWriter, topics: dict[str, Topic], namespace: str, previews_hz: float = 0.0) -> None:
        """Begins to record.

        Args:
            writer: The bag; closed by whoever made it.
            topics: By full name.
            namespace: Of the nodes.
            previews_hz: How many messages a second of the PREVIEWED topics are kept, the last of each such time; 0 for
                all of them.
        """
        self._writer = writer
        self._thinned = frozenset(absolute_name(t, namespace) for t in PREVIEWED) if previews_hz else frozenset()
        self._topics = {
            name: BagTopic(name=name, type_name=type_name(spec.type), **policies(spec.qos))
            for name, spec in topics.items()
        }
        self._seen: set[str] = set()
        super().__init__("record", topics, depth=QUEUE_DEPTH)
        # From here on: the middleware's own threads, begun above, must take every message in before the next.
        yield_to_others()
        collect_s, flush_s = pace(previews_hz)
        self._spool = Spool(writer, self._stop, flush_s)
        self.create_timer(collect_s, self._take)
        if parameter_watch.TOPIC in topics:
            self._watch = parameter_watch.ParameterWatch(self, namespace, self._take_parameters)
        self.get_logger().info(f"recording {len(topics)} topics to {writer.path}; Ctrl-C ends it")

    def destroy_node(self) -> None:
        """Writes what has come in, then ends the node."""
        try:
            self._take()
        finally:
            self._spool.close()
            super().destroy_node()

    def _take(self) -> None:
        clock = self.get_clock()
        found = self.collect()
        last = {message.topic: message for message in found}
        for message in found:
            topic, data, received_ns = message
            if topic in self._thinned and message is not last[topic]:
                continue
            stamp_ns = clock.now().nanoseconds if clock.ros_time_is_active else received_ns
            self._put(topic, data, stamp_ns)

    def _put(self, topic: str, data: bytes, stamp_ns: int) -> None:
        if topic not in self._seen:
            self._seen.add(topic)
            if self.context.ok():  # what comes with the last messages is written without a word
                self.get_logger().info(f"first of {topic}")
                self._check_type(topic)
        self._spool.put(self._topics[topic], stamp_ns, data)

    def _take_parameters(self, data: bytes) -> None:
        self._take()
        self._put(parameter_watch.TOPIC, data, self.get_clock().now().nanoseconds)

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


def pace(previews_hz: float) -> tuple[float, float]:
    """Returns how long messages are collected and how long they then wait to be flushed, at most [s].

    Together that is FLUSH_S, what a killed recorder may lose, unless previews are rarer.
    """
    collect_s = 1.0 / previews_hz if previews_hz else COLLECT_S
    return collect_s, max(FLUSH_S - collect_s, FLUSH_S / 2)


def yield_to_others() -> None:
    """Lets every other process go before this thread, and before those that it begins from now on."""
    with contextlib.suppress(OSError):
        os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), NICENESS)


def chosen_topics(namespace: str, names: Sequence[str]) -> dict[str, Topic]:
    """Returns the topics to record by full name: those named, or all of the table and the parameters."""
    if names:
        return {absolute_name(name, namespace): TOPICS[name] for name in names}
    return {absolute_name(name, namespace): spec for name, spec in TOPICS.items()} | {
        parameter_watch.TOPIC: parameter_watch.SPEC
    }


def parse(argv: Sequence[str]) -> argparse.Namespace:
    """Returns the options of the command line."""
    parser = argparse.ArgumentParser(
        prog=os.environ.get("WALK_COMMAND", "record"), description="Record a walkthrough as a rosbag2 (MCAP) bag."
    )
    parser.add_argument("--out", type=Path, help="directory, or file ending in .mcap (default: named by the time)")
    parser.add_argument("--namespace", default=NAMESPACE, help="of the nodes (default: %(default)s)")
    parser.add_argument("--topics", nargs="+", default=[], choices=list(TOPICS), help="only these", metavar="TOPIC")
    parser.add_argument(
        "--previews",
        type=float,
        default=PREVIEWS_HZ,
        metavar="HZ",
        help="keep so many paths and trajectories a second, always the last one; 0 keeps all: fifteen times as large "
        "while somebody drags (default: %(default)g)",
    )
    options = parser.parse_args(argv)
    if not (options.previews == 0.0 or _LOW_HZ <= options.previews <= _HIGH_HZ):
        parser.error(f"--previews is {options.previews:g}; expected {_LOW_HZ:g} to {_HIGH_HZ:g} a second, or 0 for all")
    options.out = options.out or Path(f"walkthrough-{datetime.datetime.now():%Y%m%d-%H%M%S}")
    return options


def main(argv: Sequence[str] | None = None) -> int:
    """Records until SIGINT or SIGTERM; returns the exit code."""
    argv = list(sys.argv if argv is None else argv)
    options = parse(user_arguments(argv)[1:])
    made: list[Recorder] = []
    try:
        # Left on every way out of the node, so that the bag is always complete.
        with BagWriter(options.out, keep=True) as writer:

            def factory() -> Recorder:
                topics = chosen_topics(options.namespace, options.topics)
                made.append(Recorder(writer, topics, options.namespace, options.previews))
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
