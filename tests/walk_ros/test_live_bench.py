# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The measurement of edits over DDS counts honestly, on made-up runs with known figures."""

import numpy as np
import pytest

from walk_ros.conversions import path_to_msg
from walk_ros.live_bench.figures import Sent, Told, match, ratios, replaced_trips, summary_ms, verdict
from walk_ros.live_bench.paths import distances, flaw, path_stamp_ns
from walk_ros.raw import to_bytes

NS = 1_000_000_000
LINE = np.array([[0.0, 0.0, 1.6], [1.0, 0.0, 1.6], [2.0, 0.0, 1.6]])
AHEAD = np.tile([0.0, 0.0, 0.0, 1.0], (3, 1))


def sent(*rows):
    return [Sent(stamp_ns=stamp, keypoint=k, at_s=at) for stamp, k, at in rows]


def told(edit, path, refused=False):
    return Told(edit_stamp_ns=edit, path_stamp_ns=path, refused=refused, reason="no way" if refused else "")


def test_each_edit_waits_for_the_first_path_that_shows_it():
    answers = match(sent((1, 5, 0.0), (2, 5, 1.0)), [told(1, 10), told(2, 11)], {10: 0.25, 11: 1.5})
    assert answers.latency_s == (0.25, 0.5)
    assert (answers.superseded, answers.refused, answers.lost) == (0, 0, 0)


def test_a_superseded_edit_waits_for_the_path_of_the_later_one():
    answers = match(sent((1, 5, 0.0), (2, 5, 1.0)), [told(2, 11)], {11: 1.5})
    assert answers.latency_s == (1.5, 0.5)
    assert answers.superseded == 1


def test_edits_of_different_keypoints_do_not_supersede_each_other():
    answers = match(sent((1, 5, 0.0), (2, 6, 1.0)), [told(2, 11)], {11: 1.5})
    assert answers.latency_s == (0.5,)
    assert answers.lost == 1


def test_a_path_that_never_came_answers_nothing():
    assert match(sent((1, 5, 0.0)), [told(1, 10)], {}).lost == 1


def test_a_path_that_the_next_one_replaced_counts_as_late_as_that() -> None:
    answers = match(sent((1, 5, 0.0), (2, 5, 0.011)), [told(1, 10), told(2, 20)], {20: 0.02})
    assert answers.lost == 0 and answers.superseded == 1
    assert answers.latency_s == pytest.approx((0.02, 0.009))


def test_a_refusal_is_no_path_and_no_loss():
    answers = match(sent((1, 5, 0.0), (2, 5, 1.0)), [told(2, 10, refused=True)], {10: 0.1})
    assert (answers.latency_s, answers.refused, answers.lost) == ((), 2, 0)
    assert answers.reasons == ("no way",)


def test_figures_are_percentiles_in_milliseconds_and_their_ratios():
    ours, null = summary_ms([0.004] * 99 + [0.02]), summary_ms([0.001] * 100)
    assert (ours["p50"], ours["max"], ours["count"]) == (4.0, 20.0, 100)
    assert ratios(ours, null)["p50"] == 4.0
    assert summary_ms([]) == {"count": 0}
    assert verdict({"a": 1.0}, {"a": 1.0, "b": 2.0}) == {"a": True, "b": False}


def path(points, t_s=(0.0, 1.0, 2.0)):
    return to_bytes(path_to_msg(np.array(t_s), points, AHEAD, 3 * NS + 7))


def test_a_path_in_order_has_no_flaw():
    assert flaw(path(LINE), LINE[[0, 2]], frozenset()) == ""
    assert path_stamp_ns(path(LINE)) == 3 * NS + 7


@pytest.mark.parametrize(
    ("data", "word"),
    [
        (path(LINE * [1.0, np.nan, 1.0]), "finite"),
        (path(LINE, (0.0, 2.0, 1.0)), "before the last"),
        (path(LINE, (0.0, 0.0, 0.0)), "one stamp"),
    ],
)
def test_a_path_that_is_none_is_noticed(data, word):
    assert word in flaw(data, LINE, frozenset())


def test_a_path_that_leaves_a_keypoint_out_is_noticed_unless_it_is_in_a_hand():
    far = np.vstack([LINE, [9.0, 0.0, 1.6]])
    assert "keypoint 3" in flaw(path(LINE), far, frozenset())
    assert flaw(path(LINE), far, frozenset({3})) == ""


def test_distances_are_to_the_segments_not_to_the_points():
    np.testing.assert_allclose(distances(np.array([[0.5, 0.3, 1.6], [3.0, 0.0, 1.6]]), LINE), [0.3, 1.0])


def test_a_message_whose_copy_was_replaced_waits_for_the_next_copy():
    began = {1: 0.0, 2: 1.0, 3: 2.0, 4: 3.0}
    assert replaced_trips(began, {1: 0.5, 3: 2.25, 4: 3.125}) == [0.5, 1.25, 0.25, 0.125]
    assert replaced_trips(began, {2: 1.5}) == [1.5, 0.5]
