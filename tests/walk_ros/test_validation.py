# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Nothing unsound passes a conversion: it is refused with a reason, whatever comes in."""

import array

import numpy as np
import pytest
from geometry_msgs.msg import Point, Pose, PoseArray, PoseStamped, Quaternion
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from std_msgs.msg import Header
from visualization_msgs.msg import InteractiveMarkerFeedback, MarkerArray

from walk_ros import conversions as c
from walk_ros.errors import MessageError

STAMP = 1_700_000_000_000_000_000
ANY = st.floats(allow_nan=True, allow_infinity=True, width=64)
FEW = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])


def pose(x=0.0, y=0.0, z=0.0, quat=(0.0, 0.0, 0.0, 1.0)):
    return Pose(position=Point(x=x, y=y, z=z), orientation=Quaternion(x=quat[0], y=quat[1], z=quat[2], w=quat[3]))


@FEW
@given(st.lists(st.tuples(ANY, ANY, ANY, ANY, ANY, ANY, ANY), max_size=4), st.sampled_from(["map", "", "odom"]))
def test_keypoints_are_sound_or_refused(rows, frame):
    msg = PoseArray(header=Header(frame_id=frame), poses=[pose(*r[:3], quat=r[3:]) for r in rows])
    try:
        got = c.keypoints_from_msg(msg)
    except MessageError as error:
        assert "PoseArray" in str(error)
        assert error.reason
        return
    assert frame == "map"
    assert np.isfinite(got.positions).all()
    np.testing.assert_allclose(np.linalg.norm(got.quat_xyzw, axis=1), 1.0, atol=1e-9)


@pytest.mark.parametrize("quat", [(0, 0, 0, 0), (0, 0, 0, 1.1), (np.nan, 0, 0, 1), (np.inf, 0, 0, 0), (1e300, 0, 0, 0)])
def test_quaternions_that_are_not_unit_are_refused(quat):
    msg = PoseArray(header=Header(frame_id="map"), poses=[pose(), pose(quat=tuple(map(float, quat)))])
    with pytest.raises(MessageError, match="orientation 1 has norm"):
        c.keypoints_from_msg(msg)


def test_a_rounded_quaternion_is_made_unit():
    quat = (0.0, 0.0, 0.70711, 0.70711)
    got = c.keypoints_from_msg(PoseArray(header=Header(frame_id="map"), poses=[pose(quat=quat)]))
    assert np.linalg.norm(got.quat_xyzw[0]) == pytest.approx(1.0, abs=1e-15)


def cloud(importance_map):
    return c.importance_map_to_msg(importance_map, STAMP)


def change_bytes(msg, change):
    table = np.frombuffer(bytes(msg.data), np.float32).reshape(-1, 7).copy()
    table = change(table)
    msg.width = len(table)
    msg.row_step = 28 * len(table)
    msg.data = array.array("B", table.astype(np.float32).tobytes())
    return msg


def set_nan(table):
    table[3, 5] = np.nan
    return table


def zero_voxels(table):
    table[:, :3] = 0.0
    return table


@pytest.mark.parametrize(
    ("spoil", "reason"),
    [
        (lambda m: setattr(m.header, "frame_id", "odom"), "frame is 'odom'"),
        (lambda m: setattr(m, "width", m.width - 1), "sizes do not agree"),
        (lambda m: setattr(m, "row_step", 7), "sizes do not agree"),
        (lambda m: setattr(m, "is_bigendian", True), "big-endian"),
        (lambda m: setattr(m.fields[3], "name", "rgb"), "expected float32"),
        (lambda m: setattr(m.fields[3], "datatype", 8), "expected float32"),
        (lambda m: change_bytes(m, set_nan), "not finite"),
        (lambda m: change_bytes(m, zero_voxels), "not a grid"),
        (lambda m: change_bytes(m, lambda t: t[:-1]), "not a grid"),
        (lambda m: change_bytes(m, lambda t: t[::-1]), "x fastest"),
        (lambda m: change_bytes(m, lambda t: t[:1]), "does not tell its size"),
        (lambda m: change_bytes(m, lambda t: t * [1, 2, 1, 1, 1, 1, 1]), "not a grid of"),
    ],
)
def test_unsound_clouds_are_refused(importance_map, spoil, reason):
    msg = cloud(importance_map)
    spoil(msg)
    with pytest.raises(MessageError, match=reason):
        c.importance_map_from_msg(msg)


@FEW
@given(data=st.binary(max_size=112), width=st.integers(0, 5), step=st.integers(0, 40))
def test_clouds_of_any_bytes_are_sound_or_refused(importance_map, data, width, step):
    msg = cloud(importance_map)
    msg.data, msg.width, msg.point_step, msg.row_step = array.array("B", data), width, step, step * width
    try:
        got = c.importance_map_from_msg(msg)
    except MessageError:
        return
    assert got is None or got.grid.voxel_size_m > 0


@pytest.mark.parametrize(
    ("field", "value", "reason"),
    [
        ("resolution", 0.0, "resolution"),
        ("resolution", float("nan"), "resolution"),
        ("resolution", -0.25, "resolution"),
        ("width", 7, "sizes do not agree"),
    ],
)
def test_unsound_storey_grids_are_refused(field, value, reason):
    grid = c.StoreyGrid(origin=np.zeros(3), cell_m=0.25, percent=np.zeros((2, 3), np.int8))
    msg = c.storey_grid_to_msg(grid, STAMP)
    setattr(msg.info, field, value)
    with pytest.raises(MessageError, match=reason):
        c.storey_grid_from_msg(msg)


def test_cells_beyond_hundred_are_refused():
    grid = c.StoreyGrid(origin=np.zeros(3), cell_m=0.25, percent=np.full((2, 3), 101, np.int8))
    with pytest.raises(MessageError, match=r"-1\.\.100"):
        c.storey_grid_from_msg(c.storey_grid_to_msg(grid, STAMP))


def test_paths_that_run_back_in_time_are_refused(trajectory):
    t = trajectory.t_s[::-1]
    msg = c.path_to_msg(t, trajectory.positions, trajectory.quat_xyzw, STAMP)
    with pytest.raises(MessageError, match="stamped before"):
        c.path_from_msg(msg)
    early = c.path_to_msg([0.0], [[0, 0, 0]], [[0, 0, 0, 1]], STAMP)
    early.header.stamp.sec += 1
    with pytest.raises(MessageError, match="before the header"):
        c.path_from_msg(early)


def test_a_pose_in_another_frame_is_refused(trajectory):
    msg = c.tour_to_msg(trajectory.positions, STAMP)
    msg.poses[4].header.frame_id = "odom"
    with pytest.raises(MessageError, match="odom"):
        c.tour_from_msg(msg)


@pytest.mark.parametrize("name", ["transforms", "velocities", "accelerations"])
def test_trajectories_of_sizes_that_disagree_are_refused(trajectory, name):
    msg = c.trajectory_to_msg(trajectory, STAMP)
    setattr(msg.points[2], name, [])
    with pytest.raises(MessageError, match=f"0 {name}"):
        c.trajectory_from_msg(msg)


@pytest.mark.parametrize("name", ["velocities", "accelerations"])
def test_trajectories_that_are_not_finite_are_refused(trajectory, name):
    msg = c.trajectory_to_msg(trajectory, STAMP)
    getattr(msg.points[2], name)[0].linear.y = float("inf")
    with pytest.raises(MessageError, match="2 is not finite"):
        c.trajectory_from_msg(msg)


def test_trajectories_of_two_joints_are_refused(trajectory):
    msg = c.trajectory_to_msg(trajectory, STAMP)
    msg.joint_names = ["eye", "hand"]
    with pytest.raises(MessageError, match="2 names"):
        c.trajectory_from_msg(msg)


@FEW
@given(name=st.text(max_size=12), kind=st.integers(0, 255), x=ANY, w=ANY, frame=st.sampled_from(["map", "x"]))
def test_edits_are_sound_or_refused(name, kind, x, w, frame):
    msg = InteractiveMarkerFeedback(
        header=Header(frame_id=frame), marker_name=name, event_type=kind, pose=pose(x=x, quat=(0.0, 0.0, 0.0, w))
    )
    try:
        got = c.edit_from_msg(msg)
    except MessageError as error:
        assert error.reason
        return
    assert str(got.keypoint) == name.lstrip("0") or got.keypoint == 0
    assert np.isfinite(got.position).all()


@pytest.mark.parametrize(
    ("kind", "entry", "name", "reason"),
    [
        (InteractiveMarkerFeedback.BUTTON_CLICK, 0, "1", "event type 3 is no edit"),
        (InteractiveMarkerFeedback.MENU_SELECT, 0, "1", "menu entry 0 is no edit"),
        (InteractiveMarkerFeedback.MENU_SELECT, 99, "1", "menu entry 99 is no edit"),
        (InteractiveMarkerFeedback.MENU_SELECT, 2, "", "'' is no keypoint"),
    ],
)
def test_events_that_are_no_edit_are_refused(kind, entry, name, reason):
    msg = InteractiveMarkerFeedback(
        header=Header(frame_id="map"), marker_name=name, event_type=kind, menu_entry_id=entry, pose=pose()
    )
    with pytest.raises(MessageError, match=reason):
        c.edit_from_msg(msg)


def test_markers_without_any_are_refused():
    for read in (c.keypoint_markers_from_msg, c.pairwise_paths_from_msg):
        with pytest.raises(MessageError, match="no markers"):
            read(MarkerArray())


def test_markers_of_two_revisions_are_refused(quats):
    msg = c.keypoint_markers_to_msg(np.zeros((2, 3)), quats(2), [0, 1], ["", ""], STAMP)
    msg.markers[1].header.stamp.sec += 1
    with pytest.raises(MessageError, match="2 different stamps"):
        c.keypoint_markers_from_msg(msg)


def test_two_keypoints_of_one_identity_are_refused(quats):
    msg = c.keypoint_markers_to_msg(np.zeros((2, 3)), quats(2), [3, 3], ["", ""], STAMP)
    with pytest.raises(MessageError, match="same identity"):
        c.keypoint_markers_from_msg(msg)


@pytest.mark.parametrize("text", ["", "1 to 2", "1 to 2: m", "a to b: 3 m", "1 to 2: 1e400 m", "1 to 2: -3.0 m"])
def test_legs_without_pair_and_length_are_refused(text):
    from types import SimpleNamespace

    leg = SimpleNamespace(start=0, goal=1, points=np.zeros((2, 3)), length_m=1.0)
    msg = c.pairwise_paths_to_msg([leg], [0, 1], STAMP)
    msg.markers[1].text = text
    with pytest.raises(MessageError):
        c.pairwise_paths_from_msg(msg)


def test_results_that_are_none_are_refused():
    from diagnostic_msgs.msg import DiagnosticStatus

    with pytest.raises(MessageError, match="lack outcome"):
        c.edit_result_from_msg(DiagnosticStatus())


def test_a_viewpoint_that_is_not_finite_is_refused():
    msg = PoseStamped(header=Header(frame_id="map"), pose=pose(x=float("nan")))
    with pytest.raises(MessageError, match="position 0 is not finite"):
        c.viewpoint_from_msg(msg)
