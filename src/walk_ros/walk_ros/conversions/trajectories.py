# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The timed trajectory as trajectory_msgs/MultiDOFJointTrajectory."""

from __future__ import annotations

import dataclasses
from typing import Any, Protocol

import numpy as np
from geometry_msgs.msg import Quaternion, Transform, Twist, Vector3
from numpy.typing import NDArray
from trajectory_msgs.msg import MultiDOFJointTrajectory, MultiDOFJointTrajectoryPoint

from walk_ros.conversions.checks import finite_array, read_only, require, same_length, unit_quaternions
from walk_ros.conversions.stamps import duration_from_msg, duration_to_msg, header_from_msg, header_to_msg

KIND = "trajectory_msgs/MultiDOFJointTrajectory"
JOINT = "eye"
"""The one joint: the walker's eye in the fixed frame."""


class TrajectoryLike(Protocol):
    """What a trajectory has: walk_trajopt's result, or one that came in as a message."""

    @property
    def t_s(self) -> NDArray[np.float64]:
        """(m,) times [s]."""

    @property
    def positions(self) -> NDArray[np.float64]:
        """(m, 3) eye positions [m]."""

    @property
    def velocities(self) -> NDArray[np.float64]:
        """(m, 3) [m/s]."""

    @property
    def accelerations(self) -> NDArray[np.float64]:
        """(m, 3) [m/s²]."""

    @property
    def quat_xyzw(self) -> NDArray[np.float64]:
        """(m, 4) orientations, x axis ahead."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class ReceivedTrajectory:
    """A trajectory that came in as a message. Arrays are read-only."""

    stamp_ns: int
    t_s: NDArray[np.float64]  # (m,) [s], exact to the nanosecond
    positions: NDArray[np.float64]  # (m, 3) [m]
    velocities: NDArray[np.float64]  # (m, 3) [m/s]
    accelerations: NDArray[np.float64]  # (m, 3) [m/s²]
    quat_xyzw: NDArray[np.float64]  # (m, 4)


def _vector(row: list[float]) -> Vector3:
    return Vector3(x=row[0], y=row[1], z=row[2])


def trajectory_to_msg(trajectory: TrajectoryLike, stamp_ns: int) -> MultiDOFJointTrajectory:
    """Returns the trajectory with velocities, accelerations and `time_from_start` for its one joint, the eye."""
    columns = (
        trajectory.t_s,
        trajectory.positions,
        trajectory.quat_xyzw,
        trajectory.velocities,
        trajectory.accelerations,
    )
    rows = zip(*(np.asarray(c, dtype=np.float64).tolist() for c in columns), strict=True)
    points = [
        MultiDOFJointTrajectoryPoint(
            transforms=[Transform(translation=_vector(p), rotation=Quaternion(x=q[0], y=q[1], z=q[2], w=q[3]))],
            velocities=[Twist(linear=_vector(v))],
            accelerations=[Twist(linear=_vector(a))],
            time_from_start=duration_to_msg(t),
        )
        for t, p, q, v, a in rows
    ]
    return MultiDOFJointTrajectory(header=header_to_msg(stamp_ns), joint_names=[JOINT], points=points)


def trajectory_from_msg(msg: MultiDOFJointTrajectory) -> ReceivedTrajectory:
    """Returns the trajectory of the message's one joint; raises MessageError if it is not sound."""
    stamp_ns = header_from_msg(msg.header, KIND)
    require(len(msg.joint_names) == 1, KIND, f"joint_names has {len(msg.joint_names)} names; expected one")
    for point in msg.points:
        same_length(
            KIND,
            joint_names=1,
            transforms=len(point.transforms),
            velocities=len(point.velocities),
            accelerations=len(point.accelerations),
        )
    t_s = np.array([duration_from_msg(p.time_from_start) for p in msg.points])
    require(bool(np.all(np.diff(t_s) >= 0)), KIND, "time_from_start runs backwards")
    rotations = [p.transforms[0].rotation for p in msg.points]
    return ReceivedTrajectory(
        stamp_ns=stamp_ns,
        t_s=read_only(t_s, np.float64, (-1,)),
        positions=_vectors("position", [p.transforms[0].translation for p in msg.points]),
        velocities=_vectors("velocity", [p.velocities[0].linear for p in msg.points]),
        accelerations=_vectors("acceleration", [p.accelerations[0].linear for p in msg.points]),
        quat_xyzw=unit_quaternions(KIND, [(q.x, q.y, q.z, q.w) for q in rotations]),
    )


def _vectors(name: str, vectors: list[Any]) -> NDArray[np.float64]:
    return finite_array(KIND, name, [(v.x, v.y, v.z) for v in vectors], 3)
