# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from order_oracle import brute_force, euclidean, ordered

from walk_building.errors import ParameterError
from walk_sequencer.order import ORDERS, order_cost, resolve_method

SHORT = ("exact", "local_search")


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("start", "end"), [(-1, -1), (2, -1), (-1, 0), (0, 5)])
def test_exact_order_costs_what_the_best_of_all_permutations_costs(seed: int, start: int, end: int) -> None:
    costs = np.random.default_rng(seed).uniform(0.0, 9.0, (7, 7))  # neither symmetric nor a metric
    order = ordered("exact", costs, start, end)
    assert order_cost(costs, order) == pytest.approx(brute_force(costs, start, end))


@pytest.mark.parametrize("n", [10, 12, 14])
def test_local_search_is_within_one_percent_of_the_exact_order(n: int) -> None:
    gaps = []
    for seed in range(8):
        costs = euclidean(n, seed)
        best = order_cost(costs, ordered("exact", costs))
        gaps.append(order_cost(costs, ordered("local_search", costs)) / best - 1.0)
    assert min(gaps) > -1e-9
    assert np.mean(gaps) < 0.0033
    assert max(gaps) < 0.01


def test_local_search_finds_the_best_order_of_asymmetric_costs() -> None:
    for seed in range(5):
        costs = np.random.default_rng(seed).uniform(1.0, 9.0, (11, 11))
        for start, end in ((-1, -1), (3, -1), (3, 7)):
            best = order_cost(costs, ordered("exact", costs, start, end))
            assert order_cost(costs, ordered("local_search", costs, start, end)) <= 1.03 * best


@pytest.mark.parametrize("end", [-1, 4])
def test_tree_order_costs_at_most_twice_the_optimum_of_a_metric(end: int) -> None:
    worse = 0
    for seed in range(20):
        costs = euclidean(10, seed)
        ratio = order_cost(costs, ordered("mst_dfs", costs, 0, end)) / order_cost(
            costs, ordered("exact", costs, 0, end)
        )
        assert 1.0 - 1e-9 <= ratio <= 2.0
        worse += ratio > 1.01
    assert worse > 10  # else it is not the source's method


@settings(max_examples=60, deadline=None)
@given(data=st.data(), n=st.integers(1, 12), name=st.sampled_from(sorted(ORDERS)))
def test_every_order_visits_each_once_and_keeps_the_ends(data: st.DataObject, n: int, name: str) -> None:
    costs = np.array(data.draw(st.lists(st.floats(0.0, 1e3), min_size=n * n, max_size=n * n))).reshape(n, n)
    start = data.draw(st.integers(-1, n - 1))
    end = data.draw(st.integers(-1, n - 1).filter(lambda k: k < 0 or k != start))
    order = ordered(name, costs, start, end, kicks=2)
    assert sorted(order.tolist()) == list(range(n))
    assert start < 0 or order[0] == start
    assert end < 0 or order[-1] == end


@pytest.mark.parametrize("name", sorted(ORDERS))
def test_every_order_of_none_is_empty(name: str) -> None:
    assert len(ordered(name, np.zeros((0, 0)))) == 0


def test_given_order_moves_only_the_chosen_ends() -> None:
    order = ordered("given", np.zeros((5, 5)), 3, 0)
    assert order.tolist() == [3, 1, 2, 4, 0]


@pytest.mark.parametrize("name", SHORT)
def test_keypoints_on_a_line_are_walked_from_end_to_end(name: str) -> None:
    x = np.random.default_rng(4).permutation(14).astype(float)
    costs = np.abs(x[:, None] - x[None])
    assert order_cost(costs, ordered(name, costs)) == pytest.approx(13.0)


def test_auto_is_exact_up_to_sixteen() -> None:
    assert [resolve_method("auto", n) for n in (0, 16, 17)] == ["exact", "exact", "local_search"]
    assert resolve_method("mst_dfs", 3) == "mst_dfs"


def test_exact_refuses_what_it_cannot_hold() -> None:
    with pytest.raises(ParameterError, match="local_search for 17 keypoints"):
        ordered("exact", euclidean(17, 0))


def test_local_search_of_sixty_reaches_the_best_of_many_kicks_within_two_percent() -> None:
    costs = euclidean(60, 1)
    usual = order_cost(costs, ordered("local_search", costs))
    long = order_cost(costs, ordered("local_search", costs, kicks=400, seed=7))
    assert usual <= 1.02 * long


def test_a_hundred_keypoints_on_a_circle_are_walked_around_it() -> None:
    angle = np.random.default_rng(2).permutation(100) * 2.0 * np.pi / 100
    points = 10.0 * np.column_stack([np.cos(angle), np.sin(angle)])
    costs = np.linalg.norm(points[:, None] - points[None], axis=2)
    assert order_cost(costs, ordered("auto", costs)) == pytest.approx(99 * 20.0 * np.sin(np.pi / 100))


def test_a_hundred_keypoints_on_a_lattice_are_within_one_percent_of_unit_steps() -> None:
    points = np.random.default_rng(3).permutation(np.argwhere(np.ones((10, 10)))).astype(float)
    costs = np.linalg.norm(points[:, None] - points[None], axis=2)
    assert order_cost(costs, ordered("auto", costs)) <= 1.01 * 99


def test_sixty_keypoints_on_a_slope_are_walked_downhill() -> None:
    height = np.random.default_rng(4).permutation(60).astype(float)
    rise = height[None] - height[:, None]
    costs = np.where(rise > 0.0, 2.0 * rise, -rise)
    order = ordered("auto", costs)
    assert height[order].tolist() == sorted(height, reverse=True)
