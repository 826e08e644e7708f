# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Edits read from bytes are those of the plain conversion, sound or not."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from walk_ros import conversions as c
from walk_ros.conversions import edits_cdr
from walk_ros.errors import MessageError
from walk_ros.raw import to_bytes

TEXTS = st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=9)


def plain(data):
    from walk_ros.raw import from_bytes

    return c.edit_from_msg(from_bytes(data, "visualization_msgs/msg/InteractiveMarkerFeedback"))


def outcome(convert, data):
    try:
        edit = convert(data)
    except MessageError as error:
        return error.reason
    fields = dataclasses.asdict(edit)
    return {k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in fields.items()}


def drag(client="anna", name="7", frame="map", control="", kind=c.EditKind.DRAG):
    edit = c.KeypointEdit(
        kind=kind,
        keypoint=7,
        client_id=client,
        stamp_ns=1_234_567_890_123_456_789,
        position=np.array([1.5, -2.25, 1e-3]),
        quat_xyzw=np.array([0.0, 0.0, 0.6, 0.8]),
        change=c.Change.LOCK if kind is c.EditKind.CHANGE else None,
    )
    msg = c.edit_to_msg(edit)
    msg.marker_name, msg.header.frame_id, msg.control_name = name, frame, control
    return msg


@given(
    TEXTS, st.sampled_from(["7", "123456789", "-1", "", "é", "12345678901"]), TEXTS, TEXTS, st.sampled_from(c.EditKind)
)
def test_bytes_and_message_give_the_same(client, name, control, frame, kind):
    for place in ("map", frame):
        data = to_bytes(drag(client, name, place, control, kind))
        assert outcome(c.edit_from_bytes, data) == outcome(plain, data)


@given(st.lists(st.floats(), min_size=7, max_size=7))
def test_any_pose_is_judged_alike(numbers):
    msg = drag()
    msg.pose.position.x, msg.pose.position.y, msg.pose.position.z = numbers[:3]
    turn = msg.pose.orientation
    turn.x, turn.y, turn.z, turn.w = numbers[3:]
    data = to_bytes(msg)
    assert outcome(c.edit_from_bytes, data) == outcome(plain, data)


@pytest.mark.parametrize("sec", [-1, 0, 2**31 - 1])
@pytest.mark.parametrize("nanosec", [0, 10**9])
def test_stamps_are_judged_alike(sec, nanosec):
    msg = drag()
    msg.header.stamp.sec, msg.header.stamp.nanosec = sec, nanosec
    data = to_bytes(msg)
    assert outcome(c.edit_from_bytes, data) == outcome(plain, data)


def test_a_sound_drag_is_read_without_the_message(monkeypatch):
    def no_message(*_):
        raise AssertionError("the plain way was taken")

    monkeypatch.setattr(edits_cdr, "deserialize_message", no_message)
    edit = c.edit_from_bytes(to_bytes(drag()))
    assert (edit.keypoint, edit.client_id) == (7, "anna")
    assert not edit.position.flags.writeable
