# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Orders under rules against the best there are, and the bounds that they are measured by."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from order_oracle import brute_force, euclidean, keeps, least_by_sets, ordered

from walk_sequencer.bench_order import least_cost, random_rules
from walk_sequencer.order import order_cost
from walk_sequencer.order.ruin import recreate
from walk_sequencer.rules import Rules


def early_of(n: int, rules: Rules) -> NDArray[np.bool_]:
    early = np.zeros((n + 1, n + 1), bool)
    for a, b in rules.implied():
        early[a + 1, b + 1] = True
    return early


@pytest.mark.parametrize("seed", range(4))
def test_the_bound_without_rules_is_the_cost_of_the_best_permutation(seed: int) -> None:
    one_way = np.random.default_rng(seed).uniform(0.0, 9.0, (7, 7))
    for costs in (one_way, euclidean(7, seed)):
        assert least_cost(costs) == pytest.approx(brute_force(costs, -1, -1))


@pytest.mark.parametrize("n", [2, 3, 12, 30])
def test_a_recreated_tour_keeps_the_rules_and_is_never_longer(n: int) -> None:
    for seed in range(4):
        rules, random = random_rules(n, seed), np.random.default_rng(seed)
        closed = np.zeros((n + 1, n + 1))
        closed[1:, 1:] = random.uniform(0.0, 9.0, (n, n))
        first = ordered("given", closed[1:, 1:], rules=rules)
        tour = recreate(closed, early_of(n, rules), np.r_[0, first + 1], 500, random)
        assert tour[0] == 0
        assert keeps(tuple((tour[1:] - 1).tolist()), rules=rules)
        assert order_cost(closed[1:, 1:], tour[1:] - 1) <= order_cost(closed[1:, 1:], first) + 1e-9


def test_ruin_and_recreate_alone_finds_the_best_order_under_rules() -> None:
    for seed in range(6):
        n, rules = 12, random_rules(12, seed)
        closed = np.zeros((n + 1, n + 1))
        closed[1:, 1:] = euclidean(n, seed)
        first = ordered("given", closed[1:, 1:], rules=rules)
        tour = recreate(closed, early_of(n, rules), np.r_[0, first + 1], 20000, np.random.default_rng(seed))
        best = order_cost(closed[1:, 1:], ordered("exact", closed[1:, 1:], rules=rules))
        assert order_cost(closed[1:, 1:], tour[1:] - 1) <= 1.001 * best


@pytest.mark.parametrize("seed", range(4))
def test_the_oracle_under_rules_finds_the_cost_of_the_best_permutation(seed: int) -> None:
    costs, rules = np.random.default_rng(seed).uniform(0.0, 9.0, (7, 7)), random_rules(7, seed)
    assert least_by_sets(costs, rules) == pytest.approx(brute_force(costs, -1, -1, rules))


def test_sixteen_under_rules_cost_the_least_by_the_exact_order_and_at_most_a_percent_more_by_the_search() -> None:
    for seed in range(40):
        one_way = np.random.default_rng(seed).uniform(1.0, 9.0, (16, 16))
        costs, rules = one_way if seed % 4 == 0 else euclidean(16, seed), random_rules(16, seed)
        best = least_by_sets(costs, rules)
        exact, searched = ordered("exact", costs, rules=rules), ordered("local_search", costs, rules=rules)
        assert keeps(tuple(searched.tolist()), rules=rules)
        assert order_cost(costs, exact) == pytest.approx(best)
        assert order_cost(costs, searched) <= 1.01 * best


def test_fifty_under_rules_are_within_one_percent_of_a_longer_search() -> None:
    costs, rules = euclidean(50, 3), random_rules(50, 3)
    usual = ordered("local_search", costs, rules=rules)
    longer = ordered("local_search", costs, rules=rules, kicks=160, seed=7)
    assert keeps(tuple(usual.tolist()), rules=rules)
    assert order_cost(costs, usual) <= 1.01 * order_cost(costs, longer)
