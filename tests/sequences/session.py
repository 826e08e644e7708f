# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""An editing session without messages: the cores that the sequencer and trajopt run, and a judge of what they show."""

from __future__ import annotations

import dataclasses
import itertools
import shutil
from pathlib import Path

import fcl
import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_building.footing import eye_over_floor
from walk_importance.config import ImportanceConfig
from walk_importance.keypoints import suggest_keypoints
from walk_importance.pipeline import compute_importance
from walk_sequencer.authority import Authority
from walk_sequencer.config import SequencerConfig
from walk_sequencer.editing import EditingConfig
from walk_sequencer.journal import Journal
from walk_sequencer.wishes import Wish
from walk_trajopt.config import TimingConfig, TrajoptConfig
from walk_trajopt.live import LivePath, Revision, live_path
from walk_trajopt.path import OptimisedPath
from walk_trajopt.timing import time_path

SEQUENCER, EDITING = SequencerConfig(), EditingConfig()
TRAJOPT, TIMING = TrajoptConfig(), TimingConfig()
_SAMPLE_M = 0.02  # between the places at which the judge puts the body
_NEAR_M = 1.0  # a keypoint is passed at half a metre; half as far again may be lost to a wall between
_JOURNAL = "edited"


class Judge:
    """Tells what is wrong with a path, by its own means: the body as a capsule, put every 2 cm into the mesh."""

    def __init__(self, building: Building) -> None:
        walker, geometry = building.walker, building.geometry
        mesh = fcl.BVHModel()
        mesh.beginModel(len(geometry.vertices), len(geometry.faces))
        mesh.addSubModel(geometry.vertices, geometry.faces)
        mesh.endModel()
        self._mesh = fcl.CollisionObject(mesh)
        # From a step above the floor to the crown of the head, caps included.
        tall = walker.height_m - walker.step_m - 2 * walker.radius_m
        self._body = fcl.CollisionObject(fcl.Capsule(walker.radius_m, tall))
        self._down = np.array([0.0, 0.0, 0.5 * (walker.height_m + walker.step_m) - walker.eye_height_m])
        self._free: set[bytes] = set()

    def objections(self, path: OptimisedPath, revision: Revision, moved: NDArray[np.float64]) -> list[str]:
        """Returns what is wrong with the path through keypoints at `moved` (M, 3)."""
        points, wrong = path.points, []
        if not np.isfinite(points).all():
            return ["the path is not finite"]
        index = path.keypoint_index
        if len(index) != len(revision.ids) or (np.diff(index) < 0).any():
            wrong.append(f"{len(index)} keypoints in the order {index.tolist()} for {len(revision.ids)}")
        for at, eye in ((0, moved[0]), (-1, moved[-1])):
            if np.linalg.norm(points[at] - eye) > 0.05:
                wrong.append(f"an end of the path is {np.linalg.norm(points[at] - eye):.2f} m off its keypoint")
        missed = [float(np.linalg.norm(points - eye, axis=1).min()) for eye in moved]
        if max(missed) > _NEAR_M:
            wrong.append(f"keypoint {revision.ids[int(np.argmax(missed))]} is missed by {max(missed):.2f} m")
        if path.colliding:
            wrong.append("the path says that it collides: " + "; ".join(map(str, path.colliding)))
        touching = self._touching(points)
        if touching and not path.colliding:
            wrong.append(f"the body touches the building at {touching} places, which the path does not say")
        return wrong + _clock(path)

    def _touching(self, points: NDArray[np.float64]) -> int:
        count = 0
        for a, b in itertools.pairwise(points):
            key = a.tobytes() + b.tobytes()
            if key in self._free:
                continue
            shares = np.linspace(0.0, 1.0, int(np.ceil(np.linalg.norm(b - a) / _SAMPLE_M)) + 1)
            met = sum(self._meets(a + share * (b - a)) for share in shares)
            count += met
            if not met:
                self._free.add(key)
        return count

    def _meets(self, eye: NDArray[np.float64]) -> bool:
        self._body.setTranslation(eye + self._down)
        return bool(fcl.collide(self._body, self._mesh, fcl.CollisionRequest(), fcl.CollisionResult()))


def _clock(path: OptimisedPath) -> list[str]:
    timed = time_path(path, TIMING)
    wrong = []
    if not (np.isfinite(timed.t_s).all() and (np.diff(timed.t_s) > 0.0).all()):
        wrong.append("the stamps do not rise")
    if not all(np.isfinite(a).all() for a in (timed.positions, timed.velocities, timed.quat_xyzw)):
        wrong.append("the trajectory is not finite")
    if np.abs(np.linalg.norm(timed.quat_xyzw, axis=1) - 1.0).max() > 1e-9:
        wrong.append("a look direction is no unit quaternion")
    if np.abs(timed.positions[[0, -1]] - path.points[[0, -1]]).max() > 1e-6:
        wrong.append("the trajectory does not begin and end where the path does")
    return wrong


@dataclasses.dataclass
class Start:
    """A building with suggested keypoints and their tour, from which every session begins."""

    building: Building
    judge: Judge
    folder: Path
    authority: Authority


def started(building: Building, folder: Path) -> Start:
    """Returns the building with its automatic keypoints, planned."""
    suggestion = suggest_keypoints(building, compute_importance(building, ImportanceConfig()))
    authority = Authority(building, Journal(folder, _JOURNAL))
    authority.adopt(suggestion.positions, suggestion.quat_xyzw)
    authority.plan(SEQUENCER)
    return Start(building=building, judge=Judge(building), folder=folder, authority=authority)


class Session:
    """Does random edits and keeps what went wrong.

    Attributes:
        log: What was done, a line each, to repeat it by hand.
        wrong: What should not have been.
        accepted: How many edits were.
        refused: How many were not, with a reason.
    """

    def __init__(self, start: Start, seed: int, folder: Path) -> None:
        shutil.copy(start.folder / f"{_JOURNAL}.jsonl", folder / f"{_JOURNAL}.jsonl")
        self._building, self._judge = start.building, start.judge
        self._authority = Authority(start.building, Journal(folder, _JOURNAL))
        self._authority.planned = start.authority.planned
        self._authority.plan(SEQUENCER)
        self._live: LivePath = live_path(start.building, TRAJOPT)
        self._dice = np.random.default_rng(seed)
        self.log: list[str] = [f"seed {seed}"]
        self.wrong: list[str] = []
        self.accepted = self.refused = 0
        self._past: list[bytes] = []
        self._future: list[bytes] = []
        self._follow()
        self._live.prepare()

    def run(self, edits: int) -> None:
        """Does so many random edits, then takes all of them back."""
        kinds = ["drag"] * 6 + ["insert"] * 3 + ["delete", "reorder"] * 2
        kinds += ["lock", "unlock", "start", "end", "free_end", "dwell", "look_at", "undo", "redo", "replan"]
        for _ in range(edits):
            kind = kinds[self._dice.integers(len(kinds))]
            if kind == "replan":
                self._replan()
            elif kind in ("undo", "redo"):
                self._back(kind)
            else:
                self._edit(kind)
        while self._past:
            self._back("undo")

    def _edit(self, kind: str) -> None:
        ids = self._authority.keypoints.ids
        keypoint = int(self._dice.choice([*ids, *ids, 999]))
        wish = Wish(
            kind="move" if kind == "drag" else kind,
            keypoint=-1 if kind == "insert" and self._dice.random() < 0.6 else keypoint,
            client_id="anna",
            position=self._place(keypoint),
            argument=self._argument(kind),
            target=self._place(keypoint) if kind == "look_at" and self._dice.random() < 0.7 else None,
        )
        before = self._shown()
        if kind == "drag":
            self._drag(keypoint, wish.position)
        answer = self._authority.edit(wish, SEQUENCER, EDITING)
        self.log.append(f"{kind} {wish.keypoint} {wish.position.tolist()} {wish.argument!r}: {answer.reason or 'done'}")
        if answer.reason:
            self.refused += 1
            self._live.take_back()
            if self._shown() != before:
                self._object("a refused edit left another path behind")
            return
        self.accepted += 1
        self._past.append(before)
        self._future.clear()
        self._follow()

    def _drag(self, keypoint: int, goal: NDArray[np.float64]) -> None:
        """Drags a keypoint in a few steps, as a hand does, before it is let go; the rest is for the authority."""
        row = self._authority.keypoints.index(keypoint)
        if row < 0 or keypoint not in self._revision().ids or keypoint in self._authority.keypoints.locked:
            return
        begin = self._authority.keypoints.positions[row]
        for share in np.linspace(0.0, 1.0, int(self._dice.integers(2, 5)))[1:]:
            before = self._shown()
            eye = eye_over_floor(self._building, begin + share * (goal - begin))
            outcome = self._live.move(keypoint, eye, hasty=share < 1.0)
            self.log.append(f"  drag {keypoint} to {eye.tolist()}: {outcome.reason or 'shown'}")
            if outcome.accepted:
                self._judged(outcome.path)
            elif not outcome.reason or self._shown() != before:
                self._object("a drag that was not followed has no reason, or changed the path")

    def _back(self, kind: str) -> None:
        stack, other = (self._past, self._future) if kind == "undo" else (self._future, self._past)
        before = self._shown()
        answer = self._authority.edit(Wish(kind=kind, client_id="anna"), SEQUENCER, EDITING)
        self.log.append(f"{kind}: {answer.reason or 'done'}")
        if bool(answer.reason) != (not stack):
            self._object(f"{kind} answers {answer.reason!r} with {len(stack)} edits to go")
        if answer.reason or not stack:
            stack.clear()
            return
        self._follow()
        expected = stack.pop()
        other.append(before)
        if self._shown() != expected:
            self._object(f"{kind} shows another path than there was")

    def _replan(self) -> None:
        # The order that the planner finds is no edit: what could be done again would lead back beyond it.
        if not self._future:
            self.log.append("replan")
            self._authority.plan(SEQUENCER, anew=True)
            self._follow()

    def _revision(self) -> Revision:
        planned = self._authority.planned
        assert planned is not None
        tour = planned.tour
        return Revision(
            ids=tuple(planned.keypoints.ids[k] for k in tour.order.tolist()),
            keypoints=tour.stands[tour.order],
            polyline=tour.polyline,
            locked=planned.keypoints.locked,
        )

    def _follow(self) -> None:
        self._judged(self._live.follow(self._revision()))

    def _judged(self, path: OptimisedPath) -> None:
        for objection in self._judge.objections(path, self._revision(), self._live.keypoints):
            self._object(objection)

    def _shown(self) -> bytes:
        return self._live.path().points.tobytes()

    def _object(self, sentence: str) -> None:
        self.wrong.append("\n".join([*self.log, "→ " + sentence]))

    def _place(self, keypoint: int) -> NDArray[np.float64]:
        """Returns a place such as people choose: near the keypoint, anywhere, and now and then where none can be."""
        surface, tall = self._building.surface, self._building.walker.eye_height_m
        row, chance = self._authority.keypoints.index(keypoint), self._dice.random()
        if chance < 0.6 and row >= 0:
            near = self._authority.keypoints.positions[row]
            return np.asarray(near + self._dice.normal(0.0, [0.6, 0.6, 0.1]))
        if chance < 0.9:
            place = surface.places[self._dice.choice(np.flatnonzero(self._building.reachable))]
            return np.asarray(place + [*self._dice.uniform(-0.1, 0.1, 2), tall + self._dice.uniform(-0.3, 0.3)])
        low, high = self._building.geometry.bounds
        return np.asarray(self._dice.uniform(low - 2.0, high + 2.0))

    def _argument(self, kind: str) -> str:
        if kind == "reorder":
            ids = self._authority.keypoints.ids
            return str(self._dice.choice(["first", "last", "earlier", "later", "nowhere", *map(str, ids)]))
        if kind == "dwell":
            return str(self._dice.choice(["", "2.5", "0", "-1", "soon"]))
        return ""
