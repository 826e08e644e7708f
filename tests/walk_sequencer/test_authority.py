# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The authority: suggestions never undo an edit, an edit keeps the order, a restart changes nothing."""

import numpy as np
import pytest
from graph.rooms import make_rooms

from walk_building.pipeline import load_building
from walk_sequencer.authority import Authority
from walk_sequencer.config import SequencerConfig
from walk_sequencer.editing import EditingConfig
from walk_sequencer.journal import Journal
from walk_sequencer.wishes import Wish

CONFIG, EDITING = SequencerConfig(), EditingConfig()
EYES = np.array([[6.0, 2.0, 1.6], [2.0, 2.0, 1.6], [10.0, 2.0, 1.6]])
AHEAD = np.tile([0.0, 0.0, 0.0, 1.0], (3, 1))


@pytest.fixture(scope="module")
def building(tmp_path_factory):
    return load_building(make_rooms(tmp_path_factory.mktemp("rooms") / "rooms.ply"))


@pytest.fixture
def start(building, tmp_path):
    return lambda: Authority(building, Journal(tmp_path, building.hash))


def move(authority, identity, position):
    wish = Wish(kind="move", keypoint=identity, position=np.array(position), client_id="anna")
    return authority.edit(wish, CONFIG, EDITING).reason


def planned(authority):
    authority.adopt(EYES, AHEAD)
    authority.plan(CONFIG)
    return authority


def state(authority):
    plan = authority.planned
    return sorted(plan.keypoints.ids), plan.keypoints.order, plan.tour.polyline.tolist()


def test_the_tour_runs_through_the_rooms_in_a_row(start):
    authority = planned(start())
    assert authority.keypoints.order in {(1, 0, 2), (2, 0, 1)}


def test_a_restart_changes_nothing(start):
    authority = planned(start())
    assert move(authority, 0, [6.5, 1.5, 1.6]) == ""
    again = start()
    assert not again.adopt(EYES, AHEAD)
    again.plan(CONFIG)
    assert state(again) == state(authority)


def test_suggestions_never_undo_an_edit(start):
    authority = planned(start())
    assert move(authority, 0, [6.5, 1.5, 1.6]) == ""
    assert not authority.adopt(EYES + [0.1, 0.0, 0.0], AHEAD)
    np.testing.assert_allclose(authority.keypoints.positions[authority.keypoints.index(0)], [6.5, 1.5, 1.6])


def test_new_suggestions_replace_unedited_keypoints(start):
    authority = planned(start())
    assert authority.adopt(EYES[:2], AHEAD[:2])
    assert authority.plan(CONFIG).keypoints.ids in {(3, 4), (4, 3)}


def test_an_edit_keeps_the_order_and_only_replan_changes_it(start):
    authority = planned(start())
    before = authority.keypoints.order
    middle, end = 0, before[2]
    # The middle keypoint goes to the far room, beyond the one at the end: another order would be shorter.
    beyond = [11.4, 2.0, 1.6] if end == 2 else [0.6, 2.0, 1.6]
    assert move(authority, middle, beyond) == ""
    assert authority.keypoints.order == before
    long = authority.planned.tour.length_m
    authority.plan(CONFIG, anew=True)
    assert authority.keypoints.order != before
    assert authority.planned.tour.length_m < long


def test_what_is_taken_is_as_short_as_what_was_offered_wherever_the_entrance_is(start, monkeypatch):
    # The entrance is in the middle room, and the tour by hand begins in the last one: from 10 m over 2 m to 6 m.
    def in_the_middle(_building, eyes):
        return int(np.argmin(np.abs(eyes[:, 0] - 6.0)))

    monkeypatch.setattr("walk_sequencer.pipeline.first_from_entrance", in_the_middle)
    authority = planned(start())
    assert authority.keypoints.order[0] == 0
    for identity in (0, 1, 2):
        wish = Wish(kind="reorder", keypoint=identity, argument={0: "last", 1: "first", 2: "first"}[identity])
        assert authority.edit(wish, CONFIG, EDITING).reason == ""
    assert authority.keypoints.order == (2, 1, 0)
    before, offered = authority.planned.tour.length_m, authority.better_order_saves_m(CONFIG)
    assert offered > 3.0
    authority.plan(CONFIG, anew=True, offered=True)
    assert authority.keypoints.order == (2, 0, 1)
    assert before - authority.planned.tour.length_m >= offered - 1e-6


def test_a_lifted_keypoint_means_the_floor_below_it(start):
    authority = planned(start())
    assert move(authority, 0, [6.5, 1.5, 2.4]) == ""
    assert authority.keypoints.positions[authority.keypoints.index(0), 2] == pytest.approx(1.6, abs=1e-6)


@pytest.mark.parametrize(
    ("identity", "position", "reason"),
    [(9, [6.0, 2.0, 1.6], "no keypoint 9"), (0, [4.0, 3.0, 1.6], "no room"), (0, [6.0, 30.0, 1.6], "no floor")],
)
def test_a_refused_edit_leaves_no_trace(start, identity, position, reason):
    authority = planned(start())
    before = state(authority)
    assert reason in move(authority, identity, position)
    assert state(authority) == before
    again = start()
    again.plan(CONFIG)
    assert state(again) == before
