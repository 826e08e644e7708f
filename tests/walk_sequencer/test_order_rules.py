# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Keypoints that come before others, and stretches that stay together, with every method and around what is pinned."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest
import scenes
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from order_oracle import brute_force, euclidean, keeps, ordered

from walk_building import Building
from walk_building.errors import ParameterError
from walk_sequencer.authority import Authority
from walk_sequencer.config import SequencerConfig
from walk_sequencer.editing import EditingConfig
from walk_sequencer.journal import Journal
from walk_sequencer.order import ORDERS, order_cost
from walk_sequencer.pipeline import plan_tour
from walk_sequencer.reorder import reorder, saved_m
from walk_sequencer.rules import Rules, conflict, parse
from walk_sequencer.wishes import Wish

EYE = 1.6
POINTS = np.array([(1.0, 1.0, EYE), (7.0, 1.0, EYE), (3.0, 3.0, EYE), (7.0, 3.0, EYE), (1.0, 3.5, EYE)])


@pytest.fixture(scope="module")
def rooms() -> Building:
    return scenes.building_of(scenes.two_rooms())


@st.composite
def any_rules(draw: st.DrawFn, n: int) -> Rules:
    """Rules about n keypoints, often ones that nothing keeps."""
    index = st.integers(0, n - 1)
    before = draw(st.lists(st.tuples(index, index), max_size=4))
    mixed, size = draw(st.permutations(range(n))), draw(st.sampled_from([0, 2, 3]))
    stretches = [tuple(mixed[at : at + size]) for at in range(0, n - size + 1, size)][:2] if size else []
    return Rules(before=tuple(before), stretches=tuple(stretches))


@settings(max_examples=300, deadline=None)
@given(rules=any_rules(5), start=st.integers(-1, 4), end=st.integers(-1, 4))
def test_rules_conflict_exactly_where_no_permutation_keeps_them(rules: Rules, start: int, end: int) -> None:
    end = -1 if end == start else end
    possible = any(keeps(p, start, end, rules) for p in itertools.permutations(range(5)))
    assert (conflict(rules, start, end) == "") == possible


@settings(max_examples=60, deadline=None)
@given(data=st.data(), seed=st.integers(0, 99))
def test_exact_order_under_rules_costs_what_the_best_permutation_costs(data: st.DataObject, seed: int) -> None:
    rules = data.draw(any_rules(6).filter(lambda rules: not conflict(rules)))
    costs = np.random.default_rng(seed).uniform(0.0, 9.0, (6, 6))
    order = ordered("exact", costs, rules=rules)
    assert keeps(tuple(order.tolist()), rules=rules)
    assert order_cost(costs, order) == pytest.approx(brute_force(costs, -1, -1, rules))


@settings(max_examples=100, deadline=None)
@given(data=st.data(), n=st.integers(3, 12), seed=st.integers(0, 99), name=st.sampled_from(sorted(ORDERS)))
def test_every_method_keeps_the_rules_and_the_ends(data: st.DataObject, n: int, seed: int, name: str) -> None:
    start = data.draw(st.integers(-1, n - 1))
    end = data.draw(st.integers(-1, n - 1).filter(lambda k: k < 0 or k != start))
    rules = data.draw(any_rules(n).filter(lambda rules: not conflict(rules, start, end)))
    costs = np.random.default_rng(seed).uniform(0.0, 9.0, (n, n))
    order = tuple(ordered(name, costs, start, end, rules, kicks=2).tolist())
    assert sorted(order) == list(range(n))
    assert keeps(order, start, end, rules)


def some_rules(n: int, seed: int) -> Rules:
    """A third as many pairs as keypoints, none against a hidden order, and one stretch."""
    random = np.random.default_rng(seed)
    hidden = random.permutation(n).tolist()
    picks = (sorted(random.choice(n, 2, replace=False).tolist()) for _ in range(n // 3))
    return Rules(before=tuple((hidden[a], hidden[b]) for a, b in picks), stretches=(tuple(hidden[3:5]),))


def test_local_search_under_rules_is_within_one_percent_of_the_exact_order() -> None:
    for seed in range(10):
        costs, rules = euclidean(13, seed), some_rules(13, seed)
        best = order_cost(costs, ordered("exact", costs, rules=rules))
        assert order_cost(costs, ordered("local_search", costs, rules=rules)) <= 1.01 * best


def test_rules_cost_something_and_a_hundred_keypoints_keep_them() -> None:
    costs, rules = euclidean(100, 0), some_rules(100, 0)
    free, bound = ordered("auto", costs), ordered("auto", costs, rules=rules)
    assert not keeps(tuple(free.tolist()), rules=rules)
    assert keeps(tuple(bound.tolist()), rules=rules)
    assert order_cost(costs, free) < order_cost(costs, bound) < 2.5 * order_cost(costs, free)


@pytest.mark.parametrize(
    ("before", "together", "sentence"),
    [
        ("1<2, 2<1", "", "a circle: 1 before 2 before 1"),
        ("1<2<3<1", "", "a circle: 1 before 2 before 3 before 1"),
        ("3<3", "", "a circle: 3 before 3"),
        ("2<1", "1-4-2", "a circle: "),
        ("1<5, 5<2", "1-4-2", "a circle around what stays together: 1-4-2 before 5 before 1-4-2"),
        ("", "1-4, 4-2", "each keypoint at most once"),
        ("1<", "", "numbers of keypoints such as 3<7"),
        ("1-2", "", "numbers of keypoints such as 3<7"),
        ("", "kitchen-2", "numbers of keypoints such as 3-7"),
    ],
)
def test_rules_that_make_no_sense_are_refused_in_one_sentence(before: str, together: str, sentence: str) -> None:
    with pytest.raises(ParameterError) as caught:
        SequencerConfig(before=before, together=together)
    assert sentence in str(caught.value) and "\n" not in str(caught.value)


def test_rules_against_the_chosen_ends_are_refused() -> None:
    with pytest.raises(ParameterError, match="2 before 1, where the tour starts"):
        SequencerConfig(before="2<1", start=1)
    with pytest.raises(ParameterError, match="3 behind 1, where the tour ends"):
        SequencerConfig(before="1<3", end=1)


def test_texts_and_rules_are_two_ways_to_say_the_same() -> None:
    rules = parse(" 3<7 < 2, 5<2 ", "4-8-1,6 - 9,")
    assert rules == Rules(before=((3, 7), (7, 2), (5, 2)), stretches=((4, 8, 1), (6, 9)))
    assert parse(*rules.texts()) == rules
    assert not parse("", " ")


def test_what_follows_through_a_keypoint_that_is_gone_stays() -> None:
    rules = Rules(before=((1, 2), (2, 3)), stretches=((4, 2, 5),))
    left = rules.renamed(lambda k: -1 if k == 2 else k)
    assert {(1, 3), (1, 5), (4, 5)} <= set(left.before)
    assert left.stretches == ((4, 5),)


@pytest.mark.parametrize("method", sorted(ORDERS))
def test_a_tour_keeps_the_rules_and_leaves_out_who_cannot_be_reached(rooms: Building, method: str) -> None:
    points = np.vstack([POINTS, [(4.0, 30.0, EYE)]])
    config = SequencerConfig(method=method, before="3<5<0, 1<4", together="2-4")
    order = plan_tour(rooms, points, config).order.tolist()
    assert sorted(order) == [0, 1, 2, 3, 4]
    assert order.index(3) < order.index(0) and order.index(1) < order.index(4)
    assert order.index(2) + 1 == order.index(4)


def test_a_rule_about_no_keypoint_is_refused(rooms: Building) -> None:
    with pytest.raises(ParameterError, match="numbers below 5, that of keypoints, which 7 is not"):
        plan_tour(rooms, POINTS, SequencerConfig(before="1<7"))


def line(n: int) -> NDArray[np.float64]:
    return np.abs(np.subtract.outer(np.arange(n), np.arange(n))).astype(float)


def test_a_better_order_around_what_is_pinned_keeps_the_rules() -> None:
    config = SequencerConfig(before="5<1", together="3-2")
    order = reorder(line(8), np.array([0, 4, 2, 6, 3, 1, 5, 7]), {0, 7}, config)
    assert keeps(tuple(order.tolist()), 0, 7, config.rules)
    # From 0 over 5 and 3-2 to 1, then 4 and 6 on the way to 7: nothing shorter keeps the rules.
    assert saved_m(line(8), np.array([0, 4, 5, 3, 2, 1, 6, 7]), {0, 7}, config) == 0.0


def test_what_is_pinned_goes_before_the_rules() -> None:
    order = np.array([0, 2, 1, 3])
    assert reorder(line(4), order, {0, 3}, SequencerConfig()).tolist() == [0, 1, 2, 3]
    assert reorder(line(4), order, {0, 3}, SequencerConfig(before="1<0")).tolist() == [0, 2, 1, 3]


def test_rules_of_the_sequencer_name_identities_and_a_hand_goes_before_them(rooms: Building, tmp_path: Path) -> None:
    authority = Authority(rooms, Journal(tmp_path, rooms.hash))
    authority.adopt(POINTS, np.tile([0.0, 0.0, 0.0, 1.0], (5, 1)))
    free = authority.plan(SequencerConfig()).keypoints.order
    config = SequencerConfig(before=f"{free[-1]}<{free[0]}", together=f"{free[3]}-{free[1]}")
    bound = authority.plan(config, anew=True).keypoints.order
    assert bound.index(free[-1]) < bound.index(free[0])
    assert bound.index(free[3]) + 1 == bound.index(free[1])
    assert (
        authority.edit(Wish(kind="reorder", keypoint=free[0], argument="first"), config, EditingConfig()).reason == ""
    )
    assert authority.keypoints.order[0] == free[0]
    again = authority.plan(config, anew=True).keypoints.order
    assert again.index(free[-1]) < again.index(free[0])
    # A locked keypoint stays where it is, whatever the rules say.
    assert authority.edit(Wish(kind="start", keypoint=free[0]), config, EditingConfig()).reason == ""
    assert authority.plan(config, anew=True).keypoints.order[0] == free[0]
