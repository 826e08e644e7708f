# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Keypoints and viewpoints: positions with a view direction."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from geometry_msgs.msg import Point, Pose, PoseArray, PoseStamped, Quaternion
from numpy.typing import ArrayLike, NDArray

from walk_ros.conversions.checks import finite_array, unit_quaternions
from walk_ros.conversions.stamps import header_from_msg, header_to_msg


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Poses:
    """Eye positions with view directions, of one revision. Arrays are read-only."""

    stamp_ns: int
    positions: NDArray[np.float64]  # (K, 3) [m]
    quat_xyzw: NDArray[np.float64]  # (K, 4), x axis ahead


def pose_msgs(positions: ArrayLike, quat_xyzw: ArrayLike) -> list[Pose]:
    """Returns a pose per row of (K, 3) positions and (K, 4) orientations."""
    rows = zip(np.asarray(positions, float).tolist(), np.asarray(quat_xyzw, float).tolist(), strict=True)
    return [
        Pose(position=Point(x=p[0], y=p[1], z=p[2]), orientation=Quaternion(x=q[0], y=q[1], z=q[2], w=q[3]))
        for p, q in rows
    ]


def pose_arrays(kind: str, poses: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns checked (K, 3) positions and (K, 4) xyzw orientations of pose messages."""
    positions = [(p.position.x, p.position.y, p.position.z) for p in poses]
    quats = [(p.orientation.x, p.orientation.y, p.orientation.z, p.orientation.w) for p in poses]
    return finite_array(kind, "position", positions, 3), unit_quaternions(kind, quats)


def keypoints_to_msg(positions: ArrayLike, quat_xyzw: ArrayLike, stamp_ns: int) -> PoseArray:
    """Returns keypoints, in the order given, as a PoseArray."""
    return PoseArray(header=header_to_msg(stamp_ns), poses=pose_msgs(positions, quat_xyzw))


def keypoints_from_msg(msg: PoseArray) -> Poses:
    """Returns the keypoints of a PoseArray; raises MessageError if it is not sound."""
    kind = "geometry_msgs/PoseArray"
    stamp_ns = header_from_msg(msg.header, kind)
    positions, quat_xyzw = pose_arrays(kind, msg.poses)
    return Poses(stamp_ns=stamp_ns, positions=positions, quat_xyzw=quat_xyzw)


def viewpoint_to_msg(position: ArrayLike, quat_xyzw: ArrayLike, stamp_ns: int) -> PoseStamped:
    """Returns where the eye is at a time, from a (3,) position and a (4,) orientation."""
    (pose,) = pose_msgs(np.atleast_2d(np.asarray(position, float)), np.atleast_2d(np.asarray(quat_xyzw, float)))
    return PoseStamped(header=header_to_msg(stamp_ns), pose=pose)


def viewpoint_from_msg(msg: PoseStamped) -> Poses:
    """Returns the one pose of a viewpoint; raises MessageError if it is not sound."""
    kind = "geometry_msgs/PoseStamped"
    stamp_ns = header_from_msg(msg.header, kind)
    positions, quat_xyzw = pose_arrays(kind, [msg.pose])
    return Poses(stamp_ns=stamp_ns, positions=positions, quat_xyzw=quat_xyzw)
