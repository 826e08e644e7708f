# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Which insertions are the ones made of an edit "near here", and which of them would be done twice."""

import numpy as np
import pytest

from walk_ros.conversions.edits import Change, EditKind, EditResult, KeypointEdit, Outcome, edit_result_to_msg
from walk_ros.near_watch import PATIENCE_S, NearWatch


class Node:
    """As much of a node as the watch uses, with a clock that is set by hand."""

    def __init__(self):
        self.now = 0.0
        self.asked = []

    def offer(self, *_topics):
        pass

    def take_in(self, _topic, store):
        self.refuse = store

    def publish(self, _topic, msg):
        self.asked.append(msg)

    def create_timer(self, _period, look, **_kwargs):
        self.look = look

    def count_subscribers(self, _topic):
        return 1

    def now_s(self):
        return self.now


@pytest.fixture
def node():
    return Node()


@pytest.fixture
def refused():
    return []


@pytest.fixture
def watch(node, refused):
    return NearWatch(node, lambda edit, reason: refused.append((edit.stamp_ns, reason)))


def edit(change, stamp_ns, client="anna"):
    return KeypointEdit(
        kind=EditKind.CHANGE,
        keypoint=-1,
        client_id=client,
        stamp_ns=stamp_ns,
        position=np.zeros(3),
        quat_xyzw=np.array([0.0, 0.0, 0.0, 1.0]),
        change=change,
    )


def near(*args):
    return edit(Change.INSERT_NEAR, *args)


def insertion(*args):
    return edit(Change.INSERT, *args)


def test_of_a_request_and_its_recorded_insertion_one_insertion_is_made(watch):
    watch.wait_for(near(7))
    assert [watch.inserts_again(insertion(7)) for _ in range(3)] == [False, True, True]


def test_a_recording_played_again_inserts_again(watch):
    for _ in range(2):
        watch.wait_for(near(7))
        assert [watch.inserts_again(insertion(7)) for _ in range(2)] == [False, True]


def test_two_requests_of_one_stamp_are_two_insertions(watch):
    # A clock that stands still stamps everything alike.
    watch.wait_for(near(7))
    watch.wait_for(near(7))
    assert [watch.inserts_again(insertion(7)) for _ in range(3)] == [False, False, True]


def test_insertions_that_nobody_asked_for_near_a_place_are_all_made(watch):
    watch.wait_for(near(7))
    watch.wait_for(near(0))
    others = [insertion(8), insertion(8), insertion(7, "ben"), insertion(7, "ben"), insertion(0), insertion(0)]
    assert not any(watch.inserts_again(other) for other in others)


def test_where_the_request_is_refused_the_recorded_insertion_is_made(watch, node, refused):
    watch.wait_for(near(7))
    node.now = PATIENCE_S + 1.0
    node.look()
    assert [stamp for stamp, _ in refused] == [7]
    assert not watch.inserts_again(insertion(7))


def test_an_insertion_is_the_answer_that_was_waited_for(watch, node, refused):
    watch.wait_for(near(7))
    assert not watch.inserts_again(insertion(7))
    node.now = PATIENCE_S + 1.0
    node.look()
    assert refused == []


def test_what_the_importance_node_refuses_is_refused_once(watch, node, refused):
    watch.wait_for(near(7))
    assert [msg.menu_entry_id for msg in node.asked] == [Change.INSERT_NEAR]
    result = EditResult(
        outcome=Outcome.REFUSED, keypoint="", client_id="anna", reason="no map", revision_ns=0, edit_stamp_ns=7
    )
    for _ in range(2):
        node.refuse(edit_result_to_msg(result))
    assert refused == [(7, "no map")]


def test_what_is_remembered_does_not_grow_for_ever(watch):
    for stamp in range(1, 3000):
        watch.wait_for(near(stamp))
    assert len(watch._due) <= 1000
    assert not watch.inserts_again(insertion(2999))
    assert watch.inserts_again(insertion(2999))
