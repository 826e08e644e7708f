# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Edits that the importance node answers first: whoever asked gets an answer also where there is no such node."""

from __future__ import annotations

from collections.abc import Callable

from rclpy.clock import Clock, ClockType

from walk_ros.conversions.edits import KeypointEdit, edit_result_from_msg
from walk_ros.errors import MessageError
from walk_ros.node import WalkNode
from walk_ros.raw import from_bytes
from walk_ros.topics import TOPICS, type_name

PATIENCE_S = 3.0
"""How long the importance node may take; it answers within milliseconds where it is."""

_EVERY_S = 0.25
_KEPT = 1000  # requests that insertions are compared with; a recording plays both within moments
_SUGGESTED = "suggested_keypoints"
_RESULTS = "edit_results"

Refuse = Callable[[KeypointEdit, str], None]


class NearWatch:
    """Remembers the edits of kind INSERT_NEAR that were heard until somebody has answered them.

    They are refused at once where nobody publishes suggestions, and after `PATIENCE_S` where somebody did but is
    silent, as a node that was killed or a recording that is replayed.
    """

    def __init__(self, node: WalkNode, refuse: Refuse) -> None:
        """Listens for the answers of the importance node."""
        self._node = node
        self._refuse = refuse
        self._heard: list[tuple[KeypointEdit, float]] = []
        self._due: dict[tuple[str, int], int] = {}  # insertions still to be made of each request, by client and stamp
        # As bytes: it hears its own node's answers too, up to 90 a second, and reads them only while it waits.
        spec = TOPICS[_RESULTS]
        node.create_subscription(spec.type, _RESULTS, self._store_result, spec.qos, raw=True)
        node.create_timer(_EVERY_S, self._look, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def wait_for(self, edit: KeypointEdit) -> None:
        """Waits for the answer to an edit, or refuses it where nobody is there to give one."""
        if edit.stamp_ns:
            key = (edit.client_id, edit.stamp_ns)
            self._due[key] = self._due.pop(key, 0) + 1
            if len(self._due) > _KEPT:
                del self._due[next(iter(self._due))]
        if self._node.count_publishers(_SUGGESTED):
            self._heard.append((edit, self._node.now_s()))
        else:
            self._refuse(edit, "no importance node runs, which finds the place: start it, or insert exactly here")

    def inserts_again(self, edit: KeypointEdit) -> bool:
        """Notes an insertion; returns whether it is one too many for the edits of kind INSERT_NEAR it is made of.

        A recording holds such an edit and the insertion it became, of the same client and stamp. Played into another
        graph, the edit becomes an insertion there as well: the first of the two counts, the other is the same edit.
        """
        key = (edit.client_id, edit.stamp_ns)
        if self._due.get(key) == 0:
            return True
        if key in self._due:
            self._due[key] -= 1
        self.answered(*key)
        return False

    def answered(self, client_id: str, stamp_ns: int) -> None:
        """Forgets an edit that has an answer: the insertion made of it, or a refusal."""
        for k, (edit, _) in enumerate(self._heard):
            if (edit.client_id, edit.stamp_ns) == (client_id, stamp_ns):
                del self._heard[k]
                return

    def _look(self) -> None:
        late = [edit for edit, came_s in self._heard if self._node.now_s() - came_s > PATIENCE_S]
        for edit in late:
            self.answered(edit.client_id, edit.stamp_ns)
            self._refuse(edit, f"the importance node has not found a place within {PATIENCE_S:g} s: see /diagnostics")

    def _store_result(self, data: bytes) -> None:
        if self._heard:
            try:
                result = edit_result_from_msg(from_bytes(data, type_name(TOPICS[_RESULTS].type)))
            except MessageError:
                return
            self.answered(result.client_id, result.edit_stamp_ns)
