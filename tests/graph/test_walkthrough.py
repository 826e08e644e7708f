# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""One graph from its start to its end; the tests of this file follow each other."""

import signal

import numpy as np
import pytest
from graph.processes import EditKind, Observer, settled

from walk_bag import read_bag
from walk_building.pipeline import load_building
from walk_building.sweep import BodySweep
from walk_ros import conversions as c
from walk_ros.raw import from_bytes
from walk_ros.topics import BETWEEN_NODES, TOPICS, absolute_name

pytestmark = pytest.mark.ros

LATCHED = [
    "importance_map",
    "importance_map/storeys",
    "suggested_keypoints",
    "keypoints",
    "keypoint_markers",
    "pairwise_paths",
    "tour",
    "path",
    "trajectory",
]


@pytest.fixture(scope="module")
def building(rooms):
    return load_building(rooms)


def keypoints_of(observer):
    return c.keypoint_markers_from_msg(observer.last("keypoint_markers"))


def test_every_topic_is_published_and_sound(running, observer):
    importance_map = c.importance_map_from_msg(observer.last("importance_map"))
    assert importance_map.grid.voxel_size_m == pytest.approx(0.25, abs=1e-3)
    assert len(c.keypoints_from_msg(observer.last("suggested_keypoints")).positions) >= 3
    grid = c.storey_grid_from_msg(observer.last("importance_map/storeys"))
    assert grid.percent.max() <= 100
    legs = c.pairwise_paths_from_msg(observer.last("pairwise_paths"))
    n = len(keypoints_of(observer).ids)
    assert len(legs.legs) == n * (n - 1) // 2
    assert c.trajectory_from_msg(observer.last("trajectory")).t_s[-1] > 1.0


def test_what_the_sequencer_says_is_of_one_revision(running, observer):
    markers = keypoints_of(observer)
    keypoints = c.keypoints_from_msg(observer.last("keypoints"))
    tour = c.tour_from_msg(observer.last("tour"))
    assert keypoints.stamp_ns == markers.poses.stamp_ns == tour.stamp_ns
    np.testing.assert_array_equal(keypoints.positions, markers.poses.positions)
    np.testing.assert_allclose(tour.positions[[0, -1]], keypoints.positions[[0, -1]], atol=0.05)


def test_the_published_path_touches_nothing(running, observer, building):
    path = c.path_from_msg(observer.last("path"))
    assert BodySweep(building.geometry, building.walker).segments_free(path.positions).all()
    assert (np.diff(path.t_s) > 0).all()


def test_a_late_subscriber_gets_the_latched_topics(running, graph):
    late = Observer(graph.domain, "late")
    try:
        late.wait(lambda: all(late.heard[topic] for topic in LATCHED), "the latched topics")
    finally:
        late.close()


def test_diagnostics_tell_state_latency_and_building(running, observer, building):
    for name in ("importance", "sequencer", "trajopt"):
        observer.wait(lambda name=name: observer.state(name).get("state") == "ready", f"{name} to be ready")
        state = observer.state(name)
        assert state["building_hash"] == building.hash
        assert state["level"] == b"\x00"
        assert state["error_code"] == ""
        assert {"solver_status", "dropped_edits"} <= set(state)
    assert float(observer.state("sequencer")["latency_p99_ms"]) > 0


def test_a_drag_is_followed_at_once_and_its_release_is_accepted(running, observer, building):
    before = keypoints_of(observer)
    identity, start = before.ids[1], before.poses.positions[1]
    assert observer.edit(EditKind.GRAB, identity, start)().outcome is c.Outcome.FOLLOWED
    paths = len(observer.heard["path"])
    goal = start + [0.6, 0.4, 0.25]
    observer.edit(EditKind.DRAG, identity, goal)
    dragged = c.path_from_msg(observer.after("path", paths, "the path of the drag"))
    # No revision of the sequencer has come: trajopt did this alone.
    assert keypoints_of(observer).poses.stamp_ns == before.poses.stamp_ns
    assert np.linalg.norm(dragged.positions[:, :2] - goal[:2], axis=1).min() < 0.35
    result = observer.edit(EditKind.RELEASE, identity, goal)()
    assert result.outcome is c.Outcome.ACCEPTED
    observer.wait(lambda: keypoints_of(observer).poses.stamp_ns == result.revision_ns, "the new keypoints")
    after = keypoints_of(observer)
    assert after.ids == before.ids
    np.testing.assert_allclose(after.poses.positions[1], [goal[0], goal[1], start[2]], atol=0.02)
    path = settled(observer)
    assert np.linalg.norm(path.positions[:, :2] - goal[:2], axis=1).min() < 0.35
    assert BodySweep(building.geometry, building.walker).segments_free(path.positions).all()


@pytest.mark.parametrize(
    ("keypoint", "position", "reason"),
    [
        (999, (6.0, 2.0, 1.6), "no keypoint 999"),
        (None, (4.0, 3.0, 1.6), "no room for the walker's body"),
        (None, (6.0, 40.0, 1.6), "no floor"),
    ],
)
def test_an_impossible_edit_is_refused_with_the_reason_and_nothing_changes(
    running, observer, keypoint, position, reason
):
    before = keypoints_of(observer)
    identity = before.ids[1] if keypoint is None else keypoint
    result = observer.edit(EditKind.RELEASE, identity, position)()
    assert result.outcome is c.Outcome.REFUSED
    assert reason in result.reason
    assert keypoints_of(observer).poses.stamp_ns == before.poses.stamp_ns == result.revision_ns


@pytest.mark.parametrize(
    ("spoil", "reason"),
    [
        (lambda m: setattr(m.header, "frame_id", "odom"), "odom"),
        (lambda m: setattr(m.pose.position, "x", float("nan")), "not finite"),
        (lambda m: setattr(m.pose.orientation, "w", 0.0), "norm 0"),
        (lambda m: setattr(m, "event_type", m.BUTTON_CLICK), "event type 3"),
        (lambda m: setattr(m, "event_type", m.MENU_SELECT), "menu entry 0"),
        (lambda m: setattr(m, "marker_name", "door"), "'door' is no keypoint"),
    ],
)
def test_an_unsound_edit_is_refused_with_the_reason(running, observer, spoil, reason):
    result = observer.edit(EditKind.RELEASE, 0, (6.0, 2.0, 1.6), spoil=spoil)()
    assert result.outcome is c.Outcome.REFUSED
    assert reason in result.reason


def test_what_one_editor_holds_another_cannot_move(running, observer):
    before = keypoints_of(observer)
    identity, position = before.ids[0], before.poses.positions[0]
    assert observer.edit(EditKind.GRAB, identity, position)().outcome is c.Outcome.FOLLOWED
    result = observer.edit(EditKind.RELEASE, identity, position, client="bert")()
    assert result.outcome is c.Outcome.REFUSED
    assert "held by 'anna'" in result.reason
    assert observer.edit(EditKind.RELEASE, identity, position)().outcome is c.Outcome.ACCEPTED
    settled(observer)


def test_a_parameter_changes_the_walk_while_it_runs(running, observer):
    slow = c.trajectory_from_msg(observer.last("trajectory")).t_s[-1]
    heard = len(observer.heard["trajectory"])
    assert observer.set_parameter("trajopt", "timing.speed_mps", 2.5).successful
    assert c.trajectory_from_msg(observer.after("trajectory", heard, "a faster walk")).t_s[-1] < slow
    refused = observer.set_parameter("trajopt", "timing.speed_mps", 40.0)
    assert not refused.successful
    assert refused.reason
    heard = len(observer.heard["trajectory"])
    assert observer.set_parameter("trajopt", "timing.speed_mps", 1.4).successful
    observer.after("trajectory", heard, "the walk as before")


@pytest.mark.parametrize("name", ["sequencer", "trajopt", "importance"])
def test_a_killed_node_started_again_picks_up_the_state(running, observer, name):
    own = {"sequencer": ["keypoint_markers", "tour"], "trajopt": ["path"], "importance": ["suggested_keypoints"]}[name]
    before, points = keypoints_of(observer), settled(observer).positions
    suggested = c.keypoints_from_msg(observer.last("suggested_keypoints")).positions
    running.kill(name)
    counts = {topic: len(observer.heard[topic]) for topic in own}
    running.start(name)
    for topic, count in counts.items():
        observer.after(topic, count, f"{topic} of the new {name}")
    after = keypoints_of(observer)
    assert after.ids == before.ids
    np.testing.assert_array_equal(after.poses.positions, before.poses.positions)
    np.testing.assert_array_equal(c.keypoints_from_msg(observer.last("suggested_keypoints")).positions, suggested)
    np.testing.assert_allclose(settled(observer).positions, points, atol=1e-9)


def test_a_recording_holds_what_was_said_and_replays_it(running, observer, other_domain, tmp_path):
    bag = tmp_path / "walk"
    running.run("record", "walk_bag.record", "--out", str(bag))
    observer.wait(lambda: all(f"first of /walk/{t}\n" in running.log("record") for t in LATCHED), "the recorder")
    edits = absolute_name("keypoint_edits")
    observer.wait(
        lambda: any(i.node_name == "record" for i in observer.node.get_subscriptions_info_by_topic(edits)),
        "the recorder to hear edits",
    )
    markers = keypoints_of(observer)
    answer = observer.edit(EditKind.RELEASE, markers.ids[0], markers.poses.positions[0] + [0.1, 0.1, 0.0])
    assert answer().outcome is c.Outcome.ACCEPTED
    settled(observer)
    assert running.interrupt("record") == 0, running.log("record")

    recorded = {}
    for message in read_bag(bag):
        msg = from_bytes(message.data, message.topic.type_name)
        recorded.setdefault(message.topic.name, []).append(msg)
        assert message.topic.latched == (message.topic.name.removeprefix("/walk/") in LATCHED)
    for topic in LATCHED:
        # The newest may have come to one of the two only, when the recorder was told to end.
        assert recorded[absolute_name(topic)][-1] in observer.heard[topic], topic
    assert len(recorded["/walk/keypoint_edits"]) == 1

    listener = Observer(other_domain, "listener")
    try:
        running.run("replay", "walk_bag.replay", str(bag), "--rate", "50", "--hold", domain=other_domain)
        listener.wait(lambda: listener.last("path") == recorded["/walk/path"][-1], "the recorded path")
        listener.wait(lambda: listener.last("trajectory") == recorded["/walk/trajectory"][-1], "the trajectory")
        late = Observer(other_domain, "late")
        late.wait(lambda: late.last("path") == recorded["/walk/path"][-1], "the latched path, late")
        late.close()
    finally:
        listener.close()
    assert running.interrupt("replay") == 0, running.log("replay")


def test_a_building_that_cannot_be_used_is_told_and_another_one_serves(running, observer, rooms, tmp_path):
    bad = tmp_path / "empty.ply"
    bad.write_text("not a building")
    heard = len(observer.heard["importance_map"])
    assert observer.set_parameter("importance", "building", str(bad)).successful
    observer.wait(lambda: observer.state("importance").get("state") == "failed", "the failure")
    state = observer.state("importance")
    assert state["error_code"] == "building_error"
    assert "empty.ply" in state["message"]
    assert state["level"] == b"\x02"
    assert c.importance_map_from_msg(observer.after("importance_map", heard, "an empty map")) is None
    assert "empty.ply" in running.log("importance")
    assert "Traceback" not in running.log("importance")
    assert observer.set_parameter("importance", "building", str(rooms)).successful
    observer.wait(lambda: observer.state("importance").get("state") == "ready", "the good building")


def test_every_node_ends_cleanly(running):
    assert running.interrupt("importance", signal.SIGINT) == 0
    assert running.interrupt("sequencer", signal.SIGINT, times=2) == 0
    assert running.interrupt("trajopt", signal.SIGTERM) == 0
    for name in ("importance", "sequencer", "trajopt"):
        assert "Traceback" not in running.log(name), running.log(name)


def test_the_table_has_every_topic_that_was_heard(running, observer):
    names = {name for name, _ in observer.node.get_topic_names_and_types() if name.startswith("/walk")}
    assert names <= {absolute_name(topic) for topic in TOPICS | BETWEEN_NODES}
