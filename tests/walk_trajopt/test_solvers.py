# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""All solvers find the same minimum, and it is the one that can be computed by hand."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from walk_building import Building
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.objectives import OBJECTIVES, Setting
from walk_trajopt.problem import Problem
from walk_trajopt.solvers import SOLVERS

MakeSetting = Callable[..., Setting]
NAMES = sorted(SOLVERS)


def tolerance(name: str) -> TrajoptConfig:
    # The plain method needs many more, cheaper steps.
    return TrajoptConfig(solver=name, max_iterations=20_000 if name == "lbfgs" else 500, tolerance=1e-9)


def weighing(solver: str, iterations: int, **weights: float) -> TrajoptConfig:
    """The settings with these objectives alone."""
    every = {f"weight_{name}": weights.get(name, 0.0) for name in OBJECTIVES}
    return TrajoptConfig(solver=solver, max_iterations=iterations, tolerance=1e-12, **every)


def ends(n: int) -> np.ndarray:
    fixed = np.zeros(n, bool)
    fixed[[0, -1]] = True
    return fixed


@pytest.mark.parametrize("name", NAMES)
def test_length_alone_gives_the_straight_line(name: str, hall: Building, make_setting: MakeSetting) -> None:
    t = np.linspace(0, 1, 40)
    start = np.column_stack([2 + 8 * t, 4 + 2 * np.sin(3 * t), 1.6 + 0 * t])
    config = weighing(name, 5000, length=1.0)
    x = SOLVERS[name](Problem(make_setting(hall, start), config, ends(40)), start, config).x
    np.testing.assert_allclose(x, start[0] + t[:, None] * (start[-1] - start[0]), atol=2e-3)


@pytest.mark.parametrize("name", NAMES)
def test_clearance_pushes_out_to_the_wished_distance(name: str, hall: Building, make_setting: MakeSetting) -> None:
    t = np.linspace(0, 1, 30)
    start = np.column_stack([3 + 5 * t, np.full(30, 0.3), np.full(30, 1.6)])
    config = weighing(name, 2000, clearance=100.0, deviation=1e-4, height=1.0)
    setting = make_setting(hall, start, clearance_of="eye")
    x = SOLVERS[name](Problem(setting, config, np.zeros(30, bool)), start, config).x
    np.testing.assert_allclose(x[:, 1], 0.6, atol=1e-3)


@pytest.mark.parametrize("name", NAMES)
def test_height_alone_follows_the_ramp(name: str, sloping: Building, make_setting: MakeSetting) -> None:
    t = np.linspace(0, 1, 30)
    start = np.column_stack([3 + 6 * t, np.full(30, 1.0), 1.75 + 0.125 * (1 + 6 * t)])
    config = weighing(name, 2000, height=10.0, deviation=1e-5)
    x = SOLVERS[name](Problem(make_setting(sloping, start), config, np.zeros(30, bool)), start, config).x
    np.testing.assert_allclose(x[:, 2], 1.6 + 0.125 * (x[:, 0] - 2), atol=5e-3)


def test_all_solvers_reach_the_same_cost(rooms: Building, make_setting: MakeSetting) -> None:
    corners = np.array([[1, 0.5, 1.6], [1, 2, 1.6], [3.5, 2, 1.6], [4.8, 2, 1.6], [7, 3.2, 1.6]])
    arc = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))])
    at = np.linspace(0, arc[-1], 60)
    start = np.column_stack([np.interp(at, arc, corners[:, k]) for k in range(3)])
    costs = {}
    for name in NAMES:
        config = tolerance(name)
        problem = Problem(make_setting(rooms, start, clearance_m=0.42), config, ends(60))
        solution = SOLVERS[name](problem, start, config)
        assert solution.cost == pytest.approx(problem.evaluate(solution.x)[0])
        assert solution.cost < problem.evaluate(start)[0]
        np.testing.assert_array_equal(solution.x[[0, -1]], start[[0, -1]])
        costs[name] = solution.cost
    assert max(costs.values()) == pytest.approx(min(costs.values()), rel=0.01), costs


def test_the_default_is_no_worse_than_the_source_where_a_door_is_narrower_than_wished(
    rooms: Building, make_setting: MakeSetting
) -> None:
    t = np.linspace(0, 1, 60)
    start = np.column_stack([1 + 6 * t, 2.05 + 0 * t, np.full(60, 1.6)])
    costs = {}
    for name, config in (("levenberg_marquardt", TrajoptConfig()), ("lbfgs", TrajoptConfig(max_iterations=1000))):
        problem = Problem(make_setting(rooms, start, clearance_m=0.6), config, ends(60))
        costs[name] = SOLVERS[name](problem, start, config).cost
    assert costs["levenberg_marquardt"] <= 1.01 * costs["lbfgs"], costs


@pytest.mark.parametrize("name", NAMES)
def test_no_iterations_leave_the_start(name: str, hall: Building, make_setting: MakeSetting) -> None:
    start = np.column_stack([np.linspace(2, 8, 10), np.full(10, 4.0), np.full(10, 1.6)])
    config = TrajoptConfig(solver=name, max_iterations=0)
    np.testing.assert_allclose(
        SOLVERS[name](Problem(make_setting(hall, start), config, ends(10)), start, config).x, start
    )
