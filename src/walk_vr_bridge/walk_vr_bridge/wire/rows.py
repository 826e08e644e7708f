# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Paths and trajectories read from their raw CDR bytes: rows of a fixed stride, which numpy reads in place.

Only where every row has the frame or joint name of the project, as its nodes write them; the layout stands in
docs/protocol.md. Everything else takes the way over the message class.
"""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

_LITTLE_ENDIAN = b"\x00\x01\x00\x00"
_FRAME = b"\x04\x00\x00\x00map\x00"
_JOINT = b"\x01\x00\x00\x00\x04\x00\x00\x00eye\x00"

_POSE = np.dtype([("sec", "<i4"), ("nanosec", "<u4"), ("frame", "V8"), ("pose", "<f8", 7)])
_POINT = np.dtype(
    [
        ("transforms", "<u4"),
        ("pad_0", "V4"),
        ("transform", "<f8", 7),
        ("velocities", "<u4"),
        ("pad_1", "V4"),
        ("velocity", "<f8", 6),
        ("accelerations", "<u4"),
        ("pad_2", "V4"),
        ("acceleration", "<f8", 6),
        ("sec", "<i4"),
        ("nanosec", "<u4"),
    ]
)


def header_stamp_ns(data: bytes) -> int:
    """Returns the stamp of a message that begins with a header [ns]."""
    sec, nanosec = struct.unpack_from("<iI", data, 4)
    return int(sec * 10**9 + nanosec)


def _header(data: bytes) -> dict[str, Any]:
    sec, nanosec = struct.unpack_from("<iI", data, 4)
    return {"stamp": {"sec": sec, "nanosec": nanosec}, "frame_id": "map"}


def path_rows(data: bytes) -> NDArray[np.void] | None:
    """Returns the rows of a serialised nav_msgs/Path; None where they have no fixed stride."""
    if len(data) < 24 or data[:4] != _LITTLE_ENDIAN or data[12:20] != _FRAME:
        return None
    (count,) = struct.unpack_from("<I", data, 20)
    if count == 0:
        return np.empty(0, _POSE)
    # The doubles of all rows have one stride; the first row's stamp and frame stand four bytes early, unpadded.
    if len(data) < 28 + _POSE.itemsize * count:
        return None
    rows = np.frombuffer(data, _POSE, count, 28)
    first = np.frombuffer(data, _POSE, 1, 24)
    frames = np.append(first["frame"], rows["frame"][1:])
    if (frames != np.void(_FRAME)).any():
        return None
    rows = rows.copy()
    rows["sec"][0], rows["nanosec"][0] = first["sec"][0], first["nanosec"][0]
    return rows


def path_to_dict(data: bytes) -> dict[str, Any] | None:
    """Returns a serialised nav_msgs/Path as plain values; None where its rows have no fixed stride."""
    rows = path_rows(data)
    if rows is None:
        return None
    poses = [
        {
            "header": {"stamp": {"sec": sec, "nanosec": nanosec}, "frame_id": "map"},
            "pose": {
                "position": {"x": x, "y": y, "z": z},
                "orientation": {"x": qx, "y": qy, "z": qz, "w": qw},
            },
        }
        for sec, nanosec, (x, y, z, qx, qy, qz, qw) in zip(
            rows["sec"].tolist(), rows["nanosec"].tolist(), rows["pose"].tolist(), strict=True
        )
    ]
    return {"header": _header(data), "poses": poses}


def trajectory_rows(data: bytes) -> NDArray[np.void] | None:
    """Returns the rows of a serialised MultiDOFJointTrajectory; None where they have no fixed stride."""
    if len(data) < 36 or data[:4] != _LITTLE_ENDIAN or data[12:20] != _FRAME or data[20:32] != _JOINT:
        return None
    (count,) = struct.unpack_from("<I", data, 32)
    if len(data) < 36 + _POINT.itemsize * count:
        return None
    rows = np.frombuffer(data, _POINT, count, 36)
    ones = [rows[name] == 1 for name in ("transforms", "velocities", "accelerations")]
    return rows if np.logical_and.reduce(ones).all() else None


def trajectory_to_dict(data: bytes) -> dict[str, Any] | None:
    """Returns a serialised MultiDOFJointTrajectory as plain values; None where its rows have no fixed stride."""
    rows = trajectory_rows(data)
    if rows is None:
        return None
    columns = ("transform", "velocity", "acceleration", "sec", "nanosec")
    points = [
        {
            "transforms": [
                {
                    "translation": {"x": p[0], "y": p[1], "z": p[2]},
                    "rotation": {"x": p[3], "y": p[4], "z": p[5], "w": p[6]},
                }
            ],
            "velocities": [_twist(v)],
            "accelerations": [_twist(a)],
            "time_from_start": {"sec": sec, "nanosec": nanosec},
        }
        for p, v, a, sec, nanosec in zip(*(rows[name].tolist() for name in columns), strict=True)
    ]
    return {"header": _header(data), "joint_names": ["eye"], "points": points}


def _twist(row: list[float]) -> dict[str, dict[str, float]]:
    return {
        "linear": {"x": row[0], "y": row[1], "z": row[2]},
        "angular": {"x": row[3], "y": row[4], "z": row[5]},
    }
