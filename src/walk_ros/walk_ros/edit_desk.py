# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Where edits come in, over the topic, RViz's protocol and services, and where their answers go out."""

from __future__ import annotations

import dataclasses
import threading
from collections import deque
from typing import Any

from std_srvs.srv import Trigger

from walk_ros.conversions.edits import (
    Change,
    EditKind,
    EditResult,
    KeypointEdit,
    Outcome,
    edit_from_msg,
    edit_result_to_msg,
)
from walk_ros.editor import FEEDBACK
from walk_ros.errors import MessageError
from walk_ros.keypoint_view import KeypointView
from walk_ros.near_watch import NearWatch
from walk_ros.node import WalkNode
from walk_ros.results import NO_POINTS, NO_TURNS
from walk_ros.side_node import SideNode
from walk_ros.worker import REST_S

_ANSWER_S = 5.0
"""How long a service waits for what it asked for; then it says that the answer comes later."""

_REST_S = {EditKind.DRAG: REST_S, EditKind.HOLD: REST_S, EditKind.RELEASE: 0.02}
"""How long edits wait that trajopt shows: it, bridge and page need the cores first, at a release until it is drawn."""


@dataclasses.dataclass(slots=True, kw_only=True)
class Asked:
    """An edit that waits for its answer."""

    edit: KeypointEdit
    came_s: float
    due_s: float  # when it is worked on
    from_editor: bool = False  # whether it came over RViz's protocol
    answered: threading.Event = dataclasses.field(default_factory=threading.Event)
    refused: str = ""  # the reason, once it is answered


class EditDesk:
    """Queues edits for the node's worker and publishes what became of each.

    Attributes:
        waiting: In the order they came; the worker takes one off once it is answered.
    """

    def __init__(self, node: WalkNode, view: KeypointView) -> None:
        """Subscribes to edits and offers their answers and the services `undo` and `redo`."""
        self._node = node
        self._view = view
        self.waiting: deque[Asked] = deque()
        self._near = NearWatch(node, self._refuse_near)
        node.offer("edit_results")
        node.take_in("keypoint_edits", self._store)
        node.take_in(FEEDBACK, lambda msg: self._store(msg, from_editor=True))
        self._services = SideNode(node, "services")
        self._services.offer(Trigger, "undo", lambda _request, response: self._change(Change.UNDO, response))
        self._services.offer(Trigger, "redo", lambda _request, response: self._change(Change.REDO, response))
        self._services.start()

    def due(self) -> Asked | None:
        """Returns the first edit that waits once its time has come, else None; the worker is then woken in time."""
        if not self.waiting:
            return None
        left_s = self.waiting[0].due_s - self._node.now_s()
        if left_s <= 0:
            return self.waiting[0]
        self._node.worker.wake(rest_s=left_s)
        return None

    def stop(self) -> None:
        """Ends the services."""
        self._services.stop()

    def reply(self, asked: Asked, outcome: Outcome, reason: str, keypoint: int = -1, saves_m: float = 0.0) -> None:
        """Answers an edit.

        Args:
            asked: The edit.
            outcome: What became of it.
            reason: Why it was refused, "" otherwise.
            keypoint: Identity of the keypoint it was about in the end; -1 takes the edit's own.
            saves_m: By how much another order would shorten the tour [m].
        """
        edit = asked.edit
        named = keypoint if keypoint >= 0 else edit.keypoint
        refused = outcome is Outcome.REFUSED
        self._say(str(named) if named >= 0 else "", edit.client_id, outcome, reason, edit.stamp_ns, saves_m)
        if refused and edit.kind is not EditKind.DRAG:
            self._view.put_back(edit.keypoint)
        asked.refused = reason if refused else ""
        asked.answered.set()

    def refuse_all(self, reason: str) -> None:
        """Refuses every edit that waits."""
        while self.waiting:
            self.reply(self.waiting.popleft(), Outcome.REFUSED, reason)

    def _say(
        self, name: str, client_id: str, outcome: Outcome, reason: str, stamp_ns: int = 0, saves_m: float = 0.0
    ) -> None:
        result = EditResult(
            outcome=outcome,
            keypoint=name,
            client_id=client_id,
            reason=reason,
            revision_ns=self._view.revision_ns,
            edit_stamp_ns=stamp_ns,
            better_order_saves_m=saves_m,
        )
        self._node.publish("edit_results", edit_result_to_msg(result))

    def _store(self, msg: Any, from_editor: bool = False) -> None:
        try:
            edit = edit_from_msg(msg)
        except MessageError as error:
            self._say(msg.marker_name, msg.client_id, Outcome.REFUSED, error.reason)
            raise
        if edit.change is Change.INSERT_NEAR:
            self._near.wait_for(edit)
            return
        if edit.change is not Change.INSERT or not self._near.inserts_again(edit):
            self._queue(edit, from_editor)

    def _refuse_near(self, edit: KeypointEdit, reason: str) -> None:
        name = str(edit.keypoint) if edit.keypoint >= 0 else ""
        self._say(name, edit.client_id, Outcome.REFUSED, reason, edit.stamp_ns)

    def _queue(self, edit: KeypointEdit, from_editor: bool = False) -> Asked:
        now_s, rest_s = self._node.now_s(), _REST_S.get(edit.kind, 0.0)
        asked = Asked(edit=edit, came_s=now_s, due_s=now_s + rest_s, from_editor=from_editor)
        self.waiting.append(asked)
        self._node.worker.wake(rest_s=rest_s)
        return asked

    def _change(self, change: Change, response: Trigger.Response) -> Trigger.Response:
        """Has a change done for a service and waits for it: what it confirms is in the journal."""
        edit = KeypointEdit(
            kind=EditKind.CHANGE,
            keypoint=-1,
            client_id="service",
            stamp_ns=self._node.get_clock().now().nanoseconds,
            position=NO_POINTS,
            quat_xyzw=NO_TURNS,
            change=change,
        )
        asked = self._queue(edit)
        done = asked.answered.wait(_ANSWER_S)
        response.success = done and not asked.refused
        response.message = asked.refused if done else "not done yet: edit_results will tell"
        return response
