# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The executable that publishes a bag again, with the QoS it was recorded with."""

from __future__ import annotations

import argparse
import sys
import threading
from collections.abc import Sequence
from pathlib import Path

from walk_bag.errors import BagError
from walk_bag.storage import BagTopic, read_bag, read_topics
from walk_ros.raw import RawPublisher, message_type, profile
from walk_ros.runner import run_node, user_arguments
from walk_ros.topics import Topic

ACKNOWLEDGE_S = 5.0
"""How long a subscriber may take to acknowledge the last message before the process ends."""


class Replayer(RawPublisher):
    """Publishes the messages of a bag with the times between them that they were recorded with."""

    def __init__(self, options: argparse.Namespace, topics: Sequence[BagTopic]) -> None:
        super().__init__("replay", {t.name: _as_topic(t) for t in topics})
        self._options = options
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name="replay", daemon=True)
        self._thread.start()

    def destroy_node(self) -> None:
        """Ends the replay, then the node."""
        self._ending.set()
        self._thread.join()
        super().destroy_node()

    def _run(self) -> None:
        try:
            self._ending.wait(self._options.delay)
            self.get_logger().info(f"replaying {self._options.bag}; Ctrl-C ends it")
            while not self._ending.is_set():
                self._play()
                if not self._options.loop:
                    break
            if not self._ending.is_set():
                self.wait_until_received(ACKNOWLEDGE_S)
        except BagError as error:
            self.get_logger().error(str(error))
        if self._options.hold:
            self.get_logger().info("at the end; latched topics stay until Ctrl-C")
        else:
            self.end()

    def _play(self) -> None:
        """Publishes the bag once."""
        last_ns, count = None, 0
        for message in read_bag(self._options.bag):
            if last_ns is not None and self._ending.wait((message.stamp_ns - last_ns) / 1e9 / self._options.rate):
                return
            last_ns = message.stamp_ns
            self.send(message.topic.name, message.data)
            count += 1
        self.get_logger().info(f"published {count} messages of {self._options.bag}")


def _as_topic(topic: BagTopic) -> Topic:
    qos = profile(latched=topic.latched, reliable=topic.reliable, depth=topic.depth)
    return Topic(type=message_type(topic.type_name), qos=qos)


def parse(argv: Sequence[str]) -> argparse.Namespace:
    """Returns the options of the command line."""
    parser = argparse.ArgumentParser(prog="replay", description="Publish a recorded walkthrough again.")
    parser.add_argument("bag", type=Path, help="bag directory or .mcap file")
    parser.add_argument("--rate", type=_positive, default=1.0, help="how many times as fast (default: %(default)s)")
    parser.add_argument("--loop", action="store_true", help="begin again at the end, until Ctrl-C")
    parser.add_argument("--hold", action="store_true", help="stay at the end, so that latecomers get latched topics")
    parser.add_argument(
        "--delay", type=_positive, default=0.5, help="seconds for subscribers to be found (default: %(default)s)"
    )
    return parser.parse_args(argv)


def _positive(text: str) -> float:
    value = float(text)
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return value


def main(argv: Sequence[str] | None = None) -> int:
    """Replays the bag; returns the exit code."""
    argv = list(sys.argv if argv is None else argv)
    options = parse(user_arguments(argv)[1:])
    try:
        topics = read_topics(options.bag)
    except BagError as error:
        sys.stderr.write(f"walk: {error}\n")
        return 2
    return run_node(lambda: Replayer(options, topics), argv)


if __name__ == "__main__":
    sys.exit(main())
