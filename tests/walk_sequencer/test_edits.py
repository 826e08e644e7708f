# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Edits: each is done or refused with a reason, can be taken back bit for bit, and outlives the process."""

import dataclasses
import hashlib
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from graph.rooms import make_rooms
from hypothesis import given, settings
from hypothesis import strategies as st

from walk_building.pipeline import load_building
from walk_building.sweep import BodySweep
from walk_sequencer.authority import HALF_WAY, Authority
from walk_sequencer.config import SequencerConfig
from walk_sequencer.editing import EditingConfig
from walk_sequencer.journal import Journal
from walk_sequencer.wishes import WISHES, Wish

CONFIG, EDITING = SequencerConfig(), EditingConfig()
EYES = np.array([[6.0, 2.0, 1.6], [2.0, 2.0, 1.6], [10.0, 2.0, 1.6], [2.0, 3.2, 1.6]])
EDITOR = Path(__file__).with_name("editor_process.py")
AHEAD = np.tile([0.0, 0.0, 0.0, 1.0], (4, 1))
WALL, OUTSIDE = (4.0, 3.0, 1.6), (6.0, 30.0, 1.6)


@pytest.fixture(scope="module")
def building(tmp_path_factory):
    return load_building(make_rooms(tmp_path_factory.mktemp("rooms") / "rooms.ply"))


@pytest.fixture
def authority(building, tmp_path):
    return started(building, tmp_path)


def started(building, folder):
    authority = Authority(building, Journal(folder, "rooms"))
    authority.adopt(EYES, AHEAD)
    authority.plan(CONFIG)
    return authority


def do(authority, kind, keypoint=-1, position=(0.0, 0.0, 0.0), argument="", target=None):
    wish = Wish(
        kind=kind,
        keypoint=keypoint,
        client_id="anna",
        position=np.array(position),
        argument=argument,
        target=None if target is None else np.array(target),
    )
    return authority.edit(wish, CONFIG, EDITING)


def same(a, b):
    """Whether two values of keypoints are one bit for bit, but for the identities that were used."""
    fields = [f.name for f in dataclasses.fields(a) if f.name != "next_id"]
    return all(
        getattr(a, n).tobytes() == getattr(b, n).tobytes()
        if isinstance(getattr(a, n), np.ndarray)
        else getattr(a, n) == getattr(b, n)
        for n in fields
    )


def tour_bytes(authority):
    return authority.planned.tour.polyline.tobytes()


places = st.one_of(
    st.tuples(st.floats(0.4, 11.6), st.floats(0.4, 3.6), st.floats(0.3, 2.4)), st.sampled_from([WALL, OUTSIDE])
)
steps = st.tuples(
    st.sampled_from(sorted(WISHES)),
    st.integers(-1, 7),
    places,
    st.sampled_from(["", "first", "last", "0", "2", "2.5", "-1", "door", HALF_WAY]),
)


@settings(deadline=None, max_examples=30)
@given(sequence=st.lists(steps, min_size=1, max_size=7))
def test_any_sequence_of_edits_keeps_every_promise(building, tmp_path_factory, sequence):
    folder = tmp_path_factory.mktemp("state")
    authority, used = started(building, folder), set(range(4))
    for kind, keypoint, position, argument in sequence:
        before, path = authority.keypoints, tour_bytes(authority)
        answer = do(authority, kind, keypoint, position, argument, position)
        after = authority.keypoints
        if answer.reason:
            assert same(after, before)
            assert tour_bytes(authority) == path
            continue
        whole(authority, building)
        if kind == "insert":
            assert answer.keypoint not in used
            used.add(answer.keypoint)
        if kind not in ("undo", "redo"):
            edited = tour_bytes(authority)
            assert do(authority, "undo").reason == ""
            assert same(authority.keypoints, before)
            assert tour_bytes(authority) == path
            assert do(authority, "redo").reason == ""
            assert same(authority.keypoints, after)
            assert tour_bytes(authority) == edited
    again = Authority(building, Journal(folder, "rooms"))
    assert same(again.keypoints, authority.keypoints)
    again.plan(CONFIG)
    assert tour_bytes(again) == tour_bytes(authority)
    while do(authority, "undo").reason == "":
        assert do(again, "undo").reason == ""
        assert same(again.keypoints, authority.keypoints)


def whole(authority, building):
    keypoints, tour = authority.keypoints, authority.planned.tour
    assert len(set(keypoints.ids)) == len(keypoints.ids) == len(keypoints.positions)
    assert sorted(keypoints.order) == sorted(keypoints.ids)
    assert authority.planned.keypoints.order == keypoints.order
    assert keypoints.locked | {keypoints.start, keypoints.end} <= {-1, *keypoints.ids}
    assert keypoints.start in (-1, keypoints.order[0])
    assert keypoints.end in (-1, keypoints.order[-1])
    assert np.isfinite(tour.polyline).all()
    moved = np.linalg.norm(np.diff(tour.polyline, axis=0), axis=1) > 0
    assert BodySweep(building.geometry, building.walker).segments_free(tour.polyline)[moved].all()


def test_an_insertion_comes_where_the_way_round_is_least(authority):
    answer = do(authority, "insert", position=(8.0, 2.9, 1.6))
    assert answer.reason == ""
    order = authority.keypoints.order
    # In the doorway between the middle room and the one at the far end.
    at = order.index(answer.keypoint)
    assert {order[at - 1], order[at + 1]} == {0, 2}
    lengths = authority.planned.tour.length_m
    for other in [i for i in order if i != answer.keypoint]:
        assert do(authority, "reorder", answer.keypoint, argument=str(other)).reason == ""
        assert authority.planned.tour.length_m >= lengths - 1e-9


def test_an_insertion_half_way_lies_on_the_leg(authority):
    first = authority.keypoints.order[0]
    leg = authority.planned.tour.legs[0]
    answer = do(authority, "insert", first, argument=HALF_WAY)
    assert authority.keypoints.order[1] == answer.keypoint
    halves = [part.length_m for part in authority.planned.tour.legs[:2]]
    assert halves[0] == pytest.approx(leg.length_m / 2, abs=0.3)
    assert sum(halves) == pytest.approx(leg.length_m, rel=0.1)


def test_an_identity_that_was_taken_back_is_not_used_again(authority):
    first = do(authority, "insert", position=(6.0, 1.0, 1.6)).keypoint
    do(authority, "undo")
    assert do(authority, "insert", position=(6.0, 3.0, 1.6)).keypoint > first


def test_a_new_edit_ends_what_can_be_done_again(authority):
    do(authority, "dwell", 0, argument="2")
    do(authority, "undo")
    do(authority, "dwell", 1, argument="3")
    assert do(authority, "redo").reason == "there is nothing to redo"
    assert authority.keypoints.dwell_s[1] == 3.0
    assert np.isnan(authority.keypoints.dwell_s[0])


@pytest.mark.parametrize(
    ("kind", "keypoint", "rest", "reason"),
    [
        ("move", 9, {}, "no keypoint 9"),
        ("delete", 9, {}, "no keypoint 9"),
        ("undo", -1, {}, "nothing to undo"),
        ("redo", -1, {}, "nothing to redo"),
        ("insert", -1, {"position": WALL}, "no room for the walker's body there, as in a wall"),
        ("insert", -1, {"position": OUTSIDE}, "no floor"),
        ("insert", 0, {"position": OUTSIDE}, "no floor"),
        ("reorder", 0, {"argument": "door"}, "'door' is no place in the order"),
        ("reorder", 0, {"argument": "9"}, "no other keypoint 9"),
        ("dwell", 0, {"argument": "soon"}, "'soon' is no time to stand"),
        ("dwell", 0, {"argument": "-1"}, "no time to stand"),
        ("dwell", 0, {"argument": "nan"}, "no time to stand"),
        ("free_end", 0, {}, "neither the start nor the end"),
    ],
)
def test_what_cannot_be_done_is_refused_with_the_reason(authority, kind, keypoint, rest, reason):
    before, journal = authority.keypoints, authority._journal.path.read_bytes()
    assert reason in do(authority, kind, keypoint, **rest).reason
    assert same(authority.keypoints, before)
    assert authority._journal.path.read_bytes() == journal


def test_a_locked_keypoint_stays_until_it_is_unlocked(authority):
    order = authority.keypoints.order
    middle = order[1]
    assert do(authority, "lock", middle).reason == ""
    for kind in ("move", "delete", "earlier", "later", "start", "end"):
        assert "locked" in do(authority, kind, middle, position=(6.0, 2.0, 1.6)).reason
    do(authority, "reorder", order[-1], argument="first")
    at = authority.keypoints.order.index(middle)
    authority.plan(CONFIG, anew=True)
    assert authority.keypoints.order.index(middle) == at
    assert do(authority, "unlock", middle).reason == ""
    assert do(authority, "earlier", middle).reason == ""


def test_start_and_end_hold_and_nothing_goes_before_or_behind(authority):
    order = authority.keypoints.order
    assert do(authority, "start", order[2]).reason == ""
    assert do(authority, "end", order[0]).reason == ""
    assert authority.keypoints.order[0] == order[2]
    assert authority.keypoints.order[-1] == order[0]
    assert "starts at" in do(authority, "reorder", order[1], argument="first").reason
    authority.plan(CONFIG, anew=True)
    assert (authority.keypoints.order[0], authority.keypoints.order[-1]) == (order[2], order[0])
    new = do(authority, "insert", position=(11.0, 1.0, 1.6)).keypoint
    assert new not in (authority.keypoints.order[0], authority.keypoints.order[-1])
    assert do(authority, "free_end", order[2]).reason == ""
    assert do(authority, "reorder", order[1], argument="first").reason == ""


def test_a_better_order_is_offered_and_not_taken(authority):
    assert authority.better_order_saves_m(CONFIG) == 0.0
    order = authority.keypoints.order
    long = do(authority, "reorder", order[1], argument="last")
    assert long.reason == ""
    length = authority.planned.tour.length_m
    offered = authority.better_order_saves_m(CONFIG)
    assert offered > 1.0
    assert authority.keypoints.order != order
    authority.plan(CONFIG, anew=True)
    # The offer keeps the start; free of it, the search finds at least as much.
    assert length - authority.planned.tour.length_m >= offered - 1e-6


def test_a_walk_keeps_two_keypoints(authority):
    for identity in (0, 1):
        assert do(authority, "delete", identity).reason == ""
    assert "needs two keypoints" in do(authority, "delete", 2).reason


def digest(history):
    """What the editor process prints of its keypoints."""
    return hashlib.sha256(repr(history.present).encode()).hexdigest()


def test_a_killed_editor_loses_nothing_that_it_confirmed(tmp_path):
    dice = random.Random(5)
    confirmed_in_all = 0
    for run in range(4):
        process = subprocess.Popen(
            [sys.executable, str(EDITOR), str(tmp_path), str(run)], stdout=subprocess.PIPE, text=True
        )
        confirmed = [process.stdout.readline().strip()]
        time.sleep(dice.uniform(0.05, 0.4))
        process.send_signal(signal.SIGKILL)
        confirmed += process.stdout.read().split("\n")
        process.wait()
        process.stdout.close()
        confirmed = [line for line in confirmed if len(line) == 64]
        confirmed_in_all += len(confirmed)
        path = tmp_path / "rooms.jsonl"
        text = path.read_bytes()
        lines = text[: text.rfind(b"\n") + 1].splitlines(keepends=True)
        # The last line may be on disk and not confirmed any more; nothing else may differ.
        states = []
        for end in (len(lines), len(lines) - 1):
            (tmp_path / "cut").mkdir(exist_ok=True)
            (tmp_path / "cut" / "rooms.jsonl").write_bytes(b"".join(lines[:end]))
            states.append(digest(Journal(tmp_path / "cut", "rooms").replay()))
        assert confirmed[-1] in states
        assert digest(Journal(tmp_path, "rooms").replay()) == states[0]
    assert confirmed_in_all > 20
