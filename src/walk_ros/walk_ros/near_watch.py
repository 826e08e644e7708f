# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Edits that the importance node finds the place for: whoever asked gets an answer also where there is no such node."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy.clock import Clock, ClockType

from walk_ros.conversions.edits import KeypointEdit, edit_result_from_msg, edit_to_msg
from walk_ros.node import WalkNode

PATIENCE_S = 3.0
"""How long the importance node may take; it answers within milliseconds where it is."""

_EVERY_S = 0.25
_KEPT = 1000  # requests that insertions are compared with; a recording plays both within moments

Refuse = Callable[[KeypointEdit, str], None]


class NearWatch:
    """Hands the edits of kind INSERT_NEAR on to the importance node and remembers them until they are answered.

    So that node need not hear ninety drags a second that are not for it. They are refused at once where nobody hears
    such requests, and after `PATIENCE_S` where somebody did but is silent, as a node that was killed.
    """

    def __init__(self, node: WalkNode, refuse: Refuse) -> None:
        """Listens for what the importance node refuses; what it finds comes as an insertion.

        Args:
            node: Where edits are heard.
            refuse: Answers an edit with a reason.
        """
        self._node = node
        self._refuse = refuse
        self._heard: list[tuple[KeypointEdit, float]] = []
        self._due: dict[tuple[str, int], int] = {}  # insertions still to be made of each request, by client and stamp
        node.offer("near/requests")
        node.take_in("near/refusals", self._store_refusal)
        node.create_timer(_EVERY_S, self._look, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def wait_for(self, edit: KeypointEdit) -> None:
        """Waits for the answer to an edit, or refuses it where nobody is there to give one."""
        if edit.stamp_ns:
            key = (edit.client_id, edit.stamp_ns)
            self._due[key] = self._due.pop(key, 0) + 1
            if len(self._due) > _KEPT:
                del self._due[next(iter(self._due))]
        if self._node.count_subscribers("near/requests"):
            self._heard.append((edit, self._node.now_s()))
            self._node.publish("near/requests", edit_to_msg(edit))
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

    def answered(self, client_id: str, stamp_ns: int) -> KeypointEdit | None:
        """Forgets an edit that has an answer, the insertion made of it or a refusal; returns it if it waited."""
        for k, (edit, _) in enumerate(self._heard):
            if (edit.client_id, edit.stamp_ns) == (client_id, stamp_ns):
                del self._heard[k]
                return edit
        return None

    def _look(self) -> None:
        late = [edit for edit, came_s in self._heard if self._node.now_s() - came_s > PATIENCE_S]
        for edit in late:
            self.answered(edit.client_id, edit.stamp_ns)
            self._refuse(edit, f"the importance node has not found a place within {PATIENCE_S:g} s: see /diagnostics")

    def _store_refusal(self, msg: Any) -> None:
        result = edit_result_from_msg(msg)
        edit = self.answered(result.client_id, result.edit_stamp_ns)
        if edit is not None:
            self._refuse(edit, result.reason)
