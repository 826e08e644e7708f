# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The path and the trajectory straight as CDR bytes: what an edit waits for least.

Building the messages in Python and serialising them takes longer than optimising the edit. In both messages the rows
have a fixed stride, because all of them have the same short frame or joint name, so numpy writes them in one go. The
bytes decode to what `path_to_msg` and `trajectory_to_msg` return; a test holds them to it.
"""

from __future__ import annotations

import struct

import numpy as np
from numpy.typing import ArrayLike

from walk_ros.conversions.checks import FRAME
from walk_ros.conversions.stamps import NS
from walk_ros.conversions.trajectories import JOINT, TrajectoryLike

_LITTLE_ENDIAN = b"\x00\x01\x00\x00"
_FRAME = FRAME.encode() + b"\0"
_JOINT = JOINT.encode() + b"\0"

# Doubles are aligned to 8 bytes from the end of the four that name the encoding; the strings have four bytes each.
_POSE = np.dtype([("sec", "<i4"), ("nanosec", "<u4"), ("length", "<u4"), ("frame", "S4"), ("pose", "<f8", 7)])
_TO_POSE = 16  # bytes of a row before its doubles
_POINT = np.dtype(
    [
        ("transforms", "<u4"),
        ("pad_0", "<u4"),
        ("transform", "<f8", 7),
        ("velocities", "<u4"),
        ("pad_1", "<u4"),
        ("velocity", "<f8", 6),
        ("accelerations", "<u4"),
        ("pad_2", "<u4"),
        ("acceleration", "<f8", 6),
        ("sec", "<i4"),
        ("nanosec", "<u4"),
    ]
)


def path_to_bytes(t_s: ArrayLike, positions: ArrayLike, quat_xyzw: ArrayLike, stamp_ns: int) -> bytes:
    """Returns the serialised nav_msgs/Path that `path_to_msg` of the same arguments is."""
    arrivals = stamp_ns + np.rint(np.asarray(t_s, float) * NS).astype(np.int64)
    rows = np.zeros(len(arrivals), _POSE)
    rows["sec"], rows["nanosec"] = np.divmod(arrivals, NS)
    rows["length"], rows["frame"] = len(_FRAME), _FRAME
    rows["pose"][:, :3] = np.asarray(positions, float).reshape(-1, 3)
    rows["pose"][:, 3:] = np.asarray(quat_xyzw, float).reshape(-1, 4)
    body = rows.tobytes()
    # The first row begins four bytes off the alignment that its doubles need; from there on all rows fit.
    gap = b"\0" * 4 if body else b""
    return b"".join([_header(stamp_ns), struct.pack("<I", len(rows)), body[:_TO_POSE], gap, body[_TO_POSE:]])


def trajectory_to_bytes(trajectory: TrajectoryLike, stamp_ns: int) -> bytes:
    """Returns the serialised MultiDOFJointTrajectory that `trajectory_to_msg` of the same arguments is."""
    t_ns = np.rint(np.asarray(trajectory.t_s, float) * NS).astype(np.int64)
    rows = np.zeros(len(t_ns), _POINT)
    rows["sec"], rows["nanosec"] = np.divmod(t_ns, NS)
    for name in ("transforms", "velocities", "accelerations"):
        rows[name] = 1
    rows["transform"][:, :3] = trajectory.positions
    rows["transform"][:, 3:] = trajectory.quat_xyzw
    rows["velocity"][:, :3] = trajectory.velocities
    rows["acceleration"][:, :3] = trajectory.accelerations
    names = struct.pack("<II", 1, len(_JOINT)) + _JOINT
    return b"".join([_header(stamp_ns), names, struct.pack("<I", len(rows)), rows.tobytes()])


def _header(stamp_ns: int) -> bytes:
    """Returns the encoding's name and the message header."""
    return _LITTLE_ENDIAN + struct.pack("<iII", stamp_ns // NS, stamp_ns % NS, len(_FRAME)) + _FRAME
