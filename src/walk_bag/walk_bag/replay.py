# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The executable that publishes a bag again, with the QoS it was recorded with."""

from __future__ import annotations

import argparse
import os
import sys
import threading
from collections.abc import Sequence
from pathlib import Path

from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float64
from std_srvs.srv import SetBool

from walk_bag import parameter_watch
from walk_bag.bag_reader import cut_off_note, read_counts, read_topics
from walk_bag.errors import BagError
from walk_bag.pace import Pace
from walk_bag.timeline import Timeline
from walk_bag.topics import BagMessage, BagTopic
from walk_bag.unplayed import account, reason
from walk_ros.errors import ArgumentError
from walk_ros.qos import reliable
from walk_ros.raw import RawPublisher, message_type, profile
from walk_ros.runner import run_node, user_arguments
from walk_ros.topics import NAMESPACE, Topic, absolute_name

ACKNOWLEDGE_S = 5.0
"""How long a subscriber may take to acknowledge the last message before the process ends."""

CLOCK_HZ = 100.0

LOOK_S = 1.0
"""How often others who publish the same are looked for: on a busy machine they are found after some seconds."""

_MEANT_FOR_MANY = ("keypoint_edits", "/diagnostics")
"""Topics that many publish; edits are played into a running graph on purpose."""


class Replayer(RawPublisher):
    """Publishes the messages of a bag with the times between them that they were recorded with.

    While it plays, `replay/seek` (std_msgs/Float64, seconds from the beginning) goes to another moment and
    `replay/pause` (std_srvs/SetBool) holds it.
    """

    def __init__(self, options: argparse.Namespace, timeline: Timeline) -> None:
        super().__init__("replay", {t.name: _as_topic(t) for t in timeline.topics})
        self._options = options
        self._timeline = timeline
        self._pace = Pace(options.rate)
        self._clock_topic = self.create_publisher(Clock, "/clock", reliable(10)) if options.clock else None
        self.create_subscription(Float64, absolute_name("replay/seek", options.namespace), self._seek, reliable(10))
        self.create_service(SetBool, absolute_name("replay/pause", options.namespace), self._pause)
        if options.clock:
            self.create_timer(1 / CLOCK_HZ, self._tell_time)
        self._alone = True
        self._look = self.create_timer(LOOK_S, self._look_for_others)
        self._thread = threading.Thread(target=self._run, name="replay", daemon=True)
        self._thread.start()

    def destroy_node(self) -> None:
        """Ends the replay, then the node."""
        self._pace.end()
        self._thread.join()
        super().destroy_node()

    def _run(self) -> None:
        try:
            self._pace.rest(self._options.delay)
            self.get_logger().info(f"replaying {self._options.bag}, {self._timeline.duration_s:.1f} s; Ctrl-C ends it")
            start_ns = self._timeline.start_ns + round(1e9 * self._options.start)
            while not self._pace.ended:
                self._play(start_ns)
                # Before a round begins again, too: of a latched topic its first message would replace the last one.
                if not self._pace.ended:
                    self.wait_until_received(ACKNOWLEDGE_S)
                if not self._options.loop:
                    break
            self._look_for_others()
        except BagError as error:
            self.get_logger().error(str(error))
        if self._options.hold:
            self.get_logger().info("at the end; latched topics stay until Ctrl-C")
        else:
            self.end()

    def _play(self, start_ns: int) -> None:
        """Publishes the bag once from a moment on, and from another one whenever that is asked for."""
        sought: int | None = start_ns
        while sought is not None and not self._pace.ended:
            from_s = (sought - self._timeline.start_ns) / 1e9
            state = self._timeline.state_at(sought)
            for message in state:
                self.send(message.topic.name, message.data)
            self._pace.set_out(sought)
            count = len(state)
            for message in self._timeline.messages_from(sought):
                if not self._pace.wait_for(message.stamp_ns):
                    said = f"published {count} messages up to where it was ended or sent elsewhere"
                    break
                self._publish(message)
                count += 1
            else:
                said = self._account(count, from_s)
            sought = self._pace.take_sought()
            self.get_logger().info(f"{self._options.bag}: {said}")

    def _account(self, count: int, from_s: float) -> str:
        played = {topic.name for topic in self._timeline.topics}
        topics = {
            topic.name: reason(topic.name, topic.type_name, _installed(topic), not self._options.topics)
            for topic in read_topics(self._options.bag)
            if topic.name not in played
        }
        return account(count, read_counts(self._options.bag), topics, from_s)

    def _look_for_others(self) -> None:
        """Warns, once, of nodes that publish what is played: whoever listens would hear both."""
        many = {absolute_name(name, self._options.namespace) for name in _MEANT_FOR_MANY}
        shared, nodes = [], set()
        for topic in self._timeline.topics:
            found = self.get_publishers_info_by_topic(topic.name) if topic.name not in many else []
            if len(found) > 1:
                shared.append(topic.name)
                nodes |= {f"{one.node_namespace.rstrip('/')}/{one.node_name}" for one in found}
        if not shared or not self._alone:
            return
        self._alone = False
        self._look.cancel()
        others = sorted(nodes - {self.get_fully_qualified_name()}) or ["another replay"]
        more = f" and {len(shared) - 1} more of its topics" if len(shared) > 1 else ""
        self.get_logger().warning(
            f"{shared[0]}{more} are published by {', '.join(others)} as well, and listeners hear both: end that graph, "
            "or replay in a ROS domain of its own, such as ROS_DOMAIN_ID=7"
        )

    def _publish(self, message: BagMessage) -> None:
        self._tell_time()
        self.send(message.topic.name, message.data)

    def _tell_time(self) -> None:
        now_ns = self._pace.now_ns()
        if self._clock_topic is not None and now_ns is not None and self.context.ok():
            msg = Clock()
            msg.clock.sec, msg.clock.nanosec = divmod(now_ns, 1_000_000_000)
            self._clock_topic.publish(msg)

    def _seek(self, msg: Float64) -> None:
        if not 0 <= msg.data <= self._timeline.duration_s:
            self.get_logger().warning(
                f"replay/seek: {msg.data} s is not within the bag's 0 to {self._timeline.duration_s:.1f} s"
            )
            return
        self._pace.seek(self._timeline.start_ns + round(1e9 * msg.data))

    def _pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        self._pace.hold(request.data)
        response.success, response.message = True, "paused" if request.data else "playing"
        return response


def _as_topic(topic: BagTopic) -> Topic:
    qos = profile(latched=topic.latched, reliable=topic.reliable, depth=topic.depth)
    return Topic(type=message_type(topic.type_name), qos=qos)


def parse(argv: Sequence[str]) -> argparse.Namespace:
    """Returns the options of the command line."""
    parser = argparse.ArgumentParser(
        prog=os.environ.get("WALK_COMMAND", "replay"), description="Publish a recorded walkthrough again."
    )
    parser.add_argument("bag", type=Path, help="bag directory or .mcap file")
    parser.add_argument("--rate", type=_positive, default=1.0, help="how many times as fast (default: %(default)s)")
    parser.add_argument(
        "--start", type=_not_negative, default=0.0, help="seconds to begin at; latched topics have what held then"
    )
    parser.add_argument("--loop", action="store_true", help="begin again at the end, until Ctrl-C")
    parser.add_argument("--hold", action="store_true", help="stay at the end, so that latecomers get latched topics")
    parser.add_argument("--clock", action="store_true", help="publish the bag's time on /clock, for use_sim_time")
    parser.add_argument("--topics", nargs="+", metavar="TOPIC", help="only these, such as keypoint_edits")
    parser.add_argument("--namespace", default=NAMESPACE, help="that --topics are relative to (default: %(default)s)")
    parser.add_argument(
        "--delay", type=_positive, default=0.5, help="seconds for subscribers to be found (default: %(default)s)"
    )
    return parser.parse_args(argv)


def _positive(text: str) -> float:
    value = float(text)
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return value


def _not_negative(text: str) -> float:
    value = float(text)
    if not 0 <= value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text} is not 0 or above")
    return value


def chosen(options: argparse.Namespace) -> Timeline:
    """Returns the part of the bag that is to be played.

    Raises:
        BagError: The bag cannot be read, or does not have what is asked for.
    """
    names = {absolute_name(name, options.namespace) for name in options.topics or ()}
    # Parameter events are kept to be read: published again they would speak for nodes that are not there.
    timeline = Timeline.of(options.bag, names or _playable(options.bag) - {parameter_watch.TOPIC})
    missing = names - {topic.name for topic in timeline.topics}
    if missing:
        has = ", ".join(sorted(topic.name for topic in Timeline.of(options.bag).topics))
        raise BagError(options.bag, f"has no topic {', '.join(sorted(missing))}; it has {has}")
    foreign = [topic for topic in timeline.topics if not _installed(topic)]
    if foreign:
        raise BagError(options.bag, f"{foreign[0].name} cannot be played: {foreign[0].type_name} is not installed")
    if options.start > timeline.duration_s:
        raise BagError(options.bag, f"is {timeline.duration_s:.1f} s long: it cannot begin at {options.start:g} s")
    return timeline


def _playable(bag: Path) -> set[str]:
    """Returns the topics of a bag whose types are installed; says which are not. `ros2 bag record -a` takes all."""
    names = set()
    for topic in read_topics(bag):
        if _installed(topic):
            names.add(topic.name)
        else:
            sys.stderr.write(f"walk: {topic.name} is left out: its type, {topic.type_name}, is not installed\n")
    return names


def _installed(topic: BagTopic) -> bool:
    try:
        message_type(topic.type_name)
    except ArgumentError:
        return False
    return True


def main(argv: Sequence[str] | None = None) -> int:
    """Replays the bag; returns the exit code."""
    argv = list(sys.argv if argv is None else argv)
    options = parse(user_arguments(argv)[1:])
    try:
        timeline = chosen(options)
    except BagError as error:
        sys.stderr.write(f"walk: {error}\n")
        return 2
    if note := cut_off_note(options.bag):
        sys.stderr.write(f"walk: {note}\n")
    return run_node(lambda: Replayer(options, timeline), argv)


if __name__ == "__main__":
    sys.exit(main())
