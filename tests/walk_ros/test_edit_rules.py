# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import numpy as np

from walk_ros.conversions import Change, EditKind, KeypointEdit
from walk_ros.edit_rules import EditRules


def edit(keypoint: int, kind: EditKind = EditKind.RELEASE, client_id: str = "anna", stamp_ns: int = 0) -> KeypointEdit:
    return KeypointEdit(
        kind=kind,
        keypoint=keypoint,
        client_id=client_id,
        stamp_ns=stamp_ns,
        position=np.zeros(3),
        quat_xyzw=np.array([0.0, 0.0, 0.0, 1.0]),
        change=Change.UNDO if kind is EditKind.CHANGE else None,
    )


def test_an_edit_of_no_keypoint_is_never_refused():
    rules = EditRules()
    for client in ("anna", "bert"):
        assert rules.objection(edit(-1, EditKind.CHANGE, client), (), (), 0.0) == ""


def test_an_unknown_keypoint_is_refused_and_not_held():
    rules = EditRules()
    assert rules.objection(edit(3), (1, 2), (), 0.0) == "there is no keypoint 3"
    assert rules.objection(edit(3, client_id="bert"), (1, 2, 3), (), 0.0) == ""


def test_an_edit_older_than_the_last_accepted_one_is_stale_unless_it_has_no_stamp():
    rules = EditRules()
    rules.accept(edit(1, stamp_ns=20), 1)
    rules.accept(edit(1, stamp_ns=10), 1)
    assert "stale" in rules.objection(edit(1, stamp_ns=19), (1,), (), 0.0)
    assert rules.objection(edit(1, stamp_ns=20), (1,), (), 0.0) == ""
    assert rules.objection(edit(1, stamp_ns=0), (1,), (), 0.0) == ""


def test_a_held_keypoint_is_the_holders_until_it_is_released_or_given_up():
    rules = EditRules()
    assert rules.objection(edit(1, EditKind.GRAB), (1,), (), 0.0) == ""
    assert "held by 'anna'" in rules.objection(edit(1, EditKind.GRAB, "bert"), (1,), (), 1.0)
    rules.keep(edit(1, EditKind.HOLD), 9.0)
    assert "held by 'anna'" in rules.objection(edit(1, EditKind.GRAB, "bert"), (1,), (), 15.0)
    rules.release(edit(1))
    assert rules.objection(edit(1, EditKind.GRAB, "bert"), (1,), (), 15.0) == ""


def test_a_locked_keypoint_is_neither_grabbed_nor_dragged():
    rules = EditRules()
    for kind in (EditKind.GRAB, EditKind.DRAG):
        assert rules.objection(edit(1, kind), (1,), (1,), 0.0) == "keypoint 1 is locked: unlock it first"
    assert rules.objection(edit(1, EditKind.CHANGE), (1,), (1,), 0.0) == ""


def test_who_is_refused_a_grab_of_a_locked_keypoint_does_not_hold_it():
    rules = EditRules()
    assert "locked" in rules.objection(edit(1, EditKind.GRAB), (1,), (1,), 0.0)
    assert rules.objection(edit(1, EditKind.CHANGE, "bert"), (1,), (1,), 0.1) == ""
