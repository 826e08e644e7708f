# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The tour (a path: no time) and the optimised path (with planned arrival times) as nav_msgs/Path."""

from __future__ import annotations

import dataclasses

import numpy as np
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path
from numpy.typing import ArrayLike, NDArray

from walk_ros.conversions.checks import FRAME, check_frame, read_only, require
from walk_ros.conversions.poses import pose_arrays, pose_msgs
from walk_ros.conversions.stamps import NS, header_from_msg, header_to_msg, stamp_from_msg

KIND = "nav_msgs/Path"


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class TimedPath:
    """Eye positions in the order they are walked. Arrays are read-only."""

    stamp_ns: int  # names the revision
    t_s: NDArray[np.float64]  # (n,) planned arrival after the stamp [s]; all 0 where the path has no time
    positions: NDArray[np.float64]  # (n, 3) [m]
    quat_xyzw: NDArray[np.float64]  # (n, 4), x axis ahead


def headings(positions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns (n, 4) xyzw orientations about z that look along the path, each towards the next point.

    A point without a horizontal direction of its own (the last one, or a repeated one) takes that of the one before.
    """
    angle = np.zeros(len(positions))
    if len(positions) > 1:
        step = np.diff(positions[:, :2], axis=0)
        moves = np.hypot(step[:, 0], step[:, 1]) > 1e-9
        last = np.maximum.accumulate(np.where(moves, np.arange(len(step)), -1))
        first = int(np.argmax(moves))
        source = np.where(last < 0, first, last)
        angle[:-1] = np.arctan2(step[source, 1], step[source, 0])
        angle[-1] = angle[-2]
    zero = np.zeros_like(angle)
    return np.stack([zero, zero, np.sin(angle / 2), np.cos(angle / 2)], axis=1)


def tour_to_msg(polyline: ArrayLike, stamp_ns: int) -> Path:
    """Returns the planned polyline (L, 3) of eye positions; every pose carries the revision's stamp."""
    points = np.asarray(polyline, dtype=np.float64).reshape(-1, 3)
    return path_to_msg(np.zeros(len(points)), points, headings(points), stamp_ns)


def path_to_msg(t_s: ArrayLike, positions: ArrayLike, quat_xyzw: ArrayLike, stamp_ns: int) -> Path:
    """Returns a timed path: every pose is stamped with its planned arrival, `stamp_ns` + `t_s`."""
    header = header_to_msg(stamp_ns)
    poses = pose_msgs(positions, quat_xyzw)
    arrivals = (stamp_ns + np.rint(np.asarray(t_s, float) * NS).astype(np.int64)).tolist()
    stamped = [PoseStamped(header=header_to_msg(at), pose=pose) for at, pose in zip(arrivals, poses, strict=True)]
    return Path(header=header, poses=stamped)


def path_from_msg(msg: Path) -> TimedPath:
    """Returns the points, orientations and arrival times of a path; raises MessageError if it is not sound."""
    stamp_ns = header_from_msg(msg.header, KIND)
    positions, quat_xyzw = pose_arrays(KIND, [p.pose for p in msg.poses])
    for pose in msg.poses:
        # An empty frame in a pose means "as in the header"; RViz writes it so.
        check_frame(KIND, pose.header.frame_id or FRAME)
    arrivals = np.array([stamp_from_msg(p.header.stamp, KIND) for p in msg.poses], dtype=np.int64)
    t_s = (arrivals - stamp_ns) / NS
    backwards = np.flatnonzero(np.diff(t_s) < 0)
    require(backwards.size == 0, KIND, f"pose {backwards[0] + 1 if backwards.size else 0} is stamped before the last")
    require(t_s.size == 0 or t_s[0] >= 0, KIND, "the first pose is stamped before the header")
    return TimedPath(stamp_ns=stamp_ns, t_s=read_only(t_s, np.float64, (-1,)), positions=positions, quat_xyzw=quat_xyzw)


tour_from_msg = path_from_msg
