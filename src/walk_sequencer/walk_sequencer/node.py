# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The sequencer as a node: the authority over the keypoints, their order and the tour through them."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
from std_srvs.srv import Trigger

from walk_building.building import Building
from walk_building.errors import WalkError
from walk_ros.conversions import Change, EditKind, Outcome, Poses, keypoints_from_msg
from walk_ros.edit_desk import Asked, EditDesk
from walk_ros.edit_rules import EditRules
from walk_ros.keypoint_view import KeypointView
from walk_ros.node import WalkNode
from walk_ros.runner import run_node
from walk_sequencer.authority import HALF_WAY, Authority
from walk_sequencer.config import SequencerConfig
from walk_sequencer.editing import EditingConfig
from walk_sequencer.journal import Journal, default_state_dir
from walk_sequencer.misplaced import misplaced
from walk_sequencer.wishes import Wish


class SequencerNode(WalkNode):
    """Publishes keypoints, markers, legs and the tour; answers every edit."""

    niceness = 10

    def __init__(self) -> None:
        super().__init__("sequencer", {"sequencer": SequencerConfig, "editing": EditingConfig})
        self.declare_text("state_dir", str(default_state_dir()), "folder for the journal of edits")
        self._authority: Authority | None = None
        self._rules = EditRules()
        self._suggested: Poses | None = None
        self._replan = False
        self._planned_with: SequencerConfig | None = None
        self._told: set[str] = set()  # about keypoints that are left out or moved
        self._view = KeypointView(self)
        self._desk = EditDesk(self, self._view)
        self.take_in("suggested_keypoints", self._store_suggestion)
        self.create_service(Trigger, "replan", self._answer_replan)
        self.start()

    def work(self, building: Building) -> None:
        """Takes over suggestions, answers the edits in the order they came, plans what has changed."""
        authority = self._authority or self._open(building)
        suggested = self._suggested
        if suggested is not None:
            authority.adopt(suggested.positions, suggested.quat_xyzw)
        config = self.parameters.get("sequencer", SequencerConfig)
        asked, self._replan = self._replan, False
        anew = asked or self._planned_with not in (None, config)
        if authority.keypoints.ids and (authority.planned is None or anew):
            began = self.now_s()
            self.diagnostics.state("planning")
            authority.plan(config, self.worker.progress, anew=anew, offered=asked)
            self._planned_with = config
            self.diagnostics.latency(self.now_s() - began)
            self._publish(authority)
            self._publish_legs(authority)
            self._tell_misplaced(building, authority)
        before = self._view.revision_ns
        while (due := self._desk.due()) is not None:
            # Taken off only once it is answered: a step that is superseded begins with it again.
            self._answer(authority, due, config)
            self._desk.waiting.popleft()
        if self._view.revision_ns != before:
            self._publish_legs(authority)
        if not authority.keypoints.ids:
            self.diagnostics.state("waiting", "no keypoints yet: waiting for suggested_keypoints")

    def forget(self) -> None:
        """Drops the keypoints of another building; its suggestions are not for this one."""
        self._authority = None
        self._planned_with = None
        self._told.clear()

    def fail(self, stamp_ns: int) -> None:
        """Publishes no keypoints and an empty tour."""
        self._view.clear(stamp_ns)
        if self._authority is not None:
            # Nothing is shown now, so the next step plans and publishes again, whatever it is about.
            self._authority.planned = None
        self._desk.refuse_all("the sequencer has no tour: see /diagnostics")

    def destroy_node(self) -> None:
        """Ends the services, then the worker and the node."""
        self._desk.stop()
        super().destroy_node()

    def supersedes(self, groups: frozenset[str]) -> bool:
        """Returns whether a change of these groups makes the running step pointless."""
        return "sequencer" in groups

    def _open(self, building: Building) -> Authority:
        journal = Journal(Path(str(self.get_parameter("state_dir").value)), building.hash)
        editing = self._editing()
        keep = editing.restore or journal.written_after(editing.session_start_s)
        aside = None if keep else journal.put_aside()
        if aside is not None:
            self.get_logger().info(f"the keypoints of an earlier session are put aside, in {aside}")
        self._authority = Authority(building, journal)
        if self._authority.keypoints.edited:
            count = len(self._authority.keypoints.ids)
            self.get_logger().info(
                f"{count} keypoints edited in an earlier session are back, from {journal.path}; the parameter "
                "editing.restore false begins without them: ./walk up … --param sequencer.editing.restore=false"
            )
        self._rules = EditRules()
        return self._authority

    def _answer(self, authority: Authority, asked: Asked, config: SequencerConfig) -> None:
        edit, keypoints = asked.edit, authority.keypoints
        if edit.kind is EditKind.HOLD:
            if edit.keypoint in keypoints.ids:
                self._rules.keep(edit, self.now_s())
            return
        reason = self._rules.objection(edit, keypoints.ids, keypoints.locked, self.now_s())
        if reason or edit.kind in (EditKind.GRAB, EditKind.DRAG):
            self._desk.reply(asked, Outcome.REFUSED if reason else Outcome.FOLLOWED, reason)
            return
        self._rules.release(edit)
        try:
            answer = authority.edit(_wish(asked), config, self._editing())
        except WalkError as error:
            self.get_logger().error(str(error))
            self._desk.reply(asked, Outcome.REFUSED, str(error))
            return
        if answer.reason:
            self._desk.reply(asked, Outcome.REFUSED, answer.reason)
            return
        self._rules.accept(edit, answer.keypoint)
        self._publish(authority)
        self.diagnostics.latency(self.now_s() - asked.came_s)
        self._desk.reply(asked, Outcome.ACCEPTED, "", answer.keypoint, authority.better_order_saves_m(config))

    def _editing(self) -> EditingConfig:
        return self.parameters.get("editing", EditingConfig)

    def _publish(self, authority: Authority) -> None:
        """Publishes a new revision, all but the legs of all pairs."""
        planned = authority.planned
        assert planned is not None
        self._view.show(planned)
        tour, left = planned.tour, len(planned.tour.unreachable)
        sentence = f"{len(tour.order)} keypoints in {tour.length_m:.1f} m" + (f", {left} unreachable" if left else "")
        self.diagnostics.state("ready", sentence, level="ok" if len(tour.order) else "warn")
        edited = planned.keypoints.edited
        self.diagnostics.note(solver_status=authority.order_by, revision_ns=self._view.revision_ns, edited=edited)

    def _publish_legs(self, authority: Authority) -> None:
        if authority.planned is not None:
            self._view.show_legs(authority.planned)

    def _tell_misplaced(self, building: Building, authority: Authority) -> None:
        """Logs, once each, the keypoints that are not passed where they are wished, numbered as they were suggested."""
        planned = authority.planned
        if planned is None:
            return
        keypoints, suggested = planned.keypoints, authority.keypoints.suggested
        found = misplaced(building, keypoints.positions, planned.tour, self._editing().pull_m)
        for row in sorted(found, key=lambda row: keypoints.ids[row]):
            # By its place: identities go on where keypoints are suggested anew.
            same = np.flatnonzero((suggested == keypoints.positions[row]).all(axis=1))
            name = f"suggested keypoint {same[0] + 1}" if len(same) else f"keypoint {keypoints.ids[row]}"
            if (sentence := f"{name} {found[row]}") not in self._told:
                self._told.add(sentence)
                self.get_logger().warning(sentence)

    def _store_suggestion(self, msg: Any) -> None:
        suggested = keypoints_from_msg(msg)
        if len(suggested.positions):
            self._suggested = suggested
            self.worker.wake()

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


def main() -> int:
    """Runs the node; returns the exit code."""
    return run_node(SequencerNode)


if __name__ == "__main__":
    sys.exit(main())
