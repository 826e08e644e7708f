# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The planned legs between pairs of keypoints as a MarkerArray: a LINE_STRIP each."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterable, Sequence
from typing import Protocol

import numpy as np
from geometry_msgs.msg import Vector3
from numpy.typing import NDArray
from visualization_msgs.msg import Marker, MarkerArray

from walk_ros.conversions.checks import finite_array, require
from walk_ros.conversions.markers import KIND, marker, markers_stamp, no_turn, point_msgs, point_rows
from walk_ros.conversions.stamps import header_to_msg

LEGS = "legs"
NO_WAY = "no_way"
GREEN, RED = (0.25, 0.65, 0.30), (0.85, 0.15, 0.10)
WIDTH_M, WORD_M = 0.03, 0.2
_LEG_TEXT = re.compile(r"(-?\d+) to (-?\d+): ([0-9.e+-]+) m")
_NO_WAY_TEXT = re.compile(r"(-?\d+) to (-?\d+): (.+)")


class LegLike(Protocol):
    """What a leg has: walk_sequencer's result, or one that came in as a message."""

    @property
    def start(self) -> int:
        """Index of the keypoint it leaves."""

    @property
    def goal(self) -> int:
        """Index of the keypoint it reaches."""

    @property
    def points(self) -> NDArray[np.float64]:
        """(m, 3) eye positions [m]."""

    @property
    def length_m(self) -> float:
        """Length [m]."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class ReceivedLeg:
    """A planned walk that came in as a message; `start` and `goal` are identities of keypoints."""

    start: int
    goal: int
    points: NDArray[np.float64]  # (m, 3) eye positions [m]
    length_m: float


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class ReceivedLegs:
    """All planned pairs of a revision."""

    stamp_ns: int
    legs: tuple[ReceivedLeg, ...]
    no_way: tuple[tuple[int, int, str], ...]  # identities of the two, and why there is none


def pairwise_paths_to_msg(
    legs: Iterable[LegLike],
    ids: Sequence[int],
    stamp_ns: int,
    no_way: Iterable[tuple[int, int, str]] = (),
) -> MarkerArray:
    """Returns a LINE_STRIP per leg with "A to B: LENGTH m" as text, and a text marker per pair without a way.

    A leading DELETEALL takes away what was shown before, and stamps a set without legs.

    Args:
        legs: `start` and `goal` index `ids`.
        ids: (K,) identities of the keypoints.
        stamp_ns: The revision.
        no_way: Indices of two keypoints and the reason.
    """
    markers = [Marker(header=header_to_msg(stamp_ns), action=Marker.DELETEALL)]
    for number, leg in enumerate(legs):
        line = marker(stamp_ns, LEGS, number, Marker.LINE_STRIP, GREEN)
        line.pose.orientation, line.scale = no_turn(), Vector3(x=WIDTH_M)
        line.points = point_msgs(leg.points)
        line.text = f"{ids[leg.start]} to {ids[leg.goal]}: {leg.length_m!r} m"
        markers.append(line)
    for number, (start, goal, reason) in enumerate(no_way):
        text = marker(stamp_ns, NO_WAY, number, Marker.TEXT_VIEW_FACING, RED)
        text.pose.orientation, text.scale = no_turn(), Vector3(z=WORD_M)
        text.text = f"{ids[start]} to {ids[goal]}: {reason}"
        markers.append(text)
    return MarkerArray(markers=markers)


def pairwise_paths_from_msg(msg: MarkerArray) -> ReceivedLegs:
    """Returns the legs and the pairs without a way; raises MessageError if they are not sound."""
    stamp_ns = markers_stamp(msg)
    shown = [m for m in msg.markers if m.action == Marker.ADD]
    legs, no_way = [], []
    for strip in (m for m in shown if m.ns == LEGS):
        found = _LEG_TEXT.fullmatch(strip.text)
        require(found is not None, KIND, f"text {strip.text!r} names no pair and length")
        assert found is not None
        points = finite_array(KIND, "point", point_rows(strip.points), 3)
        start, goal, length = found.groups()
        legs.append(ReceivedLeg(start=int(start), goal=int(goal), points=points, length_m=_length(length)))
    for text in (m for m in shown if m.ns == NO_WAY):
        found = _NO_WAY_TEXT.fullmatch(text.text)
        require(found is not None, KIND, f"text {text.text!r} names no pair and reason")
        assert found is not None
        no_way.append((int(found[1]), int(found[2]), found[3]))
    return ReceivedLegs(stamp_ns=stamp_ns, legs=tuple(legs), no_way=tuple(no_way))


def _length(text: str) -> float:
    try:
        length = float(text)
    except ValueError:
        length = float("nan")
    require(bool(np.isfinite(length)) and length >= 0, KIND, f"length is {text!r}; expected metres")
    return length
