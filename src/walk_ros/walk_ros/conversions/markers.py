# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Keypoints as RViz shows and tells them apart: an arrow each, with a stable identity and a label."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from geometry_msgs.msg import Point, Quaternion, Vector3
from numpy.typing import ArrayLike, NDArray
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from walk_ros.conversions.checks import require
from walk_ros.conversions.poses import Poses, pose_arrays, pose_msgs
from walk_ros.conversions.stamps import header_from_msg, header_to_msg

KIND = "visualization_msgs/MarkerArray"
KEYPOINTS = "keypoints"
LEFT_OUT = "unreachable"

_ARROW = (0.45, 0.08, 0.08)
_BLUE = (0.10, 0.45, 0.85)
_RED = (0.85, 0.15, 0.10)


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class LabelledKeypoints:
    """Keypoints in tour order with their identities, of one revision."""

    poses: Poses
    ids: tuple[int, ...]  # (K,) stable identities
    labels: tuple[str, ...]  # (K,)
    left_out: tuple[tuple[int, str], ...]  # identity and reason of each keypoint that the tour leaves out


def marker(stamp_ns: int, namespace: str, number: int, kind: int, colour: tuple[float, float, float]) -> Marker:
    """Returns a marker without shape: the caller fills in what its kind needs."""
    red, green, blue = (float(np.float32(c)) for c in colour)
    return Marker(
        header=header_to_msg(stamp_ns),
        ns=namespace,
        id=number,
        type=kind,
        action=Marker.ADD,
        color=ColorRGBA(r=red, g=green, b=blue, a=1.0),
    )


def keypoint_markers_to_msg(
    positions: ArrayLike,
    quat_xyzw: ArrayLike,
    ids: Sequence[int],
    labels: Sequence[str],
    stamp_ns: int,
    *,
    left_out: Iterable[tuple[int, NDArray[np.float64], str]] = (),
    removed: Iterable[int] = (),
) -> MarkerArray:
    """Returns an arrow per keypoint, at the index it has in `keypoints`; its id is its identity, its text its label.

    Behind them come those the tour leaves out (identity, position, reason), in red with the reason as text, and a
    DELETE for each identity in `removed`, so that a viewer drops what it was shown before.
    """
    markers = []
    for pose, number, label in zip(pose_msgs(positions, quat_xyzw), ids, labels, strict=True):
        arrow = marker(stamp_ns, KEYPOINTS, int(number), Marker.ARROW, _BLUE)
        arrow.pose, arrow.text = pose, label
        arrow.scale = Vector3(x=_ARROW[0], y=_ARROW[1], z=_ARROW[2])
        markers.append(arrow)
    for number, position, reason in left_out:
        text = marker(stamp_ns, LEFT_OUT, int(number), Marker.TEXT_VIEW_FACING, _RED)
        (text.pose,) = pose_msgs([position], [[0.0, 0.0, 0.0, 1.0]])
        text.text, text.scale = reason, Vector3(z=0.2)
        markers.append(text)
    for number in removed:
        for namespace in (KEYPOINTS, LEFT_OUT):
            gone = marker(stamp_ns, namespace, int(number), Marker.ARROW, _RED)
            gone.action = Marker.DELETE
            markers.append(gone)
    return MarkerArray(markers=markers) if markers else cleared(stamp_ns)


def cleared(stamp_ns: int) -> MarkerArray:
    """Returns an empty, stamped set of markers: one DELETEALL."""
    return MarkerArray(markers=[Marker(header=header_to_msg(stamp_ns), action=Marker.DELETEALL)])


def keypoint_markers_from_msg(msg: MarkerArray) -> LabelledKeypoints:
    """Returns the keypoints of their markers; raises MessageError if they are not sound."""
    stamp_ns = markers_stamp(msg)
    shown = [m for m in msg.markers if m.action == Marker.ADD]
    keypoints = [m for m in shown if m.ns == KEYPOINTS]
    ids = tuple(int(m.id) for m in keypoints)
    require(len(set(ids)) == len(ids), KIND, "two keypoints have the same identity")
    positions, quat_xyzw = pose_arrays(KIND, [m.pose for m in keypoints])
    return LabelledKeypoints(
        poses=Poses(stamp_ns=stamp_ns, positions=positions, quat_xyzw=quat_xyzw),
        ids=ids,
        labels=tuple(str(m.text) for m in keypoints),
        left_out=tuple((int(m.id), str(m.text)) for m in shown if m.ns == LEFT_OUT),
    )


def markers_stamp(msg: MarkerArray) -> int:
    """Returns the revision [ns] that all markers of a set share; raises MessageError if they do not."""
    require(len(msg.markers) > 0, KIND, "no markers; an empty set is one DELETEALL marker")
    stamps = {header_from_msg(m.header, KIND) for m in msg.markers if m.action != Marker.DELETEALL or m.header.frame_id}
    require(len(stamps) == 1, KIND, f"{len(stamps)} different stamps; expected one")
    return stamps.pop()


def point_msgs(points: NDArray[np.float64]) -> list[Point]:
    """Returns a Point per row of (n, 3)."""
    return [Point(x=p[0], y=p[1], z=p[2]) for p in np.asarray(points, float).tolist()]


def no_turn() -> Quaternion:
    """Returns the unit quaternion; the default one of a message is all zero."""
    return Quaternion(x=0.0, y=0.0, z=0.0, w=1.0)


def point_rows(points: Any) -> list[tuple[float, float, float]]:
    """Returns the coordinates of Point messages."""
    return [(p.x, p.y, p.z) for p in points]
