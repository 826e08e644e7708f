# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What is sent arrives: every pair of conversions, over the real serialisation."""

from types import SimpleNamespace

import numpy as np
import pytest
from sensor_msgs.msg import PointField

from walk_ros import conversions as c
from walk_ros.conversions.cdr import path_to_bytes, trajectory_to_bytes
from walk_ros.conversions.legs_cdr import pairwise_paths_to_bytes
from walk_ros.conversions.paths import headings
from walk_ros.raw import from_bytes, to_bytes
from walk_ros.results import stand_bytes, stand_messages
from walk_ros.topics import type_name

STAMP = 1_700_000_000_123_456_789


def over_the_wire(msg):
    return from_bytes(to_bytes(msg), type_name(type(msg)))


def test_stamps_are_exact_to_the_nanosecond():
    for stamp in (0, 1, 999_999_999, 1_000_000_000, STAMP):
        assert c.stamp_from_msg(c.stamp_to_msg(stamp)) == stamp


def test_keypoints_arrive_as_sent(rng, quats):
    positions, quat = rng.normal(size=(6, 3)), quats(6)
    got = c.keypoints_from_msg(over_the_wire(c.keypoints_to_msg(positions, quat, STAMP)))
    assert got.stamp_ns == STAMP
    np.testing.assert_array_equal(got.positions, positions)
    np.testing.assert_array_equal(got.quat_xyzw, quat)


def test_no_keypoints_arrive_as_none():
    got = c.keypoints_from_msg(over_the_wire(c.keypoints_to_msg(np.empty((0, 3)), np.empty((0, 4)), STAMP)))
    assert got.positions.shape == (0, 3)
    assert got.quat_xyzw.shape == (0, 4)


def test_viewpoint_arrives_as_sent(rng, quats):
    got = c.viewpoint_from_msg(over_the_wire(c.viewpoint_to_msg([1.0, 2.0, 3.0], quats(1)[0], STAMP)))
    np.testing.assert_array_equal(got.positions, [[1.0, 2.0, 3.0]])
    assert got.stamp_ns == STAMP


def test_importance_map_arrives_as_sent(importance_map):
    got = c.importance_map_from_msg(over_the_wire(c.importance_map_to_msg(importance_map, STAMP)))
    assert got.stamp_ns == STAMP
    assert got.grid.shape == importance_map.grid.shape
    np.testing.assert_allclose(got.grid.origin, importance_map.grid.origin, atol=1e-6)
    assert got.grid.voxel_size_m == pytest.approx(0.25)
    for name in ("obstacle", "distance", "visibility", "importance"):
        np.testing.assert_array_equal(getattr(got, name), getattr(importance_map, name))


def test_importance_cloud_runs_x_fastest_then_y_then_z(importance_map):
    msg = c.importance_map_to_msg(importance_map, STAMP)
    table = np.frombuffer(bytes(msg.data), np.float32).reshape(-1, 7)
    nx, ny, _ = importance_map.grid.shape
    for row, (i, j, k) in enumerate([(0, 0, 0), (1, 0, 0), (2, 0, 0)]):
        assert table[row, 6] == importance_map.importance[i, j, k]
    assert table[nx, 6] == importance_map.importance[0, 1, 0]
    assert table[nx * ny, 6] == importance_map.importance[0, 0, 1]
    np.testing.assert_allclose(table[0, :3], [-1 + 0.125, 2 + 0.125, 0.5 + 0.125])
    assert [f.name for f in msg.fields] == ["x", "y", "z", "obstacle", "distance", "visibility", "importance"]
    assert {f.datatype for f in msg.fields} == {PointField.FLOAT32}


def test_empty_map_is_stamped_and_names_its_fields():
    msg = over_the_wire(c.importance_map_to_msg(None, STAMP))
    assert c.importance_map_from_msg(msg) is None
    assert c.stamp_from_msg(msg.header.stamp) == STAMP
    assert len(msg.fields) == 7


def test_storey_grid_arrives_as_sent(rng):
    percent = rng.integers(-1, 101, size=(6, 3)).astype(np.int8)
    grid = c.StoreyGrid(origin=np.array([1.0, -2.0, 3.2]), cell_m=0.25, percent=percent)
    got = c.storey_grid_from_msg(over_the_wire(c.storey_grid_to_msg(grid, STAMP)))
    np.testing.assert_array_equal(got.percent, percent)
    np.testing.assert_array_equal(got.origin, grid.origin)
    assert got.cell_m == 0.25


def test_storey_grid_is_the_layer_at_eye_height(importance_map):
    # Layers are centred at 0.625, 0.875 and 1.125 m: an eye at 0.9 m is in the second.
    grid = c.storey_grid(importance_map, floor_z=0.1, eye_height_m=0.8)
    free = importance_map.obstacle[:, :, 1] < 0.5
    assert (grid.percent[~free] == -1).all()
    assert (grid.percent[free] >= 0).all()
    best = np.where(importance_map.obstacle < 0.5, importance_map.importance, -np.inf)
    order = np.argsort(best[:, :, 1][free], kind="stable")
    assert (np.diff(grid.percent[free][order].astype(int)) >= 0).all()
    assert grid.origin[2] == 0.1


def test_storey_above_the_map_is_all_unknown(importance_map):
    assert (c.storey_grid(importance_map, floor_z=50.0, eye_height_m=1.6).percent == -1).all()


def test_path_arrives_with_its_arrival_times(trajectory):
    msg = c.path_to_msg(trajectory.t_s, trajectory.positions, trajectory.quat_xyzw, STAMP)
    got = c.path_from_msg(over_the_wire(msg))
    np.testing.assert_allclose(got.t_s, trajectory.t_s, atol=1e-9)
    np.testing.assert_array_equal(got.positions, trajectory.positions)
    np.testing.assert_array_equal(got.quat_xyzw, trajectory.quat_xyzw)
    assert {p.header.frame_id for p in msg.poses} == {"map"}


def test_tour_looks_along_itself(rng):
    points = rng.normal(size=(9, 3))
    got = c.tour_from_msg(over_the_wire(c.tour_to_msg(points, STAMP)))
    np.testing.assert_array_equal(got.positions, points)
    assert (got.t_s == 0).all()
    z, w = got.quat_xyzw[:, 2], got.quat_xyzw[:, 3]
    yaw = 2 * np.arctan2(z, w)[:-1]
    step = np.diff(points, axis=0)
    np.testing.assert_allclose(np.cos(yaw - np.arctan2(step[:, 1], step[:, 0])), 1.0, atol=1e-12)


def test_headings_pass_over_repeated_points():
    points = np.array([[0.0, 0, 0], [0, 0, 0], [0, 1, 0], [0, 1, 2], [0, 2, 2]])
    yaw = 2 * np.arctan2(*headings(points)[:, 2:].T)
    np.testing.assert_allclose(yaw, np.pi / 2)


@pytest.mark.parametrize("n", [0, 1])
def test_shortest_tours_are_converted(n):
    points = np.ones((n, 3))
    assert len(c.tour_from_msg(c.tour_to_msg(points, STAMP)).positions) == n


def test_trajectory_arrives_as_sent(trajectory):
    got = c.trajectory_from_msg(over_the_wire(c.trajectory_to_msg(trajectory, STAMP)))
    np.testing.assert_allclose(got.t_s, trajectory.t_s, atol=1e-9)
    for name in ("positions", "velocities", "accelerations", "quat_xyzw"):
        np.testing.assert_array_equal(getattr(got, name), getattr(trajectory, name))


def test_markers_keep_identity_label_and_index(rng, quats):
    positions, quat = rng.normal(size=(3, 3)), quats(3)
    left_out = [(9, np.array([1.0, 2.0, 3.0]), "on the roof")]
    msg = c.keypoint_markers_to_msg(
        positions, quat, [4, 7, 2], ["hall", "", "kitchen"], STAMP, left_out=left_out, removed=[1]
    )
    assert [m.id for m in msg.markers[:3]] == [4, 7, 2]
    got = c.keypoint_markers_from_msg(over_the_wire(msg))
    assert got.ids == (4, 7, 2)
    assert got.labels == ("hall", "", "kitchen")
    assert got.left_out == ((9, "on the roof"),)
    np.testing.assert_array_equal(got.poses.positions, positions)


def test_empty_markers_still_carry_the_revision():
    msg = c.keypoint_markers_to_msg(np.empty((0, 3)), np.empty((0, 4)), [], [], STAMP)
    got = c.keypoint_markers_from_msg(over_the_wire(msg))
    assert got.ids == ()
    assert got.poses.stamp_ns == STAMP


def test_legs_arrive_with_their_pair_and_length(rng):
    legs = [
        SimpleNamespace(start=0, goal=2, points=rng.normal(size=(4, 3)), length_m=12.345678901234567),
        SimpleNamespace(start=1, goal=2, points=rng.normal(size=(2, 3)), length_m=0.5),
    ]
    msg = c.pairwise_paths_to_msg(legs, [10, 11, 12], STAMP, no_way=[(0, 1, "no stairs: not joined")])
    got = c.pairwise_paths_from_msg(over_the_wire(msg))
    assert [(g.start, g.goal, g.length_m) for g in got.legs] == [(10, 12, legs[0].length_m), (11, 12, 0.5)]
    np.testing.assert_array_equal(got.legs[0].points, legs[0].points)
    assert got.no_way == ((10, 11, "no stairs: not joined"),)


@pytest.mark.parametrize("kind", [kind for kind in c.EditKind if kind is not c.EditKind.CHANGE])
def test_edit_arrives_as_sent(kind, quats):
    edit = c.KeypointEdit(
        kind=kind, keypoint=3, client_id="anna", stamp_ns=STAMP, position=np.arange(3.0), quat_xyzw=quats(1)[0]
    )
    got = c.edit_from_msg(over_the_wire(c.edit_to_msg(edit)))
    assert (got.kind, got.keypoint, got.client_id, got.stamp_ns) == (kind, 3, "anna", STAMP)
    np.testing.assert_array_equal(got.position, edit.position)
    np.testing.assert_array_equal(got.quat_xyzw, edit.quat_xyzw)


@pytest.mark.parametrize("change", list(c.Change))
def test_change_arrives_as_sent(change, quats):
    arguments = {c.Change.REORDER: "first", c.Change.DWELL: "2.5", c.Change.INSERT: "half-way"}
    target = np.array([1.0, 2.0, 3.0]) if change is c.Change.LOOK_AT else None
    edit = c.KeypointEdit(
        kind=c.EditKind.CHANGE,
        keypoint=-1 if change in (c.Change.INSERT, c.Change.INSERT_NEAR, c.Change.UNDO, c.Change.REDO) else 3,
        client_id="anna",
        stamp_ns=STAMP,
        position=np.arange(3.0),
        quat_xyzw=quats(1)[0],
        change=change,
        argument=arguments.get(change, ""),
        target=target,
    )
    got = c.edit_from_msg(over_the_wire(c.edit_to_msg(edit)))
    assert (got.kind, got.change, got.argument) == (c.EditKind.CHANGE, change, edit.argument)
    assert (got.keypoint, got.client_id, got.stamp_ns) == (edit.keypoint, "anna", STAMP)
    assert (got.target is None) == (target is None)
    if target is not None:
        np.testing.assert_array_equal(got.target, target)
    if change in (c.Change.INSERT, c.Change.INSERT_NEAR):
        np.testing.assert_array_equal(got.position, edit.position)


def test_marks_of_keypoints_arrive_as_sent(quats):
    marks = c.KeypointMarks(
        look_at={4: np.array([1 / 3, 2.0, 3.0])}, dwell_s={4: 2.5, 7: 0.0}, locked=frozenset({7}), start=7, end=4
    )
    eyes = {4: np.zeros(3), 7: np.ones(3)}
    msg = c.keypoint_markers_to_msg(np.zeros((2, 3)), quats(2), [4, 7], ["", "hall"], STAMP)
    msg.markers += c.keypoint_marks_to_msgs(marks, eyes, STAMP, shown={("locked", 4), ("dwell", 7)})
    wired = over_the_wire(msg)
    got = c.keypoint_marks_from_msg(wired)
    np.testing.assert_array_equal(got.look_at.pop(4), marks.look_at[4])
    assert (got.look_at, got.dwell_s, got.locked, got.start, got.end) == ({}, marks.dwell_s, frozenset({7}), 7, 4)
    # They do not get in the way of the keypoints themselves, and what is gone is taken away.
    assert c.keypoint_markers_from_msg(wired).ids == (4, 7)
    assert [(m.ns, m.id) for m in wired.markers if m.action == m.DELETE] == [("locked", 4)]


@pytest.mark.parametrize("outcome", list(c.Outcome))
def test_edit_result_arrives_as_sent(outcome):
    reason = "inside a wall" if outcome is c.Outcome.REFUSED else ""
    result = c.EditResult(
        outcome=outcome,
        keypoint="3",
        client_id="anna",
        reason=reason,
        revision_ns=STAMP,
        edit_stamp_ns=5,
        better_order_saves_m=1.25,
    )
    assert c.edit_result_from_msg(over_the_wire(c.edit_result_to_msg(result))) == result


@pytest.mark.parametrize("count", [0, 1, 9])
@pytest.mark.parametrize("reasons", [[], ["no stairs"], ["ä", "", "four"]])
def test_legs_written_in_place_are_the_same_message(count, reasons):
    rng = np.random.default_rng(count)
    legs = [
        SimpleNamespace(start=0, goal=k, points=rng.normal(size=(k % 4, 3)), length_m=10.0 ** (k - 3) / 3)
        for k in range(count)
    ]
    ids = [3, *(10**k for k in range(9))]
    arguments = (legs, ids, STAMP, [(k, 0, reason) for k, reason in enumerate(reasons)])
    msg = from_bytes(pairwise_paths_to_bytes(*arguments), "visualization_msgs/msg/MarkerArray")
    assert msg == over_the_wire(c.pairwise_paths_to_msg(*arguments))


@pytest.mark.parametrize("rows", [0, 1, 2, 17])
def test_bytes_written_in_place_are_the_same_messages(trajectory, rows):
    few = SimpleNamespace(**{name: values[:rows] for name, values in vars(trajectory).items()})
    walk = (few.t_s, few.positions, few.quat_xyzw, STAMP)
    assert from_bytes(path_to_bytes(*walk), "nav_msgs/msg/Path") == c.path_to_msg(*walk)
    kind = "trajectory_msgs/msg/MultiDOFJointTrajectory"
    assert from_bytes(trajectory_to_bytes(few, STAMP), kind) == c.trajectory_to_msg(few, STAMP)
    assert len(path_to_bytes(*walk)) == len(to_bytes(c.path_to_msg(*walk)))
    assert len(trajectory_to_bytes(few, STAMP)) == len(to_bytes(c.trajectory_to_msg(few, STAMP)))


@pytest.mark.parametrize("rows", [1, 2, 17])
def test_a_revision_with_its_tour_as_bytes_is_the_same_messages(rows):
    rng = np.random.default_rng(rows)
    eyes, quat = rng.normal(size=(2, 3)), np.tile([0.0, 0.0, 0.0, 1.0], (2, 1))
    tour = SimpleNamespace(order=[1, 0], stands=eyes, unreachable=[], polyline=rng.normal(size=(rows, 3)))
    arguments = (tour, eyes, quat, (4, 7), ("hall", ""), STAMP, (9,))
    messages, written = dict(stand_messages(*arguments)), dict(stand_bytes(*arguments))
    assert from_bytes(written.pop("tour"), "nav_msgs/msg/Path") == messages.pop("tour")
    assert written == messages
