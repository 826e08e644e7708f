# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Hands on a running graph: two at once, and nodes killed under them. The tests follow each other."""

import json
import random

import numpy as np
import pytest
from graph.processes import settled

from walk_building.pipeline import load_building
from walk_building.sweep import BodySweep
from walk_ros import conversions as c
from walk_ros.conversions import EditKind, Outcome

pytestmark = pytest.mark.ros

PULL_M = 0.26  # a body's radius: by so much a keypoint is pulled off a wall


@pytest.fixture(scope="module")
def sweep(rooms):
    building = load_building(rooms)
    return BodySweep(building.geometry, building.walker)


def shown(observer):
    markers = c.keypoint_markers_from_msg(observer.last("keypoint_markers"))
    return dict(zip(markers.ids, markers.poses.positions, strict=True))


def results(observer, topic):
    return {r.edit_stamp_ns: r for r in map(c.edit_result_from_msg, observer.heard[topic])}


def stamp_of(observer):
    return 10**18 + observer.sent


def off(path, place):
    return float(np.linalg.norm(path.positions[:, :2] - place[:2], axis=1).min())


def test_two_hands_drag_two_keypoints_at_once(running, observer, sweep):
    eyes = shown(observer)
    (one, a), (two, b) = list(eyes.items())[:2]
    moves = [(one, "anna", a), (two, "bert", b)]
    for identity, client, eye in moves:
        assert observer.edit(EditKind.GRAB, identity, eye, client)().outcome is Outcome.FOLLOWED
    assert "held by 'anna'" in observer.edit(EditKind.DRAG, one, a, "bert")().reason
    first = observer.sent + 1
    for step in range(1, 21):
        answers = [
            observer.edit(EditKind.DRAG, identity, eye + [0.01 * step, 0.0, 0.0], client)
            for identity, client, eye in moves
        ]
    for answer in answers:
        assert answer().outcome is Outcome.FOLLOWED
    drags = range(10**18 + first, stamp_of(observer) + 1)
    assert all(results(observer, "edit_results")[stamp].outcome is Outcome.FOLLOWED for stamp in drags)
    # The last drag of each hand is never superseded: trajopt says which path shows it.
    told = observer.wait(
        lambda: (r := results(observer, "path_results")) and all(s in r for s in list(drags)[-2:]) and r,
        "what trajopt says about the last drags",
    )
    newest = max(told[stamp].revision_ns for stamp in list(drags)[-2:])
    observer.wait(lambda: c.path_from_msg(observer.last("path")).stamp_ns >= newest, "the path with both drags")
    path = c.path_from_msg(observer.last("path"))
    assert [told[stamp].outcome for stamp in list(drags)[-2:]] == [Outcome.FOLLOWED] * 2
    assert sweep.segments_free(path.positions).all()
    for identity, client, eye in moves:
        there = eye + [0.2, 0.0, 0.0]
        assert off(path, there) < 0.55  # keypoint_radius_m, and the path's own spacing
        assert observer.edit(EditKind.RELEASE, identity, there, client)().outcome is Outcome.ACCEPTED
        np.testing.assert_allclose(shown(observer)[identity][:2], there[:2], atol=PULL_M)
    assert sweep.segments_free(settled(observer).positions).all()


def test_a_drag_without_a_way_leaves_the_path_and_says_why(running, observer):
    identity, eye = next(iter(shown(observer).items()))
    before = settled(observer)
    observer.edit(EditKind.DRAG, identity, [-5.0, -5.0, 1.6])
    stamp = stamp_of(observer)
    told = observer.wait(lambda: results(observer, "path_results").get(stamp), "what trajopt says about it")
    assert told.outcome is Outcome.REFUSED
    assert told.reason
    assert c.path_from_msg(observer.last("path")).stamp_ns == told.revision_ns
    np.testing.assert_array_equal(c.path_from_msg(observer.last("path")).positions, before.positions)
    observer.edit(EditKind.RELEASE, identity, eye)()


def test_a_release_is_shown_as_a_drag_is_and_then_solved_in_full(running, observer, sweep):
    identity, eye = next(iter(shown(observer).items()))
    answer = observer.edit(EditKind.RELEASE, identity, eye + [0.1, 0.0, 0.0])
    stamp = stamp_of(observer)
    told = observer.wait(lambda: results(observer, "path_results").get(stamp), "what trajopt says about it")
    assert told.outcome is Outcome.FOLLOWED

    def paths():
        return {path.stamp_ns: path for path in map(c.path_from_msg, observer.heard["path"])}

    observer.wait(lambda: max(paths()) > told.revision_ns, "the path solved in full")
    # Of a latched topic the latest is kept: on a busy machine the first may have been replaced before it was read.
    first = paths().get(told.revision_ns)
    assert first is None or sweep.segments_free(first.positions).all()
    assert answer().outcome is Outcome.ACCEPTED
    assert sweep.segments_free(settled(observer).positions).all()


RESTARTED = {"sequencer": "tour", "trajopt": "path", "importance": "suggested_keypoints"}


def test_whichever_node_is_killed_nothing_confirmed_is_lost(running, observer, sweep):
    dice = random.Random(3)
    sent = {}
    for name in ("sequencer", "trajopt", "sequencer", "importance"):
        eyes = shown(observer)
        for edit in range(dice.randint(3, 7)):
            identity = dice.choice(list(eyes))
            place = eyes[identity] + [dice.uniform(-0.3, 0.3), dice.uniform(-0.3, 0.3), 0.0]
            answer = observer.edit(EditKind.RELEASE, identity, place)
            sent[stamp_of(observer)] = identity, place
            if edit == 0:
                answer()  # one at least is confirmed before the kill
            observer.executor.spin_once(timeout_sec=dice.uniform(0.0, 0.03))
        running.kill(name)
        for _ in range(20):
            observer.executor.spin_once(timeout_sec=0.01)  # what was said before the end arrives
        heard = len(observer.heard[RESTARTED[name]])
        running.start(name)
        observer.after(RESTARTED[name], heard, f"{name} started again")
        confirmed = [s for s, r in results(observer, "edit_results").items() if r.outcome is Outcome.ACCEPTED]
        journal = moves_on_disk(running)
        for stamp in sent.keys() & set(confirmed):
            identity, place = sent[stamp]
            assert (identity, *place[:2]) in journal, f"after killing {name}"
        last = {identity: place for identity, *place in journal}
        observer.wait(
            lambda last=last: all(np.linalg.norm(shown(observer)[i][:2] - p) < PULL_M for i, p in last.items()),
            f"all that is in the journal, after killing {name}",
        )
    path = settled(observer)
    assert np.isfinite(path.positions).all()
    assert sweep.segments_free(path.positions).all()


def moves_on_disk(running):
    (journal,) = (running.folder / "state").rglob("*.jsonl")
    entries = map(json.loads, journal.read_text().splitlines())
    return [(e["id"], *e["position"][:2]) for e in entries if e["kind"] == "move"]
