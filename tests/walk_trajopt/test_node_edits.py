# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Edits and their answers in every order: nothing is shown that has been refused, whoever came first."""

from __future__ import annotations

import numpy as np
import pytest
from rclpy.serialization import serialize_message

from walk_ros.conversions import EditKind, EditResult, KeypointEdit, Outcome, edit_result_to_msg, edit_to_msg
from walk_trajopt.node_edits import Edits

pytestmark = pytest.mark.ros


def edit(edits: Edits, stamp_ns: int, kind: EditKind = EditKind.RELEASE, client: str = "anna") -> None:
    turn = np.array([0.0, 0.0, 0.0, 1.0])
    one = KeypointEdit(kind=kind, keypoint=4, client_id=client, stamp_ns=stamp_ns, position=np.zeros(3), quat_xyzw=turn)
    edits.store(serialize_message(edit_to_msg(one)), frozenset(), 0.0)


def answer(
    edits: Edits, outcome: Outcome, stamp_ns: int, client: str = "anna", revision_ns: int = 100, reason: str = ""
) -> bool:
    result = EditResult(
        outcome=outcome,
        keypoint="4",
        client_id=client,
        reason=reason or ("no room" if outcome is Outcome.REFUSED else ""),
        revision_ns=revision_ns,
        edit_stamp_ns=stamp_ns,
    )
    return edits.store_result(serialize_message(edit_result_to_msg(result)))


def to_show(edits: Edits) -> list[int]:
    return [followed.edit.stamp_ns for followed in edits.latest()[0] if not followed.over]


def test_what_is_refused_before_it_was_worked_on_is_not_shown_afterwards() -> None:
    edits = Edits()
    edit(edits, 1, EditKind.DRAG)
    edit(edits, 2)
    assert answer(edits, Outcome.REFUSED, 2)
    assert edits.refused() == [4]
    assert to_show(edits) == []
    assert not edits


def test_a_refusal_that_comes_before_its_edit_holds_for_the_drags_before_it() -> None:
    edits = Edits()
    answer(edits, Outcome.REFUSED, 2)
    edit(edits, 1, EditKind.DRAG)
    edit(edits, 2)
    assert edits.refused() == [4]
    assert to_show(edits) == []
    edit(edits, 3, EditKind.DRAG)
    assert to_show(edits) == [3]


def test_of_two_releases_that_are_refused_the_second_is_taken_back_too() -> None:
    edits = Edits()
    edit(edits, 1)
    edit(edits, 2)
    assert answer(edits, Outcome.REFUSED, 1)
    assert edits.refused() == [4]
    assert to_show(edits) == [2]
    assert answer(edits, Outcome.REFUSED, 2)
    assert edits.refused() == [4]


def test_what_another_is_refused_does_not_hide_the_refusal_of_ones_own() -> None:
    edits = Edits()
    edit(edits, 1)
    assert not answer(edits, Outcome.REFUSED, 7, "bert")
    assert to_show(edits) == [1]
    assert answer(edits, Outcome.REFUSED, 1)
    assert edits.refused() == [4]


@pytest.mark.parametrize("stamp_ns", [0, 1])
def test_a_refusal_without_a_stamp_is_of_the_latest_edit(stamp_ns: int) -> None:
    edits = Edits()
    edit(edits, stamp_ns)
    assert answer(edits, Outcome.REFUSED, 0)
    assert to_show(edits) == []


def test_what_is_accepted_is_shown_until_its_revision_is_there() -> None:
    edits = Edits()
    edit(edits, 1)
    assert answer(edits, Outcome.ACCEPTED, 1, revision_ns=100)
    assert edits.confirmed(99) == []
    assert edits.confirmed(101) == [4]
    assert edits.confirmed(102) == []
    assert to_show(edits) == []
    edit(edits, 2, EditKind.DRAG)
    assert edits.confirmed(103) == []
    assert to_show(edits) == [2]


def test_answers_to_drags_and_to_earlier_edits_leave_what_is_shown() -> None:
    edits = Edits()
    edit(edits, 1)
    edit(edits, 2, EditKind.DRAG)
    assert not answer(edits, Outcome.ACCEPTED, 1)
    assert not answer(edits, Outcome.FOLLOWED, 2)
    assert edits.confirmed(1000) == []
    assert to_show(edits) == [2]
