# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Edits other than moving, over real DDS: each is answered, and a new path follows. The tests follow each other."""

import numpy as np
import pytest
from rclpy.qos import QoSProfile
from std_srvs.srv import Trigger
from visualization_msgs.msg import InteractiveMarkerFeedback
from visualization_msgs.srv import GetInteractiveMarkers

from walk_building.pipeline import load_building
from walk_building.sweep import BodySweep
from walk_ros import conversions as c
from walk_ros.topics import absolute_name

pytestmark = pytest.mark.ros


@pytest.fixture(scope="module")
def building(rooms):
    return load_building(rooms)


def keypoints_of(observer):
    return c.keypoint_markers_from_msg(observer.last("keypoint_markers"))


def walked(observer, revision_ns):
    """Waits for the path through the tour of a revision; returns it."""

    def condition():
        tour = observer.last("tour")
        own = c.tour_from_msg(tour).stamp_ns
        told = observer.state("trajopt").get("tour_revision_ns")
        return own == revision_ns and told == str(own)

    observer.wait(condition, "a path through the edited tour")
    return c.path_from_msg(observer.last("path"))


def change(observer, what, keypoint=-1, position=(0.0, 0.0, 0.0), **fields):
    """Publishes a change and waits for its answer."""
    observer.sent += 1
    stamp_ns = 10**18 + observer.sent
    edit = c.KeypointEdit(
        kind=c.EditKind.CHANGE,
        keypoint=keypoint,
        client_id=fields.pop("client", "anna"),
        stamp_ns=fields.pop("stamp_ns", stamp_ns),
        position=np.asarray(position, float),
        quat_xyzw=np.array([0.0, 0.0, 0.0, 1.0]),
        change=what,
        **fields,
    )
    return send(observer, c.edit_to_msg(edit), edit.stamp_ns)


def send(observer, msg, stamp_ns, publisher=None):
    observer.wait(lambda: observer.edits.get_subscription_count() >= 2, "the graph to hear edits")
    heard = len(observer.heard["edit_results"])
    (publisher or observer.edits).publish(msg)

    def find():
        results = map(c.edit_result_from_msg, observer.heard["edit_results"][heard:])
        return next((r for r in results if r.edit_stamp_ns == stamp_ns), None)

    return observer.wait(find, f"the answer to {msg.menu_entry_id}")


def call(observer, name, kind=Trigger, request=None):
    client = observer.node.create_client(kind, absolute_name(name))
    observer.wait(client.service_is_ready, name)
    future = client.call_async(request or kind.Request())
    observer.wait(future.done, f"the answer of {name}")
    observer.node.destroy_client(client)
    return future.result()


def test_insert_delete_and_undo_each_give_a_new_path(running, observer, building):
    sweep = BodySweep(building.geometry, building.walker)
    before = keypoints_of(observer)
    first = walked(observer, before.poses.stamp_ns)
    place = np.array([10.5, 0.8, 1.6])
    result = change(observer, c.Change.INSERT, position=place + [0.0, 0.0, 0.4])
    assert result.outcome is c.Outcome.ACCEPTED
    new = int(result.keypoint)
    path = walked(observer, result.revision_ns)
    assert set(keypoints_of(observer).ids) == {*before.ids, new}
    assert np.linalg.norm(path.positions[:, :2] - place[:2], axis=1).min() < 0.35
    assert sweep.segments_free(path.positions).all()

    result = change(observer, c.Change.DELETE, before.ids[1])
    assert result.outcome is c.Outcome.ACCEPTED
    path = walked(observer, result.revision_ns)
    assert set(keypoints_of(observer).ids) == {*before.ids, new} - {before.ids[1]}
    assert sweep.segments_free(path.positions).all()

    assert call(observer, "undo").success
    result = change(observer, c.Change.UNDO)
    assert result.outcome is c.Outcome.ACCEPTED
    path = walked(observer, result.revision_ns)
    assert keypoints_of(observer).ids == before.ids
    np.testing.assert_array_equal(path.positions, first.positions)

    refused = call(observer, "undo")
    assert not refused.success
    assert "nothing to undo" in refused.message
    assert call(observer, "redo").success
    observer.wait(lambda: new in keypoints_of(observer).ids, "the inserted keypoint")


def test_dwell_and_look_at_reach_the_trajectory(running, observer):
    keypoints = keypoints_of(observer)
    walked(observer, keypoints.poses.stamp_ns)
    quick = c.trajectory_from_msg(observer.last("trajectory"))
    result = change(observer, c.Change.DWELL, keypoints.ids[1], argument="5")
    assert result.outcome is c.Outcome.ACCEPTED
    walked(observer, result.revision_ns)
    slow = observer.wait(
        lambda: (t := c.trajectory_from_msg(observer.last("trajectory"))).t_s[-1] > quick.t_s[-1] + 3.0 and t,
        "a longer walk",
    )
    up = keypoints.poses.positions[1] + [0.0, 0.6, 5.0]
    result = change(observer, c.Change.LOOK_AT, keypoints.ids[1], target=up)
    assert result.outcome is c.Outcome.ACCEPTED
    walked(observer, result.revision_ns)
    observer.wait(
        lambda: (
            not np.array_equal((t := c.trajectory_from_msg(observer.last("trajectory"))).t_s, slow.t_s)
            or not np.array_equal(t.quat_xyzw, slow.quat_xyzw)
        ),
        "another look",
    )
    marks = c.keypoint_marks_from_msg(observer.last("keypoint_markers"))
    assert marks.dwell_s == {keypoints.ids[1]: 5.0}
    np.testing.assert_array_equal(marks.look_at[keypoints.ids[1]], up)


def test_rviz_sees_and_edits_the_keypoints_by_its_own_protocol(running, observer):
    service = "keypoint_editor/get_interactive_markers"
    shown = call(observer, service, GetInteractiveMarkers)
    ids = keypoints_of(observer).ids
    assert {m.name for m in shown.markers} == {str(i) for i in ids}
    assert shown.sequence_number > 0
    feedback = observer.node.create_publisher(
        InteractiveMarkerFeedback, absolute_name("keypoint_editor/feedback"), QoSProfile(depth=100)
    )
    observer.wait(lambda: feedback.get_subscription_count() >= 2, "the graph to hear feedback")
    target = next(m for m in shown.markers if m.name == str(ids[0]))
    heard = len(observer.heard["keypoint_editor/update"])

    def says(stamp, **fields):
        msg = InteractiveMarkerFeedback(client_id="rviz", marker_name=target.name, pose=target.pose, **fields)
        msg.header.frame_id, msg.header.stamp.sec = "map", stamp
        return send(observer, msg, stamp * 10**9, feedback)

    locked = says(1_500_000_000, event_type=InteractiveMarkerFeedback.MENU_SELECT, menu_entry_id=int(c.Change.LOCK))
    assert locked.outcome is c.Outcome.ACCEPTED
    refused = says(1_500_000_001, event_type=InteractiveMarkerFeedback.MOUSE_UP)
    assert "locked" in refused.reason
    updates = observer.heard["keypoint_editor/update"]
    observer.wait(lambda: len(updates) >= heard + 2, "the update and the marker put back")
    assert [m.name for m in updates[heard].markers] == [target.name]
    assert [p.name for p in updates[-1].poses] == [target.name]
    assert [u.seq_num for u in updates[heard:]] == list(range(shown.sequence_number + 1, updates[-1].seq_num + 1))
    new = says(1_500_000_002, event_type=InteractiveMarkerFeedback.MENU_SELECT, menu_entry_id=int(c.Change.INSERT))
    assert new.outcome is c.Outcome.ACCEPTED
    observer.wait(lambda: keypoints_of(observer).ids[1] == int(new.keypoint), "the keypoint half-way")
    late = says(1_400_000_000, event_type=InteractiveMarkerFeedback.MENU_SELECT, menu_entry_id=int(c.Change.UNLOCK))
    assert "stale" in late.reason


def test_a_killed_sequencer_brings_every_kind_of_edit_back(running, observer):
    before, marks = keypoints_of(observer), c.keypoint_marks_from_msg(observer.last("keypoint_markers"))
    points = walked(observer, before.poses.stamp_ns).positions
    running.kill("sequencer")
    heard = len(observer.heard["tour"])
    running.start("sequencer")
    observer.after("tour", heard, "the tour of the new sequencer")
    observer.wait(lambda: keypoints_of(observer).poses.stamp_ns > before.poses.stamp_ns, "its keypoints")
    after = keypoints_of(observer)
    assert after.ids == before.ids
    np.testing.assert_array_equal(after.poses.positions, before.poses.positions)
    again = c.keypoint_marks_from_msg(observer.last("keypoint_markers"))
    assert (again.locked, again.dwell_s) == (marks.locked, marks.dwell_s)
    np.testing.assert_array_equal(walked(observer, after.poses.stamp_ns).positions, points)
    assert call(observer, "undo").success
