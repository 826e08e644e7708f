# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The trajectory optimiser as a node: follows the tour, and answers an edit at once on its own copy of it."""

from __future__ import annotations

import dataclasses
import sys
from collections import deque
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_building.footing import eye_over_floor
from walk_ros.conversions import (
    EditKind,
    EditResult,
    KeypointEdit,
    KeypointMarks,
    LabelledKeypoints,
    Outcome,
    Poses,
    TimedPath,
    edit_from_bytes,
    edit_result_from_msg,
    edit_result_to_msg,
    keypoint_markers_from_msg,
    keypoint_marks_from_msg,
    keypoints_from_msg,
    tour_from_msg,
)
from walk_ros.holds import Holds
from walk_ros.node import WalkNode
from walk_ros.raw import from_bytes
from walk_ros.results import path_bytes, path_messages
from walk_ros.runner import run_node
from walk_trajopt.config import TimingConfig, TrajoptConfig
from walk_trajopt.kept import default_state_dir
from walk_trajopt.live import LivePath, Revision, live_path
from walk_trajopt.path import OptimisedPath
from walk_trajopt.targets import NOWHERE, look_targets
from walk_trajopt.timing import time_path


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Plan:
    """What the sequencer last said: three messages of one revision."""

    stamp_ns: int
    keypoints: Poses
    ids: tuple[int, ...]
    marks: KeypointMarks
    polyline: NDArray[np.float64]

    @property
    def revision(self) -> Revision:
        """What of it concerns the path."""
        locked = frozenset(self.marks.locked)
        return Revision(ids=self.ids, keypoints=self.keypoints.positions, polyline=self.polyline, locked=locked)


class TrajoptNode(WalkNode):
    """Publishes the optimised path and the trajectory."""

    def __init__(self) -> None:
        super().__init__("trajopt", {"trajopt": TrajoptConfig, "timing": TimingConfig})
        self.declare_text("state_dir", str(default_state_dir()), "folder where the last path is kept; empty keeps none")
        self._newest: dict[str, Poses | LabelledKeypoints | TimedPath] = {}
        self._edits: deque[tuple[KeypointEdit, float]] = deque()
        self._holds = Holds()
        self._followed: dict[int, str] = {}
        self._undo = False
        self._marks = KeypointMarks()
        self._plan: Plan | None = None
        self._live: LivePath | None = None
        self._solved_for: tuple[Any, ...] = ()
        self._path_ns = 0
        self.offer("path", "trajectory", "path_results")
        self.take_in("keypoints", lambda msg: self._store("keypoints", keypoints_from_msg(msg)))
        self.take_in("keypoint_markers", self._store_markers)
        self.take_in("tour", lambda msg: self._store("tour", tour_from_msg(msg)))
        for topic in ("keypoint_edits", "keypoint_editor/feedback"):
            self.take_in(topic, self._store_edit, self._answer_edits, raw=True)
        self.take_in("edit_results", self._store_result, raw=True)
        self.start()

    def work(self, building: Building) -> None:
        """Follows the newest revision and the edits since; solves only where something changed."""
        plan = self._whole_plan()
        config = self.parameters.get("trajopt", TrajoptConfig)
        timing = self.parameters.get("timing", TimingConfig)
        if plan is None:
            self.diagnostics.state("waiting", "no tour yet: waiting for keypoints, keypoint_markers and tour")
            return
        undo, self._undo = self._undo, False
        if (plan.stamp_ns, config) != self._solved_for[:2]:
            if self._live is None or config != self._solved_for[1]:
                self._live = live_path(building, config, self._folder())
            self._follow(self._live, plan, timing)
        elif self._live is not None and (undo or timing != self._solved_for[2]):
            self._publish(self._live.take_back() if undo else self._live.path(), timing)
        self._solved_for = (plan.stamp_ns, config, timing)
        self._follow_edits(building, plan, timing)

    def _folder(self) -> Path | None:
        folder = str(self.get_parameter("state_dir").value)
        return Path(folder) if folder else None

    def forget(self) -> None:
        """Drops the path through another building; the tour is kept, for the sequencer may have been faster."""
        self._live, self._solved_for = None, ()

    def fail(self, stamp_ns: int) -> None:
        """Publishes an empty path and trajectory; the next step solves again, whatever it is about."""
        self._live, self._solved_for = None, ()
        self.publish_all(path_messages(None, stamp_ns))

    def supersedes(self, groups: frozenset[str]) -> bool:
        """Returns whether a change of these groups makes the running step pointless."""
        return "trajopt" in groups

    def _whole_plan(self) -> Plan | None:
        """Returns what the sequencer last said in full: the newest revision of which all three messages are here."""
        keypoints, markers, tour = (self._newest.get(t) for t in ("keypoints", "keypoint_markers", "tour"))
        if (
            isinstance(keypoints, Poses)
            and isinstance(markers, LabelledKeypoints)
            and isinstance(tour, TimedPath)
            and keypoints.stamp_ns == markers.poses.stamp_ns == tour.stamp_ns
            and len(markers.ids) == len(keypoints.positions)
        ):
            self._plan = Plan(
                stamp_ns=tour.stamp_ns,
                keypoints=keypoints,
                ids=markers.ids,
                marks=self._marks,
                polyline=tour.positions,
            )
        return self._plan

    def _follow(self, live: LivePath, plan: Plan, timing: TimingConfig) -> None:
        began = self.now_s()
        if len(np.unique(plan.polyline, axis=0)) < 2:
            self.fail(self.revision())
            self.diagnostics.state("idle", "the tour has no length: nothing to walk", level="warn", code="empty_tour")
            return
        self.diagnostics.state("solving")
        path = live.follow(plan.revision)
        self._publish(path, timing)
        self.get_logger().info(f"a walk past {len(plan.ids)} keypoints is published: {path.length_m:.0f} m")
        self.diagnostics.note(solve_ms=f"{1e3 * (self.now_s() - began):.1f}")

    def _follow_edits(self, building: Building, plan: Plan, timing: TimingConfig) -> None:
        """Follows the latest edit of each keypoint; the ones before it are dropped."""
        latest: dict[int, tuple[KeypointEdit, float]] = {}
        while self._edits:
            edit, came_s = self._edits.popleft()
            if edit.keypoint in latest:
                self.diagnostics.dropped()
            latest[edit.keypoint] = (edit, came_s)
        for edit, came_s in latest.values():
            if self._live is None or edit.keypoint not in plan.ids:
                continue
            outcome = self._live.move(edit.keypoint, eye_over_floor(building, edit.position))
            if outcome.accepted:
                self._publish(outcome.path, timing)
                self.diagnostics.latency(self.now_s() - came_s)
            self._tell(edit, outcome.reason)

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

    def _publish(self, path: OptimisedPath, timing: TimingConfig) -> None:
        assert self._plan is not None and self._live is not None
        ids, marks = self._plan.ids, self._plan.marks
        chosen = np.array([marks.look_at.get(i, NOWHERE) for i in ids])
        targets = look_targets(self._live.keypoints, self._plan.keypoints.quat_xyzw, chosen)
        dwell_s = [marks.dwell_s.get(i, timing.dwell_s) for i in ids]
        trajectory = time_path(path, timing, look_at=targets, dwell_s=dwell_s)
        stamp_ns = self._path_ns = self.revision()
        self.publish_all(path_bytes(trajectory, stamp_ns))
        sentence = f"{path.length_m:.1f} m in {trajectory.duration_s:.0f} s, {len(path.repaired)} stretches repaired"
        if path.colliding:
            touching = "; ".join(str(stretch) for stretch in path.colliding)
            self.diagnostics.state("ready", f"{sentence}; touching: {touching}", level="warn", code="colliding")
        else:
            self.diagnostics.state("ready", sentence)
        status = f"{path.solver}: {path.iterations} iterations, cost {path.total_cost:.4g}"
        self.diagnostics.note(solver_status=status, revision_ns=stamp_ns, tour_revision_ns=self._plan.stamp_ns)

    def _store(self, topic: str, value: Poses | LabelledKeypoints | TimedPath) -> None:
        self._newest[topic] = value
        self.worker.wake()

    def _store_markers(self, msg: Any) -> None:
        # Before the keypoints: a plan takes both once its three messages agree.
        self._marks = keypoint_marks_from_msg(msg)
        self._store("keypoint_markers", keypoint_markers_from_msg(msg))

    def _store_edit(self, data: bytes) -> None:
        edit = edit_from_bytes(data)
        # All but moving is the sequencer's: the path follows with its next revision.
        if edit.kind is EditKind.CHANGE or edit.keypoint in self._marks.locked:
            return
        # The sequencer refuses an edit of what another editor holds; it is not followed here either.
        if self._holds.take(edit.keypoint, edit.client_id, self.now_s()):
            return
        if edit.kind is EditKind.RELEASE:
            self._holds.release(edit.keypoint, edit.client_id)
        if edit.kind in (EditKind.DRAG, EditKind.RELEASE):
            self._followed[edit.keypoint] = edit.client_id
            self._edits.append((edit, self.now_s()))

    def _answer_edits(self) -> None:
        if self._edits:
            self.worker.now(self._follow_now)

    def _follow_now(self) -> None:
        """Follows edits of the tour that is solved; what takes longer is left to the worker."""
        plan, timing = self._whole_plan(), self.parameters.get("timing", TimingConfig)
        settings = self.parameters.get("trajopt", TrajoptConfig), timing
        if self.building is None or plan is None or self._undo or self._solved_for != (plan.stamp_ns, *settings):
            self.worker.wake()
            return
        self._follow_edits(self.building, plan, timing)

    def _store_result(self, data: bytes) -> None:
        # Every drag is answered; only a refusal is of use here, and is worth reading.
        if Outcome.REFUSED.value.encode() not in bytes(data):
            return
        result = edit_result_from_msg(from_bytes(data, "diagnostic_msgs/msg/DiagnosticStatus"))
        refused = result.outcome is Outcome.REFUSED and result.keypoint.isdigit()
        # What the authority refuses is taken back: the path goes through its keypoints again.
        if refused and self._followed.pop(int(result.keypoint), None) == result.client_id:
            self._undo = True
            self.worker.wake()


def main() -> int:
    """Runs the node; returns the exit code."""
    return run_node(TrajoptNode)


if __name__ == "__main__":
    sys.exit(main())
