# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What the graph sees of the keypoints: arrows, what is laid down about them, the tour, and RViz's editor."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from walk_ros.conversions.edit_marks import KeypointMarks, keypoint_marks_to_msgs
from walk_ros.editor import KeypointEditor
from walk_ros.node import WalkNode
from walk_ros.results import NO_POINTS, NO_TURNS, TourLike, leg_bytes, stand_bytes, tour_messages


class KeypointsLike(Protocol):
    """What keypoints have."""

    @property
    def ids(self) -> tuple[int, ...]:
        """Stable identities."""

    @property
    def positions(self) -> NDArray[np.float64]:
        """(K, 3) where they are wished [m]."""

    @property
    def quat_xyzw(self) -> NDArray[np.float64]:
        """(K, 4) view directions."""

    @property
    def dwell_s(self) -> NDArray[np.float64]:
        """(K,) nan where nothing is laid down [s]."""

    @property
    def look_at(self) -> NDArray[np.float64]:
        """(K, 3) nan where nothing is laid down [m]."""

    @property
    def locked(self) -> frozenset[int]:
        """Identities."""

    @property
    def start(self) -> int:
        """Identity, -1 where it is free."""

    @property
    def end(self) -> int:
        """Identity, -1 where it is free."""


class PlannedLike(Protocol):
    """One revision: keypoints, and the tour through them."""

    @property
    def keypoints(self) -> KeypointsLike:
        """The keypoints; row k of every array is keypoint k of the tour."""

    @property
    def tour(self) -> TourLike:
        """The tour."""

    @property
    def labels(self) -> Sequence[str]:
        """(K,) what a viewer writes beside them."""

    def eyes(self) -> NDArray[np.float64]:
        """Returns where each keypoint is (K, 3)."""


class KeypointView:
    """Publishes revisions of the keypoints and remembers what is shown, so that what is gone is taken away.

    Attributes:
        revision_ns: Stamp of the last revision shown, 0 before the first.
    """

    def __init__(self, node: WalkNode) -> None:
        """Offers keypoints, markers, legs and the tour, and RViz's editor."""
        self._node = node
        self._shown: set[int] = set()
        self._marks: set[tuple[str, int]] = set()
        self.revision_ns = 0
        node.offer("keypoints", "keypoint_markers", "pairwise_paths", "tour")
        self._editor = KeypointEditor(node)

    def show(self, planned: PlannedLike) -> None:
        """Publishes a new revision, all but the legs of all pairs."""
        keypoints = planned.keypoints
        stamp = self.revision_ns = self._node.revision()
        gone = sorted(self._shown - set(keypoints.ids))
        self._shown = set(keypoints.ids)
        rows = (keypoints.positions, keypoints.quat_xyzw, keypoints.ids, planned.labels)
        messages = stand_bytes(planned.tour, *rows, stamp, gone)
        eyes = planned.eyes()
        marks = _marks_of(keypoints)
        markers = next(msg for topic, msg in messages if topic == "keypoint_markers")
        by_id = dict(zip(keypoints.ids, eyes, strict=True))
        markers.markers += keypoint_marks_to_msgs(marks, by_id, stamp, self._marks)
        self._marks = marks.names()
        self._node.publish_all(messages)
        self._editor.show(keypoints.ids, eyes, keypoints.quat_xyzw, planned.labels, keypoints.locked, stamp)

    def show_legs(self, planned: PlannedLike) -> None:
        """Publishes the legs of all pairs of the last revision."""
        self._node.publish_all([leg_bytes(planned.tour, planned.keypoints.ids, self.revision_ns)])

    def clear(self, stamp_ns: int) -> None:
        """Publishes no keypoints and an empty tour."""
        nothing = tour_messages(None, NO_POINTS, NO_TURNS, (), (), stamp_ns, sorted(self._shown))
        self._node.publish_all(nothing)
        self._shown, self._marks = set(), set()
        self._editor.show((), NO_POINTS, NO_TURNS, (), frozenset(), stamp_ns)

    def put_back(self, identity: int) -> None:
        """Puts a keypoint's marker back where it belongs, after an edit that was refused."""
        self._editor.put_back(identity)


def _marks_of(keypoints: KeypointsLike) -> KeypointMarks:
    rows = list(enumerate(keypoints.ids))
    return KeypointMarks(
        look_at={i: keypoints.look_at[k] for k, i in rows if np.isfinite(keypoints.look_at[k]).all()},
        dwell_s={i: float(keypoints.dwell_s[k]) for k, i in rows if np.isfinite(keypoints.dwell_s[k])},
        locked=keypoints.locked,
        start=keypoints.start,
        end=keypoints.end,
    )
