# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A session recorded from a running graph, cut off, sought in, and played into another graph."""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
import rclpy
from graph.processes import EditKind, Graph, Observer, settled
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float64

from walk_bag import BagWriter, read_bag
from walk_bag.parameter_watch import TOPIC as PARAMETERS
from walk_bag.timeline import Timeline
from walk_bag.walkthrough import bag_topic
from walk_ros import conversions as c
from walk_ros.raw import from_bytes, to_bytes
from walk_ros.topics import absolute_name

pytestmark = pytest.mark.ros

EDITS = absolute_name("keypoint_edits")


class Session(NamedTuple):
    """A recording and what it ended with."""

    bag: Path
    edits: int
    path: Any
    keypoints: Any
    marks: Any


def _decoded(bag, topic):
    name = absolute_name(topic)
    return [(m.stamp_ns, from_bytes(m.data, m.topic.type_name)) for m in read_bag(bag, {name})]


def _change(observer, what, keypoint=-1, position=(0.0, 0.0, 0.0), argument=""):
    """Publishes a change and waits for its answer; returns the keypoint that it is about."""
    observer.sent += 1
    edit = c.KeypointEdit(
        kind=EditKind.CHANGE,
        keypoint=keypoint,
        client_id="anna",
        stamp_ns=10**18 + observer.sent,
        position=np.asarray(position, float),
        quat_xyzw=np.array([0.0, 0.0, 0.0, 1.0]),
        change=what,
        argument=argument,
    )
    observer.edits.publish(c.edit_to_msg(edit))

    def find():
        results = map(c.edit_result_from_msg, observer.heard["edit_results"])
        return next((r for r in results if r.edit_stamp_ns == edit.stamp_ns), None)

    result = observer.wait(find, f"the answer to {what}")
    assert result.outcome is c.Outcome.ACCEPTED, result.reason
    return result.keypoint


def _edit(observer):
    """Edits of every kind; returns how many."""
    before = c.keypoint_markers_from_msg(observer.last("keypoint_markers"))
    sent, one, two = observer.sent, before.ids[0], before.ids[1]
    observer.edit(EditKind.GRAB, one, before.poses.positions[0])()
    for step in range(1, 6):
        observer.edit(EditKind.DRAG, one, before.poses.positions[0] + np.array([0.08, 0.06, 0.0]) * step)()
    for index, shift in ((0, [0.4, 0.3, 0.0]), (1, [-0.3, 0.2, 0.0])):
        goal = before.poses.positions[index] + shift
        assert observer.edit(EditKind.RELEASE, before.ids[index], goal)().outcome is c.Outcome.ACCEPTED
        settled(observer)
    new = _change(observer, c.Change.INSERT, position=(10.5, 0.8, 1.6))
    _change(observer, c.Change.LOCK, int(new))
    _change(observer, c.Change.DWELL, two, argument="2.5")
    _change(observer, c.Change.DELETE, before.ids[2])
    _change(observer, c.Change.UNDO)
    settled(observer)
    _change(observer, c.Change.REORDER, two, argument="first")
    _change(observer, c.Change.UNDO)
    _change(observer, c.Change.REDO)
    settled(observer)
    return observer.sent - sent


@pytest.fixture(scope="module")
def session(graph, observer, tmp_path_factory):
    """A recording of edits of every kind that was killed. With the path and keypoints it ended with."""
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
    # Of the paths of half a second the last is kept: the first one must not fall together with that of an edit.
    observer.wait(lambda: _decoded(bag, "path"), "the first path to be on disk")
    edits = _edit(observer)
    last = observer.last("path")
    observer.wait(lambda: any(m == last for _, m in _decoded(bag, "path")), "the path to be on disk")
    graph.kill("record")
    yield Session(
        bag=bag,
        edits=edits,
        path=c.path_from_msg(last),
        keypoints=c.keypoint_markers_from_msg(observer.last("keypoint_markers")),
        marks=c.keypoint_marks_from_msg(observer.last("keypoint_markers")),
    )


def test_a_killed_recorder_leaves_the_session(session):
    assert not (session.bag / "metadata.yaml").exists()
    kept = c.path_from_msg(_decoded(session.bag, "path")[-1][1])
    np.testing.assert_array_equal(kept.positions, session.path.positions)
    assert len(_decoded(session.bag, "keypoint_edits")) == session.edits


def test_the_parameters_of_every_node_are_in_the_bag(session):
    bag = session.bag
    events = [from_bytes(m.data, m.topic.type_name) for m in read_bag(bag, {PARAMETERS})]
    told = {e.node: {p.name for p in e.new_parameters} for e in events if len(e.new_parameters) > 5}
    assert {"/walk/importance", "/walk/sequencer", "/walk/trajopt"} <= set(told)
    assert "trajopt.weight_clearance" in told["/walk/trajopt"]


def test_replay_from_a_moment_gives_what_held_then_and_a_clock(session, other_domain, tmp_path):
    bag = session.bag
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
        log = graph.log("replay")
        assert "messages; not " in log and f"on {PARAMETERS} (it would speak for nodes that are not there)" in log
        assert "which held no longer" in log and "as well, and listeners hear both" not in log
    finally:
        listener.close()
        graph.close()


def test_a_replay_beside_the_graph_that_publishes_the_same_is_said(session, graph, observer):
    graph.run("replay", "walk_bag.replay", str(session.bag), "--topics", "tour", "path", "--rate", "100")
    assert graph.processes["replay"].wait(60) == 0
    (line,) = (line for line in graph.log("replay").splitlines() if "listeners hear both" in line)
    assert "/walk/sequencer, /walk/trajopt as well" in line and "and 1 more of its topics" in line
    assert f"on {PARAMETERS} (not among --topics)" in graph.log("replay")


def test_the_edits_played_into_a_fresh_graph_give_the_same_walk(session, rooms, other_domain, tmp_path):
    bag, path, keypoints = session.bag, session.path, session.keypoints
    graph, listener = Graph(other_domain, tmp_path, rooms), Observer(other_domain, "listener")
    try:
        for name in ("importance", "sequencer", "trajopt"):
            graph.start(name)
        listener.wait_for_all()
        graph.run("replay", "walk_bag.replay", str(bag), "--topics", "keypoint_edits", "--rate", "5", "--delay", "3")
        listener.wait(lambda: len(listener.heard["edit_results"]) >= session.edits, "all answers")
        listener.wait(
            lambda: np.array_equal(
                c.keypoint_markers_from_msg(listener.last("keypoint_markers")).poses.positions,
                keypoints.poses.positions,
            ),
            "the same keypoints",
        )
        assert c.keypoint_markers_from_msg(listener.last("keypoint_markers")).ids == keypoints.ids
        marks = c.keypoint_marks_from_msg(listener.last("keypoint_markers"))
        assert (marks.locked, marks.dwell_s) == (session.marks.locked, session.marks.dwell_s)
        assert "listeners hear both" not in graph.log("replay")
        again = settled(listener)
        assert len(again.positions) == len(path.positions)
        np.testing.assert_allclose(again.positions, path.positions, atol=1e-6)
    finally:
        listener.close()
        graph.close()


def test_a_loop_begins_again_at_the_start_and_the_clock_with_it(other_domain, tmp_path):
    """Three tours, 0.4 s from the first to the last, played at twice the speed from the second on."""
    stamps = [10**18, 10**18 + 200_000_000, 10**18 + 400_000_000]
    with BagWriter(tmp_path / "bag") as writer:
        for number, stamp_ns in enumerate(stamps):
            msg = c.tour_to_msg(np.array([[float(number), 0.0, 1.6], [5.0, 0.0, 1.6]]), stamp_ns)
            writer.write(bag_topic("tour"), stamp_ns, to_bytes(msg))
    graph, listener = Graph(other_domain, tmp_path, ""), Observer(other_domain, "listener")
    clock = []
    listener.node.create_subscription(Clock, "/clock", clock.append, 100)
    try:
        arguments = ["--loop", "--rate", "2", "--start", "0.1", "--clock", "--delay", "2"]
        graph.run("replay", "walk_bag.replay", str(tmp_path / "bag"), *arguments)
        listener.wait(lambda: len(listener.heard["tour"]) >= 10, "three rounds and a half")
        assert graph.interrupt("replay") == 0, graph.log("replay")
    finally:
        listener.close()
        graph.close()
    # Every round begins with the state that held at 0.1 s: the first tour.
    heard = [int(m.poses[0].pose.position.x) for m in listener.heard["tour"]]
    assert heard[:9] == [0, 1, 2] * 3
    times = np.array([t.clock.sec + t.clock.nanosec / 1e9 for t in clock]) - stamps[0] / 1e9
    assert (times > 0.09).all() and (times < 0.6).all()
    assert 2 <= np.count_nonzero(np.diff(times) < -0.1) <= 4, "the clock goes back once a round"


def test_a_bag_shorter_than_the_start_is_said(session, capfd):
    bag = session.bag
    from walk_bag.replay import main

    assert main(["replay", str(bag), "--start", "100000"]) == 2
    assert "cannot begin at 100000 s" in capfd.readouterr().err
    assert main(["replay", str(bag), "--topics", "nothing"]) == 2
    assert "has no topic /walk/nothing; it has" in capfd.readouterr().err
    assert not rclpy.ok()
