# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Replaying: the state at any moment, and when each message is due."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from walk_bag import BagTopic, BagWriter
from walk_bag.pace import Pace
from walk_bag.timeline import Timeline

STAMP = 10**18
TOPICS = {
    "/walk/tour": BagTopic(name="/walk/tour", type_name="nav_msgs/msg/Path", latched=True, reliable=True, depth=1),
    "/walk/storeys": BagTopic(
        name="/walk/storeys", type_name="nav_msgs/msg/OccupancyGrid", latched=True, reliable=True, depth=3
    ),
    "/walk/viewpoint": BagTopic(
        name="/walk/viewpoint", type_name="geometry_msgs/msg/PoseStamped", latched=False, reliable=False, depth=5
    ),
}


@pytest.fixture(scope="module")
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A bag of 60 messages at random moments within a second, whose bytes are their stamps."""
    rng = np.random.default_rng(2)
    path = tmp_path_factory.mktemp("timeline") / "bag"
    with BagWriter(path) as writer:
        for offset in np.sort(rng.choice(10**9, 60, replace=False)).tolist():
            stamp_ns = STAMP + offset
            writer.write(TOPICS[rng.choice(list(TOPICS))], stamp_ns, stamp_ns.to_bytes(8, "little"))
    return path


def test_the_state_at_any_moment_is_what_a_late_subscriber_would_have_got(bag: Path) -> None:
    timeline = Timeline.of(bag)
    everything = list(timeline.messages_from(0))
    rng = np.random.default_rng(3)
    moments = [*rng.integers(STAMP, STAMP + 10**9, 30).tolist(), *(m.stamp_ns for m in everything), 0, 2 * STAMP]
    for moment in moments:
        wanted = []
        for topic in TOPICS.values():
            before = [m for m in everything if m.topic == topic and m.stamp_ns < moment]
            wanted += before[-topic.depth :] if topic.latched else []
        assert timeline.state_at(moment) == sorted(wanted, key=lambda m: m.stamp_ns)
        # And what follows goes on from there, without a gap and without a message twice.
        assert list(timeline.messages_from(moment)) == [m for m in everything if m.stamp_ns >= moment]


def seconds_of(action: Callable[[], object]) -> float:
    began = time.monotonic()
    action()
    return time.monotonic() - began


@pytest.mark.parametrize("rate", [0.5, 1.0, 4.0])
def test_a_message_is_due_when_the_bags_time_is_there(rate: float) -> None:
    pace = Pace(rate)
    assert pace.now_ns() is None
    pace.set_out(STAMP)
    waited = seconds_of(lambda: pace.wait_for(STAMP + 200_000_000))
    assert waited >= 0.2 / rate - 0.01
    now_ns = pace.now_ns()
    assert now_ns is not None and now_ns >= STAMP + 200_000_000
    assert seconds_of(lambda: pace.wait_for(STAMP)) < 0.1, "what is due already is not waited for"


def test_a_held_clock_stands_still_and_goes_on_from_there() -> None:
    pace = Pace(1.0)
    pace.set_out(STAMP)
    pace.hold(True)
    held_ns = pace.now_ns()
    time.sleep(0.05)
    assert pace.now_ns() == held_ns
    came: list[bool] = []
    thread = threading.Thread(target=lambda: came.append(pace.wait_for(STAMP)))
    thread.start()
    time.sleep(0.05)
    assert came == [], "nothing is published while it is held"
    pace.hold(False)
    thread.join(5.0)
    assert came == [True]


def test_seeking_and_ending_let_go_of_who_waits() -> None:
    pace = Pace(1.0)
    pace.set_out(STAMP)
    threading.Timer(0.05, pace.seek, (STAMP + 5,)).start()
    assert pace.wait_for(STAMP + 10**12) is False
    assert (pace.take_sought(), pace.take_sought()) == (STAMP + 5, None)
    threading.Timer(0.05, pace.end).start()
    assert pace.wait_for(STAMP + 10**12) is False
    assert pace.ended
