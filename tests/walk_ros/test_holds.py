# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from walk_ros.holds import Holds


def test_what_one_holds_another_does_not_get():
    holds = Holds()
    assert holds.take(3, "anna", 0.0, 10.0) == ""
    assert holds.take(3, "bert", 1.0, 10.0) == "anna"
    assert holds.take(4, "bert", 1.0, 10.0) == ""


def test_a_release_frees_and_only_by_the_holder():
    holds = Holds()
    holds.take(3, "anna", 0.0, 10.0)
    holds.release(3, "bert")
    assert holds.take(3, "bert", 1.0, 10.0) == "anna"
    holds.release(3, "anna")
    assert holds.take(3, "bert", 1.0, 10.0) == ""


def test_a_silent_editor_loses_its_keypoint_and_a_busy_one_keeps_it():
    holds = Holds()
    holds.take(3, "anna", 0.0, 10.0)
    assert holds.take(3, "bert", 10.0, 10.0) == "anna"
    holds.take(3, "anna", 9.0, 10.0)
    assert holds.take(3, "bert", 15.0, 10.0) == "anna"
    assert holds.take(3, "bert", 19.1, 10.0) == ""
