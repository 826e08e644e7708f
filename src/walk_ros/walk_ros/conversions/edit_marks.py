# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a user has laid down about keypoints, as markers beside the arrows: look-at, dwell, lock, start and end."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Collection, Mapping

import numpy as np
from geometry_msgs.msg import Pose, Vector3
from numpy.typing import NDArray
from visualization_msgs.msg import Marker, MarkerArray

from walk_ros.conversions.checks import finite_array, require
from walk_ros.conversions.markers import KIND, marker, no_turn, point_msgs, point_rows
from walk_ros.conversions.stamps import header_to_msg

LOOK_AT, DWELL, LOCKED, START, END = "look_at", "dwell", "locked", "start", "end"
_KINDS = {
    LOOK_AT: Marker.SPHERE,
    DWELL: Marker.TEXT_VIEW_FACING,
    LOCKED: Marker.CUBE,
    START: Marker.TEXT_VIEW_FACING,
    END: Marker.TEXT_VIEW_FACING,
}
_ABOVE_M = {LOOK_AT: 0.0, DWELL: 0.4, LOCKED: 0.15, START: 0.25, END: 0.25}
_ORANGE = (0.95, 0.60, 0.10)
_SIZE_M = 0.12
_DWELL_TEXT = re.compile(r"([0-9.e+-]+) s")


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class KeypointMarks:
    """What is laid down, by identity."""

    look_at: Mapping[int, NDArray[np.float64]] = dataclasses.field(default_factory=dict)  # (3,) [m]
    dwell_s: Mapping[int, float] = dataclasses.field(default_factory=dict)
    locked: frozenset[int] = frozenset()
    start: int = -1
    end: int = -1

    def names(self) -> set[tuple[str, int]]:
        """Returns namespace and number of each marker."""
        ends = {(name, identity) for name, identity in ((START, self.start), (END, self.end)) if identity >= 0}
        locked = {(LOCKED, i) for i in self.locked}
        return {(LOOK_AT, i) for i in self.look_at} | {(DWELL, i) for i in self.dwell_s} | locked | ends


def keypoint_marks_to_msgs(
    marks: KeypointMarks,
    eyes: Mapping[int, NDArray[np.float64]],
    stamp_ns: int,
    shown: Collection[tuple[str, int]] = (),
) -> list[Marker]:
    """Returns the markers to append to those of the keypoints.

    Args:
        marks: What is laid down.
        eyes: Where each keypoint is, (3,) by identity [m].
        stamp_ns: The revision.
        shown: Markers shown before, by namespace and number: a DELETE for each that is gone.
    """
    names = marks.names()
    markers = [_marker(marks, eyes, stamp_ns, *name) for name in sorted(names)]
    for namespace, number in sorted(set(shown) - names):
        header = header_to_msg(stamp_ns)
        markers.append(Marker(header=header, ns=namespace, id=number, action=Marker.DELETE))
    return markers


def keypoint_marks_from_msg(msg: MarkerArray) -> KeypointMarks:
    """Returns what the markers of the keypoints say about them; raises MessageError if it is not sound."""
    shown = {name: [m for m in msg.markers if m.action == Marker.ADD and m.ns == name] for name in _KINDS}
    points = finite_array(KIND, "look-at point", point_rows([m.pose.position for m in shown[LOOK_AT]]), 3)
    ends = {}
    for name in (START, END):
        require(len(shown[name]) <= 1, KIND, f"{len(shown[name])} keypoints are the {name}")
        ends[name] = shown[name][0].id if shown[name] else -1
    return KeypointMarks(
        look_at={int(m.id): point for m, point in zip(shown[LOOK_AT], points, strict=True)},
        dwell_s={int(m.id): _dwell(m.text) for m in shown[DWELL]},
        locked=frozenset(int(m.id) for m in shown[LOCKED]),
        start=ends[START],
        end=ends[END],
    )


def _marker(
    marks: KeypointMarks, eyes: Mapping[int, NDArray[np.float64]], stamp_ns: int, namespace: str, number: int
) -> Marker:
    mark = marker(stamp_ns, namespace, number, _KINDS[namespace], _ORANGE)
    place = marks.look_at[number] if namespace == LOOK_AT else eyes[number]
    (point,) = point_msgs(np.asarray(place)[None] + [0.0, 0.0, _ABOVE_M[namespace]])
    mark.pose = Pose(position=point, orientation=no_turn())
    mark.scale = Vector3(x=_SIZE_M, y=_SIZE_M, z=_SIZE_M)
    if namespace == DWELL:
        mark.text = f"{marks.dwell_s[number]!r} s"
    elif namespace in (START, END):
        mark.text = namespace
    return mark


def _dwell(text: str) -> float:
    found = _DWELL_TEXT.fullmatch(text)
    try:
        dwell = float(found[1]) if found else float("nan")
    except ValueError:
        dwell = float("nan")
    require(bool(np.isfinite(dwell)) and dwell >= 0.0, KIND, f"dwell is {text!r}; expected seconds")
    return dwell
