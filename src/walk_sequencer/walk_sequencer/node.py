# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The sequencer as a node: the authority over the keypoints, their order and the tour through them."""

from __future__ import annotations

import dataclasses
import sys
import threading
from collections import deque
from pathlib import Path
from typing import Any

import numpy as np
from std_srvs.srv import Trigger

from walk_building.building import Building
from walk_building.errors import WalkError
from walk_ros.conversions import (
    Change,
    EditKind,
    EditResult,
    KeypointEdit,
    KeypointMarks,
    Outcome,
    Poses,
    edit_from_msg,
    edit_result_to_msg,
    keypoint_marks_to_msgs,
    keypoints_from_msg,
)
from walk_ros.editor import FEEDBACK, KeypointEditor
from walk_ros.errors import MessageError
from walk_ros.holds import Holds
from walk_ros.node import WalkNode
from walk_ros.results import NO_POINTS, NO_TURNS, leg_bytes, stand_messages, tour_messages
from walk_ros.runner import run_node
from walk_sequencer.authority import HALF_WAY, Authority, Planned
from walk_sequencer.config import SequencerConfig
from walk_sequencer.editing import EditingConfig
from walk_sequencer.journal import Journal, default_state_dir
from walk_sequencer.wishes import Wish

_ANSWER_S = 5.0
"""How long a service waits for what it asked for; then it says that the answer comes later."""


@dataclasses.dataclass(slots=True, kw_only=True)
class Asked:
    """An edit that waits for its answer."""

    edit: KeypointEdit
    came_s: float
    from_editor: bool = False  # whether it came over RViz's protocol
    answered: threading.Event = dataclasses.field(default_factory=threading.Event)
    refused: str = ""  # the reason, once it is answered


class SequencerNode(WalkNode):
    """Publishes keypoints, markers, legs and the tour; answers every edit."""

    def __init__(self) -> None:
        super().__init__("sequencer", {"sequencer": SequencerConfig, "editing": EditingConfig})
        self.declare_text("state_dir", str(default_state_dir()), "folder for the journal of edits")
        self._authority: Authority | None = None
        self._holds = Holds()
        self._edits: deque[Asked] = deque()
        self._last_stamp: dict[int, int] = {}
        self._suggested: Poses | None = None
        self._replan = False
        self._planned_with: SequencerConfig | None = None
        self._shown: set[int] = set()
        self._marks: set[tuple[str, int]] = set()
        self._revision_ns = 0
        self.offer("keypoints", "keypoint_markers", "pairwise_paths", "tour", "edit_results")
        self.take_in("suggested_keypoints", self._store_suggestion)
        self.take_in("keypoint_edits", self._store_edit)
        self.take_in(FEEDBACK, lambda msg: self._store_edit(msg, from_editor=True))
        self._editor = KeypointEditor(self)
        self.create_service(Trigger, "replan", self._answer_replan)
        self.create_service(Trigger, "undo", lambda _request, response: self._answer_change(Change.UNDO, response))
        self.create_service(Trigger, "redo", lambda _request, response: self._answer_change(Change.REDO, response))
        self.start()

    def work(self, building: Building) -> None:
        """Takes over suggestions, answers the edits in the order they came, plans what has changed."""
        authority = self._authority or self._open(building)
        suggested = self._suggested
        if suggested is not None:
            authority.adopt(suggested.positions, suggested.quat_xyzw)
        config = self.parameters.get("sequencer", SequencerConfig)
        anew, self._replan = self._replan or self._planned_with not in (None, config), False
        if authority.keypoints.ids and (authority.planned is None or anew):
            began = self.now_s()
            self.diagnostics.state("planning")
            authority.plan(config, self.worker.progress, anew=anew)
            self._planned_with = config
            self.diagnostics.latency(self.now_s() - began)
            self._publish(authority)
            self._publish_legs(authority)
        before = self._revision_ns
        while self._edits:
            # Taken off only once it is answered: a step that is superseded begins with it again.
            self._answer(authority, self._edits[0], config)
            self._edits.popleft()
        if self._revision_ns != before:
            self._publish_legs(authority)
        if not authority.keypoints.ids:
            self.diagnostics.state("waiting", "no keypoints yet: waiting for suggested_keypoints")

    def forget(self) -> None:
        """Drops the keypoints of another building; its suggestions are not for this one."""
        self._authority = None
        self._planned_with = None

    def fail(self, stamp_ns: int) -> None:
        """Publishes no keypoints and an empty tour."""
        self.publish_all(tour_messages(None, NO_POINTS, NO_TURNS, (), (), stamp_ns, sorted(self._shown)))
        self._shown, self._marks = set(), set()
        self._editor.show((), NO_POINTS, NO_TURNS, (), frozenset(), stamp_ns)
        if self._authority is not None:
            # Nothing is shown now, so the next step plans and publishes again, whatever it is about.
            self._authority.planned = None
        while self._edits:
            self._reply(self._edits.popleft(), Outcome.REFUSED, "the sequencer has no tour: see /diagnostics")

    def supersedes(self, groups: frozenset[str]) -> bool:
        """Returns whether a change of these groups makes the running step pointless."""
        return "sequencer" in groups

    def _open(self, building: Building) -> Authority:
        journal = Journal(Path(str(self.get_parameter("state_dir").value)), building.hash)
        if not self._editing().restore:
            journal.put_aside()
        self._authority = Authority(building, journal)
        self._holds, self._last_stamp = Holds(), {}
        return self._authority

    def _answer(self, authority: Authority, asked: Asked, config: SequencerConfig) -> None:
        edit = asked.edit
        known = authority.keypoints.index(edit.keypoint) >= 0
        if edit.kind is EditKind.HOLD:
            if known:
                self._take(edit)
            return
        reason = "" if known or edit.keypoint < 0 else f"there is no keypoint {edit.keypoint}"
        reason = reason or self._too_late(edit) or self._take(edit)
        if not reason and edit.kind in (EditKind.GRAB, EditKind.DRAG) and edit.keypoint in authority.keypoints.locked:
            reason = f"keypoint {edit.keypoint} is locked: unlock it first"
        if reason or edit.kind in (EditKind.GRAB, EditKind.DRAG):
            self._reply(asked, Outcome.REFUSED if reason else Outcome.FOLLOWED, reason)
            return
        self._holds.release(edit.keypoint, edit.client_id)
        try:
            answer = authority.edit(_wish(asked), config, self._editing())
        except WalkError as error:
            self.get_logger().error(str(error))
            self._reply(asked, Outcome.REFUSED, str(error))
            return
        if answer.reason:
            self._reply(asked, Outcome.REFUSED, answer.reason)
            return
        self._last_stamp[answer.keypoint] = max(edit.stamp_ns, self._last_stamp.get(answer.keypoint, 0))
        self._publish(authority)
        self.diagnostics.latency(self.now_s() - asked.came_s)
        self._reply(asked, Outcome.ACCEPTED, "", answer.keypoint, authority.better_order_saves_m(config))

    def _too_late(self, edit: KeypointEdit) -> str:
        """Returns why an edit is stale, "" if it is not; one without a stamp never is."""
        last = self._last_stamp.get(edit.keypoint, 0) if edit.keypoint >= 0 else 0
        late = 0 < edit.stamp_ns < last
        return f"stale: a later edit of keypoint {edit.keypoint} has been accepted" if late else ""

    def _editing(self) -> EditingConfig:
        return self.parameters.get("editing", EditingConfig)

    def _take(self, edit: KeypointEdit) -> str:
        if edit.keypoint < 0:
            return ""
        holder = self._holds.take(edit.keypoint, edit.client_id, self.now_s())
        return f"keypoint {edit.keypoint} is held by {holder!r}" if holder else ""

    def _publish(self, authority: Authority) -> None:
        """Publishes a new revision, all but the legs of all pairs."""
        planned = authority.planned
        assert planned is not None
        keypoints, tour = planned.keypoints, planned.tour
        stamp = self._revision_ns = self.revision()
        gone = sorted(self._shown - set(keypoints.ids))
        self._shown = set(keypoints.ids)
        rows = (keypoints.positions, keypoints.quat_xyzw, keypoints.ids, planned.labels)
        messages = stand_messages(tour, *rows, stamp, gone)
        eyes = planned.eyes()
        marks = _marks_of(planned)
        markers = next(msg for topic, msg in messages if topic == "keypoint_markers")
        by_id = dict(zip(keypoints.ids, eyes, strict=True))
        markers.markers += keypoint_marks_to_msgs(marks, by_id, stamp, self._marks)
        self._marks = marks.names()
        self.publish_all(messages)
        self._editor.show(keypoints.ids, eyes, keypoints.quat_xyzw, planned.labels, keypoints.locked, stamp)
        left = len(tour.unreachable)
        sentence = f"{len(tour.order)} keypoints in {tour.length_m:.1f} m" + (f", {left} unreachable" if left else "")
        self.diagnostics.state("ready", sentence, level="ok" if len(tour.order) else "warn")
        self.diagnostics.note(solver_status=tour.method, revision_ns=stamp, edited=keypoints.edited)

    def _publish_legs(self, authority: Authority) -> None:
        """Publishes the legs of all pairs of the last revision."""
        planned = authority.planned
        if planned is not None:
            self.publish_all([leg_bytes(planned.tour, planned.keypoints.ids, self._revision_ns)])

    def _reply(self, asked: Asked, outcome: Outcome, reason: str, keypoint: int = -1, saves_m: float = 0.0) -> None:
        edit = asked.edit
        named = keypoint if keypoint >= 0 else edit.keypoint
        refused = outcome is Outcome.REFUSED
        self._say(str(named) if named >= 0 else "", edit.client_id, outcome, reason, edit.stamp_ns, saves_m)
        if refused and edit.kind is not EditKind.DRAG:
            self._editor.put_back(edit.keypoint)
        asked.refused = reason if refused else ""
        asked.answered.set()

    def _say(
        self, name: str, client_id: str, outcome: Outcome, reason: str, stamp_ns: int = 0, saves_m: float = 0.0
    ) -> None:
        result = EditResult(
            outcome=outcome,
            keypoint=name,
            client_id=client_id,
            reason=reason,
            revision_ns=self._revision_ns,
            edit_stamp_ns=stamp_ns,
            better_order_saves_m=saves_m,
        )
        self.publish("edit_results", edit_result_to_msg(result))

    def _store_suggestion(self, msg: Any) -> None:
        suggested = keypoints_from_msg(msg)
        if len(suggested.positions):
            self._suggested = suggested
            self.worker.wake()

    def _store_edit(self, msg: Any, from_editor: bool = False) -> None:
        try:
            edit = edit_from_msg(msg)
        except MessageError as error:
            self._say(msg.marker_name, msg.client_id, Outcome.REFUSED, error.reason)
            raise
        self._edits.append(Asked(edit=edit, came_s=self.now_s(), from_editor=from_editor))
        self.worker.wake()

    def _answer_change(self, change: Change, response: Trigger.Response) -> Trigger.Response:
        """Has a change done for a service and waits for it: what it confirms is in the journal."""
        stamp = self.get_clock().now().nanoseconds
        edit = KeypointEdit(
            kind=EditKind.CHANGE,
            keypoint=-1,
            client_id="service",
            stamp_ns=stamp,
            position=NO_POINTS,
            quat_xyzw=NO_TURNS,
            change=change,
        )
        asked = Asked(edit=edit, came_s=self.now_s())
        self._edits.append(asked)
        self.worker.wake()
        done = asked.answered.wait(_ANSWER_S)
        response.success = done and not asked.refused
        response.message = asked.refused if done else "not done yet: edit_results will tell"
        return response

    def _answer_replan(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        authority = self._authority
        response.success = authority is not None and bool(authority.keypoints.ids)
        response.message = "searching another order" if response.success else "there are no keypoints yet"
        if response.success:
            self._replan = True
            self.worker.wake()
        return response


def _wish(asked: Asked) -> Wish:
    edit = asked.edit
    # A menu knows no place but the keypoint's own.
    argument = HALF_WAY if asked.from_editor and edit.change is Change.INSERT else edit.argument
    return Wish(
        kind="move" if edit.change is None else edit.change.name.lower(),
        keypoint=edit.keypoint,
        client_id=edit.client_id,
        position=edit.position,
        quat_xyzw=edit.quat_xyzw,
        argument=argument,
        target=edit.target,
    )


def _marks_of(planned: Planned) -> KeypointMarks:
    keypoints = planned.keypoints
    rows = list(enumerate(keypoints.ids))
    return KeypointMarks(
        look_at={i: keypoints.look_at[k] for k, i in rows if np.isfinite(keypoints.look_at[k]).all()},
        dwell_s={i: float(keypoints.dwell_s[k]) for k, i in rows if np.isfinite(keypoints.dwell_s[k])},
        locked=keypoints.locked,
        start=keypoints.start,
        end=keypoints.end,
    )


def main() -> int:
    """Runs the node; returns the exit code."""
    return run_node(SequencerNode)


if __name__ == "__main__":
    sys.exit(main())
