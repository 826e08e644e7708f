# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Edits straight from CDR bytes: a drag comes 90 times a second, and a path waits for each."""

from __future__ import annotations

import math
import struct

import numpy as np
from rclpy.serialization import deserialize_message
from visualization_msgs.msg import InteractiveMarkerFeedback

from walk_ros.conversions.checks import FRAME
from walk_ros.conversions.edits import EditKind, KeypointEdit, edit_from_msg
from walk_ros.conversions.stamps import NS

_ORIGIN = 4  # bytes that name the encoding; what is aligned is so from their end
_LITTLE_ENDIAN = b"\x00\x01"
_EXACT = 1e-12  # of a quaternion's norm; one that is farther from 1 is left to the plain conversion


def edit_from_bytes(data: bytes) -> KeypointEdit:
    """Returns what `edit_from_msg` returns for the serialised message, and raises what it raises.

    A sound drag is read in place; everything else goes the plain way.
    """
    drag = _drag(data)
    return drag if drag is not None else edit_from_msg(deserialize_message(data, InteractiveMarkerFeedback))


def _drag(data: bytes) -> KeypointEdit | None:
    """Returns the drag that the bytes hold, None where they hold anything else or are not sound."""
    try:
        if data[:2] != _LITTLE_ENDIAN:
            return None
        sec, nanosec = struct.unpack_from("<iI", data, _ORIGIN)
        frame, at = _text(data, _ORIGIN + 8)
        client, at = _text(data, at)
        name, at = _text(data, at)
        _, at = _text(data, at)
        kind = data[at]
        at += 1
        pose = struct.unpack_from("<7d", data, at + (_ORIGIN - at) % 8)
    except (struct.error, UnicodeDecodeError, IndexError):
        return None
    sound = (
        kind == EditKind.DRAG.value
        and frame == FRAME
        and name.isascii()
        and name.isdigit()
        and len(name) < 10
        and sec >= 0
        and nanosec < NS
        and all(map(math.isfinite, pose))
        and abs(math.hypot(*pose[3:]) - 1.0) <= _EXACT
    )
    if not sound:
        return None
    position, quat_xyzw = np.array(pose[:3]), np.array(pose[3:])
    position.flags.writeable = quat_xyzw.flags.writeable = False
    return KeypointEdit(
        kind=EditKind.DRAG,
        keypoint=int(name),
        client_id=client,
        stamp_ns=sec * NS + nanosec,
        position=position,
        quat_xyzw=quat_xyzw,
    )


def _text(data: bytes, at: int) -> tuple[str, int]:
    """Returns the text behind the next multiple of four, and where it ends."""
    at += (_ORIGIN - at) % 4
    (length,) = struct.unpack_from("<I", data, at)
    end = at + 4 + length
    if not 0 < length <= len(data):
        raise IndexError
    return data[at + 4 : end - 1].decode(), end
