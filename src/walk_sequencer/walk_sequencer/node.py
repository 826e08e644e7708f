# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The sequencer as a node: the authority over the keypoints, their order and the tour through them."""

from __future__ import annotations

import sys
from collections import deque
from pathlib import Path
from typing import Any

from std_srvs.srv import Trigger

from walk_building.building import Building
from walk_building.errors import WalkError
from walk_ros.conversions import (
    EditKind,
    EditResult,
    KeypointEdit,
    Outcome,
    Poses,
    edit_from_msg,
    edit_result_to_msg,
    keypoints_from_msg,
)
from walk_ros.errors import MessageError
from walk_ros.holds import Holds
from walk_ros.node import WalkNode
from walk_ros.results import NO_POINTS, NO_TURNS, tour_messages
from walk_ros.runner import run_node
from walk_sequencer.authority import Authority
from walk_sequencer.config import SequencerConfig
from walk_sequencer.editing import EditingConfig
from walk_sequencer.journal import Journal, default_state_dir


class SequencerNode(WalkNode):
    """Publishes keypoints, markers, legs and the tour; answers every edit."""

    def __init__(self) -> None:
        super().__init__("sequencer", {"sequencer": SequencerConfig, "editing": EditingConfig})
        self.declare_text("state_dir", str(default_state_dir()), "folder for the journal of edits")
        self._authority: Authority | None = None
        self._holds = Holds()
        self._edits: deque[tuple[KeypointEdit, float]] = deque()
        self._suggested: Poses | None = None
        self._replan = False
        self._planned_with: SequencerConfig | None = None
        self._shown: set[int] = set()
        self._revision_ns = 0
        self.offer("keypoints", "keypoint_markers", "pairwise_paths", "tour", "edit_results")
        self.take_in("suggested_keypoints", self._store_suggestion)
        self.take_in("keypoint_edits", self._store_edit)
        self.create_service(Trigger, "replan", self._answer_replan)
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
        while self._edits:
            # Taken off only once it is answered: a step that is superseded begins with it again.
            self._answer(authority, *self._edits[0], config)
            self._edits.popleft()
        if not authority.keypoints.ids:
            self.diagnostics.state("waiting", "no keypoints yet: waiting for suggested_keypoints")

    def forget(self) -> None:
        """Drops the keypoints of another building; its suggestions are not for this one."""
        self._authority = None
        self._planned_with = None

    def fail(self, stamp_ns: int) -> None:
        """Publishes no keypoints and an empty tour."""
        self.publish_all(tour_messages(None, NO_POINTS, NO_TURNS, (), (), stamp_ns, sorted(self._shown)))
        self._shown = set()
        if self._authority is not None:
            # Nothing is shown now, so the next step plans and publishes again, whatever it is about.
            self._authority.planned = None
        while self._edits:
            edit, _ = self._edits.popleft()
            self._reply(str(edit.keypoint), edit, Outcome.REFUSED, "the sequencer has no tour: see /diagnostics")

    def supersedes(self, groups: frozenset[str]) -> bool:
        """Returns whether a change of these groups makes the running step pointless."""
        return "sequencer" in groups

    def _open(self, building: Building) -> Authority:
        journal = Journal(Path(str(self.get_parameter("state_dir").value)), building.hash)
        if not self._editing().restore:
            journal.put_aside()
        self._authority = Authority(building, journal)
        self._holds = Holds()
        return self._authority

    def _answer(self, authority: Authority, edit: KeypointEdit, came_s: float, config: SequencerConfig) -> None:
        if edit.kind is EditKind.HOLD:
            if authority.keypoints.index(edit.keypoint) >= 0:
                self._take(edit)
            return
        reason = "" if authority.keypoints.index(edit.keypoint) >= 0 else f"there is no keypoint {edit.keypoint}"
        reason = reason or self._take(edit)
        outcome = Outcome.FOLLOWED
        if not reason and edit.kind is EditKind.RELEASE:
            self._holds.release(edit.keypoint, edit.client_id)
            outcome = Outcome.ACCEPTED
            try:
                reason = authority.move(
                    edit.keypoint, edit.position, edit.quat_xyzw, edit.client_id, config, self._editing()
                )
            except WalkError as error:
                self.get_logger().error(str(error))
                reason = str(error)
            if not reason:
                self._publish(authority)
                self.diagnostics.latency(self.now_s() - came_s)
        self._reply(str(edit.keypoint), edit, Outcome.REFUSED if reason else outcome, reason)

    def _editing(self) -> EditingConfig:
        return self.parameters.get("editing", EditingConfig)

    def _take(self, edit: KeypointEdit) -> str:
        holder = self._holds.take(edit.keypoint, edit.client_id, self.now_s())
        return f"keypoint {edit.keypoint} is held by {holder!r}" if holder else ""

    def _publish(self, authority: Authority) -> None:
        planned = authority.planned
        assert planned is not None
        keypoints, tour = planned.keypoints, planned.tour
        self._revision_ns = self.revision()
        gone = sorted(self._shown - set(keypoints.ids))
        self._shown = set(keypoints.ids)
        stamp = self._revision_ns
        rows = (keypoints.positions, keypoints.quat_xyzw, keypoints.ids, planned.labels)
        self.publish_all(tour_messages(tour, *rows, stamp, gone))
        left = len(tour.unreachable)
        sentence = f"{len(tour.order)} keypoints in {tour.length_m:.1f} m" + (f", {left} unreachable" if left else "")
        self.diagnostics.state("ready", sentence, level="ok" if len(tour.order) else "warn")
        self.diagnostics.note(solver_status=tour.method, revision_ns=stamp, edited=keypoints.edited)

    def _reply(self, name: str, edit: KeypointEdit | None, outcome: Outcome, reason: str, client_id: str = "") -> None:
        result = EditResult(
            outcome=outcome,
            keypoint=name,
            client_id=edit.client_id if edit is not None else client_id,
            reason=reason,
            revision_ns=self._revision_ns,
            edit_stamp_ns=edit.stamp_ns if edit is not None else 0,
        )
        self.publish("edit_results", edit_result_to_msg(result))

    def _store_suggestion(self, msg: Any) -> None:
        suggested = keypoints_from_msg(msg)
        if len(suggested.positions):
            self._suggested = suggested
            self.worker.wake()

    def _store_edit(self, msg: Any) -> None:
        try:
            self._edits.append((edit_from_msg(msg), self.now_s()))
        except MessageError as error:
            self._reply(msg.marker_name, None, Outcome.REFUSED, error.reason, msg.client_id)
            raise
        self.worker.wake()

    def _answer_replan(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        authority = self._authority
        response.success = authority is not None and bool(authority.keypoints.ids)
        response.message = "searching another order" if response.success else "there are no keypoints yet"
        if response.success:
            self._replan = True
            self.worker.wake()
        return response


def main() -> int:
    """Runs the node; returns the exit code."""
    return run_node(SequencerNode)


if __name__ == "__main__":
    sys.exit(main())
