# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Messages to plain values and back, each form against the message class itself."""

import base64
import math

import cbor2
import numpy as np
import orjson
import pytest
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from geometry_msgs.msg import PoseArray
from nav_msgs.msg import OccupancyGrid, Path
from rcl_interfaces.srv import DescribeParameters, SetParametersAtomically
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import Header
from trajectory_msgs.msg import MultiDOFJointTrajectory
from visualization_msgs.msg import InteractiveMarkerFeedback, MarkerArray

from walk_ros.conversions import path_to_msg
from walk_ros.conversions.cdr import path_to_bytes, trajectory_to_bytes
from walk_ros.raw import from_bytes, to_bytes
from walk_vr_bridge.errors import ProtocolError
from walk_vr_bridge.wire.cbor_rows import path_to_cbor, trajectory_to_cbor
from walk_vr_bridge.wire.decoding import decoder
from walk_vr_bridge.wire.encoding import encoder
from walk_vr_bridge.wire.message import Message
from walk_vr_bridge.wire.rows import header_stamp_ns, path_to_dict, trajectory_to_dict


class Walk:
    """A trajectory of n rows."""

    def __init__(self, n):
        rng = np.random.default_rng(n)
        self.t_s = np.linspace(0.0, 9.0, n)
        self.positions, self.velocities, self.accelerations = rng.normal(size=(3, n, 3))
        quat = rng.normal(size=(n, 4))
        self.quat_xyzw = quat / np.linalg.norm(quat, axis=1)[:, None]


def reflected(msg):
    """The message as plain values, field by field through its public names."""
    if hasattr(msg, "get_fields_and_field_types"):
        return {name: reflected(getattr(msg, name)) for name in msg.get_fields_and_field_types()}
    if isinstance(msg, bytes):
        return msg[0]
    if getattr(msg, "typecode", "") == "B":
        return base64.b64encode(bytes(msg)).decode()
    if isinstance(msg, str | float | int | bool):
        return msg
    return [reflected(item) for item in msg]


def samples():
    header = Header(stamp=Time(sec=3, nanosec=4), frame_id="map")
    status = DiagnosticStatus(level=b"\x02", name='ä"', values=[KeyValue(key="k", value="v")])
    cloud = PointCloud2(header=header, data=bytes(range(200)))
    grid = OccupancyGrid(header=header, data=[-1, 0, 100])
    path = path_to_msg(np.arange(3.0), np.ones((3, 3)), np.tile([0, 0, 0, 1.0], (3, 1)), 5)
    return [status, cloud, grid, path, MarkerArray(), PoseArray(header=header), DescribeParameters.Response()]


@pytest.mark.parametrize("msg", samples(), ids=lambda m: type(m).__name__)
def test_compiled_values_are_those_of_the_message(msg):
    assert encoder(type(msg), "json")(msg) == reflected(msg)


@pytest.mark.parametrize("n", [0, 1, 2, 57])
def test_rows_read_from_bytes_are_those_of_the_message(n):
    walk = Walk(n)
    data = path_to_bytes(walk.t_s, walk.positions, walk.quat_xyzw, 5 * 10**9 + 7)
    assert path_to_dict(data) == reflected(from_bytes(data, "nav_msgs/msg/Path"))
    assert header_stamp_ns(data) == 5 * 10**9 + 7
    data = trajectory_to_bytes(walk, 5 * 10**9 + 7)
    name = "trajectory_msgs/msg/MultiDOFJointTrajectory"
    assert trajectory_to_dict(data) == reflected(from_bytes(data, name))


def test_rows_of_another_stride_take_the_way_over_the_message():
    msg = path_to_msg(np.arange(3.0), np.ones((3, 3)), np.tile([0, 0, 0, 1.0], (3, 1)), 5)
    msg.poses[1].header.frame_id = "elsewhere"
    data = to_bytes(msg)
    assert path_to_dict(data) is None
    assert Message("/walk/path", "nav_msgs/Path", data).values() == reflected(msg)
    assert trajectory_to_dict(to_bytes(MultiDOFJointTrajectory())) is None


@pytest.mark.parametrize("cut", [0, 3, 11, 20, 23, 27, 60, 100])
def test_cut_off_bytes_are_no_rows(cut):
    walk = Walk(4)
    assert path_to_dict(path_to_bytes(walk.t_s, walk.positions, walk.quat_xyzw, 1)[:cut]) is None
    assert trajectory_to_dict(trajectory_to_bytes(walk, 1)[:cut]) is None


def test_each_form_of_a_frame_says_the_same():
    walk = Walk(5)
    data = path_to_bytes(walk.t_s, walk.positions, walk.quat_xyzw, 9)
    message = Message("/walk/path", "nav_msgs/Path", data)
    said = orjson.loads(message.frame("none"))
    assert (said["op"], said["topic"]) == ("publish", "/walk/path")
    assert cbor2.loads(message.frame("cbor"))["msg"] == said["msg"] == reflected(from_bytes(data, "nav_msgs/msg/Path"))
    assert cbor2.loads(message.frame("cbor-raw"))["msg"]["bytes"] == data


@pytest.mark.parametrize("n", [0, 1, 23, 24, 300])
def test_rows_written_as_cbor_are_those_of_the_message(n):
    walk = Walk(n)
    data = path_to_bytes(walk.t_s, walk.positions, walk.quat_xyzw, 5 * 10**9 + 7)
    assert cbor2.loads(path_to_cbor(data)) == reflected(from_bytes(data, "nav_msgs/msg/Path"))
    data = trajectory_to_bytes(walk, 5 * 10**9 + 7)
    expected = reflected(from_bytes(data, "trajectory_msgs/msg/MultiDOFJointTrajectory"))
    assert cbor2.loads(trajectory_to_cbor(data)) == expected
    frame = Message("/walk/trajectory", "trajectory_msgs/MultiDOFJointTrajectory", data).frame("cbor")
    assert cbor2.loads(frame) == {"op": "publish", "topic": "/walk/trajectory", "msg": expected}


def test_cbor_of_times_before_1970_takes_the_way_over_the_message():
    walk = Walk(3)
    data = path_to_bytes(walk.t_s - 5.0, walk.positions, walk.quat_xyzw, 7)
    assert path_to_cbor(data) is None
    frame = Message("/walk/path", "nav_msgs/Path", data).frame("cbor")
    assert cbor2.loads(frame)["msg"] == reflected(from_bytes(data, "nav_msgs/msg/Path"))


def test_cbor_has_arrays_of_numbers_as_typed_arrays():
    grid = OccupancyGrid(data=[-1, 0, 100])
    tag = encoder(OccupancyGrid, "cbor")(grid)["data"]
    assert (tag.tag, tag.value) == (72, b"\xff\x00\x64")
    assert encoder(PointCloud2, "cbor")(PointCloud2(data=b"\x01\x02"))["data"] == b"\x01\x02"


def test_values_come_back_as_the_message():
    for msg in samples():
        if not isinstance(msg, DescribeParameters.Response):
            assert decoder(type(msg))(encoder(type(msg), "json")(msg), "msg") == msg


def test_fields_left_out_keep_their_defaults():
    decode = decoder(InteractiveMarkerFeedback)
    assert decode({}, "msg") == InteractiveMarkerFeedback()
    assert decode({"pose": {"position": {"x": 1}}}, "msg").pose.orientation.w == 1.0


def test_times_of_ros_1_are_read():
    assert decoder(Header)({"stamp": {"secs": 3, "nsecs": 4}}, "msg").stamp == Time(sec=3, nanosec=4)


def test_a_null_for_a_number_is_not_a_number():
    assert math.isnan(decoder(InteractiveMarkerFeedback)({"mouse_point": {"x": None}}, "msg").mouse_point.x)
    assert b"null" in orjson.dumps(encoder(Path, "json")(path_to_msg([0.0], [[math.nan] * 3], [[0, 0, 0, 1.0]], 1)))


@pytest.mark.parametrize(
    ("values", "where"),
    [
        ({"event_type": 256}, "msg.event_type"),
        ({"event_type": True}, "msg.event_type"),
        ({"event_type": "1"}, "msg.event_type"),
        ({"menu_entry_id": -1}, "msg.menu_entry_id"),
        ({"pose": {"position": {"x": "1"}}}, "msg.pose.position.x"),
        ({"pose": [1]}, "msg.pose"),
        ({"marker_name": 3}, "msg.marker_name"),
        ({"marker_name": "a\0b"}, "msg.marker_name"),
        ({"mouse_point_valid": 1}, "msg.mouse_point_valid"),
        ({"colour": 1}, "'colour'"),
        ([], "msg"),
    ],
)
def test_what_does_not_belong_is_said_with_its_place(values, where):
    with pytest.raises(ProtocolError, match=r"expected|has no field") as caught:
        decoder(InteractiveMarkerFeedback)(values, "msg")
    assert where in str(caught.value)


def test_parameters_of_a_service_are_read():
    args = {"parameters": [{"name": "trajopt.clearance_m", "value": {"type": 3, "double_value": 0.4}}]}
    request = decoder(SetParametersAtomically.Request)(args, "args")
    assert request.parameters[0].value.double_value == 0.4
    with pytest.raises(ProtocolError, match="list"):
        decoder(SetParametersAtomically.Request)({"parameters": 3}, "args")
