# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The trajectory optimiser as a node: follows the tour, and answers an edit at once on its own copy of it."""

from __future__ import annotations

import functools
import sys
import threading
from pathlib import Path
from typing import Any

from walk_building.building import Building
from walk_building.footing import eye_over_floor
from walk_ros.conversions import (
    EditKind,
    EditResult,
    KeypointEdit,
    Outcome,
    edit_result_to_msg,
)
from walk_ros.conversions.cdr import path_to_bytes, trajectory_to_bytes
from walk_ros.node import WalkNode
from walk_ros.results import path_messages
from walk_ros.runner import run_node
from walk_trajopt.config import TimingConfig, TrajoptConfig
from walk_trajopt.kept import default_state_dir
from walk_trajopt.live import LivePath, live_path
from walk_trajopt.node_edits import Edits
from walk_trajopt.node_inbox import Inbox, Plan
from walk_trajopt.path import OptimisedPath
from walk_trajopt.trajectory import Trajectory

REFINE_S = 0.03
"""How long a release is shown as a drag is, before it is solved in full: page and bridge show it meanwhile."""


class TrajoptNode(WalkNode):
    """Publishes the optimised path and the trajectory."""

    def __init__(self) -> None:
        super().__init__("trajopt", {"trajopt": TrajoptConfig, "timing": TimingConfig})
        self.declare_text("state_dir", str(default_state_dir()), "folder where the last path is kept; empty keeps none")
        self._inbox = Inbox()
        self._edits = Edits()
        self._live: LivePath | None = None
        self._solved_for: tuple[Any, ...] = ()
        self._path_ns = 0
        self._rough: dict[int, KeypointEdit] = {}  # releases that are not solved in full yet, by keypoint
        self._paying = threading.Lock()
        self._owed: tuple[Trajectory, int] | None = None  # with its stamp, not published yet
        self.offer("path", "trajectory", "path_results")
        for topic in ("keypoints", "keypoint_markers", "tour"):
            self.take_in(topic, functools.partial(self._store, topic))
        for topic in ("keypoint_edits", "keypoint_editor/feedback"):
            self.take_in(topic, self._store_edit, self._answer_edits, raw=True, aside=True)
        self.take_in("edit_results", self._store_result, raw=True, aside=True)
        self.start()

    def work(self, building: Building) -> None:
        """Follows the newest revision and the edits since; solves only where something changed."""
        plan = self._inbox.plan()
        config = self.parameters.get("trajopt", TrajoptConfig)
        timing = self.parameters.get("timing", TimingConfig)
        if plan is None:
            self.diagnostics.state("waiting", "no tour yet: waiting for keypoints, keypoint_markers and tour")
            return
        changed = self._take_back()
        # Before the next revision is followed, which keeps what is shown.
        changed |= self._refine(building)
        if (plan.stamp_ns, config) != self._solved_for[:2]:
            if self._live is None or config != self._solved_for[1]:
                self._live = live_path(building, config, self._folder())
            self._follow(self._live, plan, timing)
        elif self._live is not None and (changed or timing != self._solved_for[2]):
            self._publish(self._live.path(), plan, timing)
        self._solved_for = (plan.stamp_ns, config, timing)
        if self._live is not None and self._take_back_confirmed(self._live, plan.stamp_ns):
            self._publish(self._live.path(), plan, timing)
        self._follow_edits(building, plan, timing)

    def _take_back(self) -> bool:
        """Takes back what the authority has refused; returns whether there was anything."""
        refused = self._edits.refused()
        for keypoint in refused:
            self._rough.pop(keypoint, None)
            if self._live is not None and self._solved_for:
                self._live.take_back(keypoint)
        return bool(refused)

    def _take_back_confirmed(self, live: LivePath, stamp_ns: int) -> bool:
        """Leaves to the revision what it has; returns whether something was shown that it has not any more.

        As where an edit was accepted and undone before trajopt came to it: to the path both revisions are the same.
        """
        changed = False
        for keypoint in self._edits.confirmed(stamp_ns):
            self._rough.pop(keypoint, None)
            if live.shows(keypoint):
                live.take_back(keypoint)
                changed = True
        return changed

    def _refine(self, building: Building) -> bool:
        """Solves the releases in full that are shown as drags are; returns whether there was anything."""
        rough, self._rough = self._rough, {}
        if self._live is None:
            return False
        # Where that leads nowhere the path stays as it is shown, which is swept, too.
        moved = [self._live.move(k, eye_over_floor(building, edit.position)).accepted for k, edit in rough.items()]
        return any(moved)

    def _folder(self) -> Path | None:
        folder = str(self.get_parameter("state_dir").value)
        return Path(folder) if folder else None

    def forget(self) -> None:
        """Drops the path through another building; the tour is kept, for the sequencer may have been faster."""
        self._live, self._solved_for, self._rough = None, (), {}

    def fail(self, stamp_ns: int) -> None:
        """Publishes an empty path and trajectory; the next step solves again, whatever it is about."""
        self._live, self._solved_for, self._owed, self._rough = None, (), None, {}
        self.publish_all(path_messages(None, stamp_ns))

    def supersedes(self, groups: frozenset[str]) -> bool:
        """Returns whether a change of these groups makes the running step pointless."""
        return "trajopt" in groups

    def _follow(self, live: LivePath, plan: Plan, timing: TimingConfig) -> None:
        began = self.now_s()
        if not plan.has_length:
            self.fail(self.revision())
            self.diagnostics.state("idle", "the tour has no length: nothing to walk", level="warn", code="empty_tour")
            return
        self.diagnostics.state("solving")
        path = live.follow(plan.revision)
        self._publish(path, plan, timing)
        self.get_logger().info(f"a walk past {len(plan.ids)} keypoints is published: {path.length_m:.0f} m")
        self.diagnostics.note(solve_ms=f"{1e3 * (self.now_s() - began):.1f}")
        live.prepare()

    def _follow_edits(self, building: Building, plan: Plan, timing: TimingConfig) -> None:
        """Follows the latest edit of each keypoint; the ones before it are dropped."""
        latest, dropped = self._edits.latest()
        for _ in range(dropped):
            self.diagnostics.dropped()
        for followed in latest:
            edit = followed.edit
            if self._live is None or edit.keypoint not in plan.ids:
                continue
            if followed.over:
                # The sequencer was faster: the path is that of its revision already.
                self._tell(edit, "" if followed.over is Outcome.ACCEPTED else "the sequencer has refused it")
                continue
            eye, released = eye_over_floor(building, edit.position), edit.kind is EditKind.RELEASE
            self._rough.pop(edit.keypoint, None)
            outcome = self._live.move(edit.keypoint, eye, hasty=True)
            if released and outcome.accepted:
                self._rough[edit.keypoint] = edit
            elif released:
                outcome = self._live.move(edit.keypoint, eye)
            if outcome.accepted:
                self._publish(outcome.path, plan, timing, hasty=True)
                self.diagnostics.latency(self.now_s() - followed.came_s)
            self._tell(edit, outcome.reason)
        if self._rough:
            self.worker.wake(rest_s=REFINE_S)

    def _tell(self, edit: KeypointEdit, reason: str) -> None:
        """Says which path shows an edit, or why the path stays as it is."""
        self.diagnostics.note(last_edit=reason or f"keypoint {edit.keypoint} followed")
        result = EditResult(
            outcome=Outcome.REFUSED if reason else Outcome.FOLLOWED,
            keypoint=str(edit.keypoint),
            client_id=edit.client_id,
            reason=reason,
            revision_ns=self._path_ns,
            edit_stamp_ns=edit.stamp_ns,
        )
        self.publish("path_results", edit_result_to_msg(result))

    def _publish(self, path: OptimisedPath, plan: Plan, timing: TimingConfig, *, hasty: bool = False) -> None:
        """Publishes a path and its trajectory; in the middle of a drag the trajectory waits, for a second at most."""
        assert self._live is not None
        trajectory = plan.timed(path, self._live.keypoints, timing)
        stamp_ns = self._path_ns = self.revision()
        self.publish("path", path_to_bytes(trajectory.t_s, trajectory.positions, trajectory.quat_xyzw, stamp_ns))
        self._owed = (trajectory, stamp_ns)
        if not hasty:
            self._pay()
        sentence = f"{path.length_m:.1f} m in {trajectory.duration_s:.0f} s, {len(path.repaired)} stretches repaired"
        if path.colliding:
            touching = "; ".join(str(stretch) for stretch in path.colliding)
            self.diagnostics.state("ready", f"{sentence}; touching: {touching}", level="warn", code="colliding")
        else:
            self.diagnostics.state("ready", sentence)
        status = f"{path.solver}: {path.iterations} iterations" + (f", cost {path.total_cost:.4g}" if path.cost else "")
        self.diagnostics.note(solver_status=status, revision_ns=stamp_ns, tour_revision_ns=plan.stamp_ns)

    def publish_diagnostics(self) -> None:
        """Publishes the state, and the trajectory of a drag that still goes on."""
        self._pay()
        super().publish_diagnostics()

    def _pay(self) -> None:
        # The timer and whoever answers edits may both be here: the later trajectory has to come out last.
        with self._paying:
            owed, self._owed = self._owed, None
            if owed is not None:
                self.publish("trajectory", trajectory_to_bytes(*owed))

    def _store(self, topic: str, msg: Any) -> None:
        self._inbox.store(topic, msg)
        self.worker.wake()

    def _store_edit(self, data: bytes) -> None:
        self._edits.store(data, self._inbox.marks.locked, self.now_s())

    def _answer_edits(self) -> None:
        if self._edits:
            self.worker.now(self._follow_now)

    def _follow_now(self) -> None:
        """Follows edits of the tour that is solved; what takes longer is left to the worker."""
        plan, timing = self._inbox.plan(), self.parameters.get("timing", TimingConfig)
        settings = self.parameters.get("trajopt", TrajoptConfig), timing
        if (
            self.building is None
            or plan is None
            or self._edits.any_refused
            or self._solved_for != (plan.stamp_ns, *settings)
        ):
            self.worker.wake()
            return
        self._follow_edits(self.building, plan, timing)

    def _store_result(self, data: bytes) -> None:
        # The path goes through the authority's place for the keypoint again: at once where it refuses the edit, else
        # with the revision.
        if self._edits.store_result(data):
            self.worker.wake()


def main() -> int:
    """Runs the node; returns the exit code."""
    return run_node(TrajoptNode)


if __name__ == "__main__":
    sys.exit(main())
