# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A session recorded from a running graph, cut off, sought in, and played into another graph."""

import numpy as np
import pytest
import rclpy
from graph.processes import EditKind, Graph, Observer, settled
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float64

from walk_bag import read_bag
from walk_bag.parameter_watch import TOPIC as PARAMETERS
from walk_bag.timeline import Timeline
from walk_ros import conversions as c
from walk_ros.raw import from_bytes
from walk_ros.topics import absolute_name

pytestmark = pytest.mark.ros

EDITS = absolute_name("keypoint_edits")


def _decoded(bag, topic):
    name = absolute_name(topic)
    return [(m.stamp_ns, from_bytes(m.data, m.topic.type_name)) for m in read_bag(bag, {name})]


@pytest.fixture(scope="module")
def session(graph, observer, tmp_path_factory):
    """A recording that was killed: two keypoints were moved in it. With the path and keypoints it ended with."""
    bag = tmp_path_factory.mktemp("bags") / "session"
    for name in ("importance", "sequencer", "trajopt"):
        graph.start(name)
    graph.run("record", "walk_bag.record", "--out", str(bag))
    observer.wait_for_all()
    observer.wait(lambda: f"first of {PARAMETERS}\n" in graph.log("record"), "the parameters")
    observer.wait(
        lambda: any(i.node_name == "record" for i in observer.node.get_subscriptions_info_by_topic(EDITS)),
        "the recorder to hear edits",
    )
    before = c.keypoint_markers_from_msg(observer.last("keypoint_markers"))
    for index, shift in ((0, [0.4, 0.3, 0.0]), (1, [-0.3, 0.2, 0.0])):
        goal = before.poses.positions[index] + shift
        assert observer.edit(EditKind.RELEASE, before.ids[index], goal)().outcome is c.Outcome.ACCEPTED
        settled(observer)
    last = observer.last("path")
    observer.wait(lambda: any(m == last for _, m in _decoded(bag, "path")), "the path to be on disk")
    graph.kill("record")
    yield bag, c.path_from_msg(last), c.keypoint_markers_from_msg(observer.last("keypoint_markers"))


def test_a_killed_recorder_leaves_the_session(session):
    bag, path, _ = session
    assert not (bag / "metadata.yaml").exists()
    np.testing.assert_array_equal(c.path_from_msg(_decoded(bag, "path")[-1][1]).positions, path.positions)
    assert len(_decoded(bag, "keypoint_edits")) == 2


def test_the_parameters_of_every_node_are_in_the_bag(session):
    bag, _, _ = session
    events = [from_bytes(m.data, m.topic.type_name) for m in read_bag(bag, {PARAMETERS})]
    told = {e.node: {p.name for p in e.new_parameters} for e in events if len(e.new_parameters) > 5}
    assert {"/walk/importance", "/walk/sequencer", "/walk/trajopt"} <= set(told)
    assert "trajopt.weight_clearance" in told["/walk/trajopt"]


def test_replay_from_a_moment_gives_what_held_then_and_a_clock(session, other_domain, tmp_path):
    bag, _, _ = session
    timeline = Timeline.of(bag)
    paths = _decoded(bag, "path")
    # Between the first path and the first one after an edit.
    at_s = (_decoded(bag, "keypoint_edits")[0][0] - timeline.start_ns) / 1e9 - 0.01
    held = next(msg for stamp, msg in reversed(paths) if stamp < timeline.start_ns + at_s * 1e9)
    graph, listener = Graph(other_domain, tmp_path, ""), Observer(other_domain, "listener")
    clock = []
    listener.node.create_subscription(Clock, "/clock", clock.append, 10)
    seek = listener.node.create_publisher(Float64, absolute_name("replay/seek"), 10)
    try:
        arguments = ["--start", f"{at_s:.3f}", "--rate", "0.05", "--clock", "--delay", "2"]
        graph.run("replay", "walk_bag.replay", str(bag), *arguments)
        listener.wait(lambda: listener.last("path"), "the path that held")
        assert listener.last("path") == held
        assert listener.last("tour") is not None
        listener.wait(lambda: len(clock) > 20, "the clock")
        seconds = [t.clock.sec + t.clock.nanosec / 1e9 for t in clock]
        assert (np.diff(seconds) >= 0).all()
        assert abs(seconds[-1] - timeline.start_ns / 1e9 - at_s) < 2.0
        seek.publish(Float64(data=timeline.duration_s))
        listener.wait(lambda: listener.last("path") == paths[-1][1], "the path at the end")
        assert graph.processes["replay"].wait(20) == 0
    finally:
        listener.close()
        graph.close()


def test_the_edits_played_into_a_fresh_graph_give_the_same_walk(session, rooms, other_domain, tmp_path):
    bag, path, keypoints = session
    graph, listener = Graph(other_domain, tmp_path, rooms), Observer(other_domain, "listener")
    try:
        for name in ("importance", "sequencer", "trajopt"):
            graph.start(name)
        listener.wait_for_all()
        graph.run("replay", "walk_bag.replay", str(bag), "--topics", "keypoint_edits", "--rate", "5", "--delay", "3")
        listener.wait(lambda: len(listener.heard["edit_results"]) >= 2, "both answers")
        now = c.keypoint_markers_from_msg(listener.last("keypoint_markers"))
        listener.wait(
            lambda: np.array_equal(
                c.keypoint_markers_from_msg(listener.last("keypoint_markers")).poses.positions,
                keypoints.poses.positions,
            ),
            "the same keypoints",
        )
        assert now.ids == keypoints.ids
        again = settled(listener)
        assert len(again.positions) == len(path.positions)
        np.testing.assert_allclose(again.positions, path.positions, atol=1e-3)
    finally:
        listener.close()
        graph.close()


def test_a_bag_shorter_than_the_start_is_said(session, capfd):
    bag, _, _ = session
    from walk_bag.replay import main

    assert main(["replay", str(bag), "--start", "100000"]) == 2
    assert "cannot begin at 100000 s" in capfd.readouterr().err
    assert main(["replay", str(bag), "--topics", "nothing"]) == 2
    assert "has no topic /walk/nothing; it has" in capfd.readouterr().err
    assert not rclpy.ok()
