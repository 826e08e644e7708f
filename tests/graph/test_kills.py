# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Nodes killed at random moments under a stream of edits: all that was confirmed is there again.

WALK_KILLS says how often; 100 is the full run, by hand and for releases.
"""

import json
import os
import random
import shutil

import numpy as np
import pytest
from graph.processes import settled

from walk_building.pipeline import load_building
from walk_building.sweep import BodySweep
from walk_ros import conversions as c
from walk_ros.conversions import Change, EditKind, Outcome
from walk_sequencer.journal import Journal

pytestmark = [pytest.mark.ros, pytest.mark.slow]

KILLS = int(os.environ.get("WALK_KILLS", "10"))
PULL_M = 0.26  # a body's radius: by so much a keypoint is pulled off a wall
MOST = 9  # keypoints, so that planning stays short
SHOWN = {"sequencer": "keypoint_markers", "trajopt": "path", "importance": "suggested_keypoints"}
VICTIMS = ["sequencer"] * 6 + ["trajopt", "importance"]
WISHES = [None] * 5 + [Change.INSERT] * 3 + [Change.UNDO, Change.DELETE] * 2
WISHES += [Change.REDO, Change.REORDER, Change.LOCK, Change.UNLOCK, Change.START, Change.END, Change.FREE_END]
WISHES += [Change.DWELL, Change.LOOK_AT, Change.EARLIER, Change.LATER]


class Editors:
    """Sends edits of every kind without waiting, each under a name of its own, by which the journal knows it."""

    def __init__(self, observer, dice):
        self.observer, self.dice = observer, dice
        self.asked = {}  # name → what was wished; None: a move

    def stream(self, count):
        for _ in range(count):
            ids = marked(self.observer).ids
            wish = self.dice.choice(WISHES if len(ids) < MOST else [Change.DELETE])
            name = f"editor-{len(self.asked)}"
            self.asked[name] = wish
            self.observer.edits.publish(c.edit_to_msg(self._edit(name, wish, self.dice.choice(ids))))
            self.observer.executor.spin_once(timeout_sec=self.dice.uniform(0.0, 0.03))

    def answered(self, outcome):
        results = map(c.edit_result_from_msg, self.observer.heard["edit_results"])
        return {r.client_id for r in results if r.outcome is outcome}

    def _edit(self, name, wish, keypoint):
        dice = self.dice
        place = np.array([dice.uniform(0.4, 11.6), dice.uniform(0.4, 3.6), 1.6])
        self.observer.sent += 1
        return c.KeypointEdit(
            kind=EditKind.RELEASE if wish is None else EditKind.CHANGE,
            keypoint=-1 if wish in (Change.UNDO, Change.REDO, Change.INSERT) else keypoint,
            client_id=name,
            stamp_ns=10**18 + self.observer.sent,
            position=place,
            quat_xyzw=np.array([0.0, 0.0, 0.0, 1.0]),
            change=wish,
            argument={Change.REORDER: "first", Change.DWELL: f"{dice.uniform(0.0, 9.0):.2f}"}.get(wish, ""),
            target=place if wish is Change.LOOK_AT else None,
        )


def marked(observer):
    return c.keypoint_markers_from_msg(observer.last("keypoint_markers"))


def on_disk(running, folder):
    """Returns the journal's entries and the keypoints after them, read from a copy."""
    (journal,) = (running.folder / "state").rglob("*.jsonl")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    shutil.copy(journal, folder / journal.name)
    present = Journal(folder, journal.stem).replay().present
    # Read after the replay: a line that was cut off by the kill is not there any more.
    return [json.loads(line) for line in (folder / journal.name).read_text().splitlines()], present


def shows(observer, present):
    """Whether what the sequencer shows is what the journal says."""
    markers, marks = marked(observer), c.keypoint_marks_from_msg(observer.last("keypoint_markers"))
    if tuple(markers.ids) != present.order or marks.locked != present.locked:
        return False
    dwell = {i: s for i, s in zip(present.ids, present.dwell_s.tolist(), strict=True) if np.isfinite(s)}
    wished = present.positions[[present.index(i) for i in present.order]]
    return marks.dwell_s == dwell and bool((np.linalg.norm(markers.poses.positions - wished, axis=1) < PULL_M).all())


def drained(observer):
    """Hears what was still on its way when its sender was killed."""
    for _ in range(20):
        observer.executor.spin_once(timeout_sec=0.01)


def test_whatever_is_killed_whenever_nothing_confirmed_is_lost(running, observer, rooms, tmp_path):
    dice = random.Random(11)
    editors = Editors(observer, dice)
    for kill in range(KILLS):
        victim = dice.choice(VICTIMS)
        observer.wait(lambda: observer.edits.get_subscription_count() >= 2, "the graph to hear edits")
        editors.stream(dice.randint(2, 25))
        running.kill(victim)
        drained(observer)
        heard = len(observer.heard[SHOWN[victim]])
        running.start(victim)
        if dice.random() < 0.25:
            # And once more on its way up, wherever that is.
            for _ in range(dice.randint(1, 100)):
                observer.executor.spin_once(timeout_sec=0.01)
            running.kill(victim)
            running.start(victim)
        observer.after(SHOWN[victim], heard, f"{victim} started again")
        # The sequencer may have edits in hand that no kill has met: their answers come before it is at rest.
        told = editors.answered(Outcome.ACCEPTED)
        entries, _ = on_disk(running, tmp_path / "copy")
        check_kept(editors, told, entries, f"kill {kill}, {victim}")
        observer.wait(
            lambda: shows(observer, on_disk(running, tmp_path / "copy")[1]), f"the journal's keypoints, kill {kill}"
        )
    path, building = settled(observer), load_building(rooms)
    assert np.isfinite(path.positions).all()
    assert BodySweep(building.geometry, building.walker).segments_free(path.positions).all()
    confirmed = editors.answered(Outcome.ACCEPTED)
    assert len(confirmed) > KILLS
    assert {editors.asked[name] for name in confirmed} >= {None, Change.INSERT, Change.DELETE, Change.UNDO}


def check_kept(editors, told, entries, when):
    """Asserts that every confirmed edit is in the journal, and no refused one."""
    named = {e["client_id"] for e in entries if "client_id" in e}
    unnamed = {name for name in told if editors.asked[name] in (Change.UNDO, Change.REDO)}
    assert told - unnamed <= named, f"lost after {when}: {sorted(told - unnamed - named)}"
    for change in (Change.UNDO, Change.REDO):
        kept = sum(e["kind"] == change.name.lower() for e in entries)
        said = sum(editors.asked[name] is change for name in unnamed)
        assert kept >= said, f"lost after {when}: {said - kept} of {change.name}"
    assert not named & editors.answered(Outcome.REFUSED), f"refused and yet kept after {when}"
