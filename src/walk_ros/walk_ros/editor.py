# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The server's side of the interactive-marker protocol: what RViz shows of the keypoints and lets one edit."""

from __future__ import annotations

import dataclasses
import threading
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from visualization_msgs.msg import InteractiveMarker, InteractiveMarkerUpdate
from visualization_msgs.srv import GetInteractiveMarkers

from walk_ros.conversions.edit_markers import interactive_marker_to_msg, interactive_pose_to_msg
from walk_ros.node import WalkNode

UPDATE, FEEDBACK = "keypoint_editor/update", "keypoint_editor/feedback"
SERVICE = "keypoint_editor/get_interactive_markers"


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class EditorRow:
    """A keypoint as the editor shows it."""

    position: tuple[float, ...]  # of the eye [m]
    quat_xyzw: tuple[float, ...]
    description: str
    locked: bool


class KeypointEditor:
    """Tells RViz about the keypoints; each change goes out once, and all of them to who asks.

    The numbers of the updates rise by one: a viewer that missed one asks for all again.
    """

    def __init__(self, node: WalkNode) -> None:
        """Offers the updates and the service under the names that the protocol gives them."""
        self._node = node
        self._rows: dict[int, EditorRow] = {}
        self._markers: dict[int, InteractiveMarker] = {}
        self._number = 0
        self._lock = threading.Lock()
        node.offer(UPDATE)
        node.create_service(GetInteractiveMarkers, SERVICE, self._answer)

    def show(
        self,
        ids: Sequence[int],
        positions: NDArray[np.float64],
        quat_xyzw: NDArray[np.float64],
        labels: Sequence[str],
        locked: frozenset[int],
        stamp_ns: int,
    ) -> None:
        """Shows these keypoints, in the order of the tour; only what is new goes out."""
        rows = {}
        for at, (identity, label) in enumerate(zip(ids, labels, strict=True)):
            position, quat = tuple(positions[at].tolist()), tuple(quat_xyzw[at].tolist())
            name = f"{at + 1}: {label}" if label else str(at + 1)
            rows[identity] = EditorRow(position=position, quat_xyzw=quat, description=name, locked=identity in locked)
        changed = [i for i, row in rows.items() if self._rows.get(i) != row]
        gone = [str(i) for i in self._rows if i not in rows]
        with self._lock:
            for identity in changed:
                row = rows[identity]
                self._markers[identity] = interactive_marker_to_msg(
                    identity, row.position, row.quat_xyzw, row.description, row.locked, stamp_ns
                )
            self._markers = {i: self._markers[i] for i in rows}
            self._rows = rows
            if changed or gone:
                self._send(markers=[self._markers[i] for i in changed], erases=gone)

    def put_back(self, identity: int) -> None:
        """Puts a keypoint's marker back where it belongs, after an edit that was refused."""
        row = self._rows.get(identity)
        if row is not None:
            with self._lock:
                self._send(poses=[interactive_pose_to_msg(identity, row.position, row.quat_xyzw)])

    def _send(self, **content: object) -> None:
        self._number += 1
        update = InteractiveMarkerUpdate(
            server_id=self._node.get_fully_qualified_name(),
            seq_num=self._number,
            type=InteractiveMarkerUpdate.UPDATE,
            **content,
        )
        self._node.publish(UPDATE, update)

    def _answer(
        self, _request: GetInteractiveMarkers.Request, response: GetInteractiveMarkers.Response
    ) -> GetInteractiveMarkers.Response:
        with self._lock:
            response.sequence_number, response.markers = self._number, list(self._markers.values())
        return response
