# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Keypoints asked for "near here": where the importance node finds the place and has the sequencer insert it."""

from __future__ import annotations

import dataclasses
import logging
from collections import deque
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from walk_building.errors import WalkError
from walk_ros.conversions.edits import (
    Change,
    EditResult,
    KeypointEdit,
    Outcome,
    edit_from_msg,
    edit_result_to_msg,
    edit_to_msg,
)
from walk_ros.conversions.poses import Poses, keypoints_from_msg
from walk_ros.errors import MessageError
from walk_ros.node import WalkNode
from walk_ros.results import NO_POINTS, NO_TURNS
from walk_ros.worker import Worker

_log = logging.getLogger(__name__)

Place = tuple[NDArray[np.float64], NDArray[np.float64]]
"""An eye position (3,) [m] and a view direction (4,) xyzw."""

Find = Callable[[NDArray[np.float64], NDArray[np.float64]], Place]
"""Finds the place near a point (3,) beside the keypoints there are (K, 3); raises WalkError with the reason if none."""


class NearDesk:
    """Turns each edit of kind INSERT_NEAR into an INSERT at the place found, or refuses it.

    In a thread of its own: the node's worker may be busy with a map for minutes, and who asks waits for an answer.
    """

    def __init__(self, node: WalkNode, find: Find) -> None:
        """Subscribes to the sequencer's requests and to the keypoints, and starts the thread."""
        self._node = node
        self._find = find
        self._waiting: deque[KeypointEdit] = deque()
        self._keypoints = Poses(stamp_ns=0, positions=NO_POINTS, quat_xyzw=NO_TURNS)
        self._worker = Worker(f"{node.get_name()} near desk", self._step, self._failed)
        node.offer("keypoint_edits", "near/refusals")
        node.take_in("near/requests", self._store)
        node.take_in("keypoints", self._store_keypoints)
        self._worker.start()

    def stop(self, timeout_s: float) -> None:
        """Ends the thread."""
        self._worker.stop(timeout_s)

    def _store(self, msg: Any) -> None:
        edit = edit_from_msg(msg)
        if edit.change is not Change.INSERT_NEAR:
            raise MessageError("InteractiveMarkerFeedback", f"menu_entry_id is not {Change.INSERT_NEAR.value}")
        self._waiting.append(edit)
        self._worker.wake()

    def _store_keypoints(self, msg: Any) -> None:
        self._keypoints = keypoints_from_msg(msg)

    def _step(self) -> None:
        while self._waiting:
            edit, keypoints = self._waiting[0], self._keypoints
            try:
                position, quat_xyzw = self._find(edit.position, keypoints.positions)
            except WalkError as error:
                self._refuse(edit, str(error), keypoints.stamp_ns)
            else:
                # The same client and stamp, so that the sequencer's answer is the answer to what was asked.
                found = dataclasses.replace(edit, change=Change.INSERT, position=position, quat_xyzw=quat_xyzw)
                self._node.publish("keypoint_edits", edit_to_msg(found))
            self._waiting.popleft()

    def _refuse(self, edit: KeypointEdit, reason: str, revision_ns: int) -> None:
        result = EditResult(
            outcome=Outcome.REFUSED,
            keypoint=str(edit.keypoint) if edit.keypoint >= 0 else "",
            client_id=edit.client_id,
            reason=reason,
            revision_ns=revision_ns,
            edit_stamp_ns=edit.stamp_ns,
        )
        self._node.publish("near/refusals", edit_result_to_msg(result))

    def _failed(self, error: Exception) -> None:
        _log.error("a keypoint near a place could not be found", exc_info=error)
        if self._waiting:
            self._refuse(self._waiting.popleft(), f"{type(error).__name__}: {error}", self._keypoints.stamp_ns)
            self._worker.wake()
