# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What holds for every objective, and the closed forms of each."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from walk_building import Building
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.objectives import OBJECTIVES, PointwiseObjective, QuadraticObjective, Setting
from walk_trajopt.problem import Problem

MakeSetting = Callable[..., Setting]
NAMES = sorted(OBJECTIVES)


def line(n: int, start: tuple[float, float] = (3.0, 1.0), end: tuple[float, float] = (9.0, 1.0)) -> NDArray[np.float64]:
    """Straight up the ramp at eye height."""
    t = np.linspace(0, 1, n)
    x, y = (a + (b - a) * t for a, b in zip(start, end, strict=True))
    return np.column_stack([x, y, 1.6 + 0.125 * (x - 2)])


def wiggled(points: NDArray[np.float64], size: float) -> NDArray[np.float64]:
    """The points moved by a smooth function of their place along the line, the same for every number of them."""
    t = np.linspace(0, 1, len(points))
    return points + size * np.column_stack([np.sin(5 * t), np.sin(9 * t + 1), 0.4 * np.cos(7 * t)])


@pytest.mark.parametrize("name", NAMES)
def test_every_objective_has_a_weight_of_its_name(name: str) -> None:
    # A new one may be off by default, with the weight 0; a user turns it on by name.
    assert TrajoptConfig().weight(name) >= 0
    assert TrajoptConfig(**{f"weight_{name}": 2.5}).weight(name) == 2.5


@pytest.mark.parametrize("of", ["body", "eye"])
@pytest.mark.parametrize("name", NAMES)
def test_gradient_agrees_with_finite_differences(
    name: str, of: str, sloping: Building, make_setting: MakeSetting
) -> None:
    # Near the wall at y = 0, so that the clearance has something to say, and its ceiling-high neighbours do not.
    objective = OBJECTIVES[name](make_setting(sloping, line(12, (3, 0.7), (9, 0.7)), clearance_of=of))
    x = wiggled(line(12, (3, 0.7), (9, 0.7)), 0.3)
    value, gradient = objective.evaluate(x)
    assert value > 0, "the test would say nothing"
    numeric = np.zeros_like(x)
    for i in np.ndindex(*x.shape):
        step = np.zeros_like(x)
        step[i] = 1e-5
        numeric[i] = (objective.evaluate(x + step)[0] - objective.evaluate(x - step)[0]) / 2e-5
    np.testing.assert_allclose(gradient, numeric, atol=2e-2 * np.abs(numeric).max())


@pytest.mark.parametrize("name", NAMES)
def test_value_is_never_negative(name: str, sloping: Building, make_setting: MakeSetting) -> None:
    start = line(20)
    objective = OBJECTIVES[name](make_setting(sloping, start))
    rng = np.random.default_rng(1)
    assert all(objective.evaluate(start + rng.normal(0, 0.5, start.shape))[0] >= 0 for _ in range(50))


@pytest.mark.parametrize(
    ("name", "optimum"),
    [
        ("deviation", line(20)),
        ("length", np.repeat(line(20)[:1], 20, axis=0)),
        ("smoothness", wiggled(line(20), 0)),
        ("clearance", line(20)),
        ("height", line(20)),
        ("keypoints", line(20)),
    ],
)
def test_value_and_gradient_are_zero_at_the_stated_optimum(
    name: str, optimum: NDArray[np.float64], sloping: Building, make_setting: MakeSetting
) -> None:
    objective = OBJECTIVES[name](make_setting(sloping, line(20)))
    value, gradient = objective.evaluate(optimum)
    assert value == pytest.approx(0, abs=1e-6)
    np.testing.assert_allclose(gradient, 0, atol=1e-3)


@pytest.mark.parametrize("name", NAMES)
def test_value_does_not_depend_on_the_number_of_points(name: str, sloping: Building, make_setting: MakeSetting) -> None:
    values = []
    for n in (101, 401):
        start = line(n, (3, 0.6), (9, 0.6))
        values.append(OBJECTIVES[name](make_setting(sloping, start)).evaluate(wiggled(start, 0.2))[0])
    assert values[0] > 0
    assert values[1] == pytest.approx(values[0], rel=0.03)


@pytest.mark.parametrize("name", NAMES)
def test_terms_sum_up_to_the_value_and_are_local(name: str, sloping: Building, make_setting: MakeSetting) -> None:
    start = line(20, (3, 0.7), (9, 0.7))
    objective = OBJECTIVES[name](make_setting(sloping, start))
    x = wiggled(start, 0.3)
    terms = objective.terms(x)
    assert terms.shape == (20,) and terms.sum() == pytest.approx(objective.evaluate(x)[0], rel=1e-9)
    moved = x.copy()
    moved[10, 1] += 0.1
    changed = np.flatnonzero(np.abs(objective.terms(moved) - terms) > 1e-12)
    assert set(changed) <= {8, 9, 10}, "a term is about the point that has it and the two that follow"


@pytest.mark.parametrize("of", ["body", "eye"])
@pytest.mark.parametrize("name", NAMES)
def test_the_largest_piece_is_the_residual(name: str, of: str, sloping: Building, make_setting: MakeSetting) -> None:
    start = line(40, (3, 0.7), (9, 0.7))
    objective = OBJECTIVES[name](make_setting(sloping, start, clearance_of=of))
    if not isinstance(objective, PointwiseObjective):
        return
    rng = np.random.default_rng(3)
    # Again and again, nearer and farther: what an objective remembers of earlier calls must not change its answer.
    for size in (0.0, 0.02, 0.3, 0.3, 0.05, 1.0, 0.3):
        x = start + rng.normal(0, size, start.shape) if size else start
        shape = len(x), objective.pieces
        values, slopes, bends = np.full(shape, np.nan), np.full((*shape, 3), np.nan), np.full(shape, np.nan)
        objective.write_pieces(x, values, slopes, bends)
        residual, jacobian = objective.residuals(x)
        largest = np.where(values.max(axis=1) > -np.inf, values.max(axis=1), 0.0)
        np.testing.assert_allclose(largest, residual, atol=1e-9)
        at = np.flatnonzero(residual)
        np.testing.assert_allclose(slopes[at, values[at].argmax(axis=1)], jacobian[at], atol=1e-6)
        assert (bends[values > -np.inf] >= 0).all()


@pytest.mark.parametrize("name", NAMES)
def test_pieces_say_how_the_residual_goes_on(name: str, sloping: Building, make_setting: MakeSetting) -> None:
    start = line(12, (3, 0.7), (9, 0.7))
    objective = OBJECTIVES[name](make_setting(sloping, start))
    if not isinstance(objective, PointwiseObjective):
        return
    x = wiggled(start, 0.3)
    shape = len(x), objective.pieces
    values, slopes, bends = np.zeros(shape), np.zeros((*shape, 3)), np.zeros(shape)
    objective.write_pieces(x, values, slopes, bends)
    step = 0.003 * np.random.default_rng(0).normal(size=x.shape)
    known = np.where(values > -np.inf, values, -1e9)
    ahead = (known + np.einsum("ijk,ik->ij", np.where(values[..., None] > -np.inf, slopes, 0), step)).max(axis=1)
    found = objective.residuals(x + step)[0]
    np.testing.assert_allclose(np.where(ahead > -1e8, ahead, 0), found, atol=5e-4)


def test_a_point_between_two_walls_knows_both(rooms: Building, make_setting: MakeSetting) -> None:
    # In the door of 0.9 m, off its middle: the nearer jamb pushes, the other would push back.
    x = np.array([[3.9, 1.9, 1.6], [4.0, 1.9, 1.6]])
    objective = OBJECTIVES["clearance"](make_setting(rooms, x, clearance_m=0.6))
    assert isinstance(objective, PointwiseObjective)
    shape = len(x), objective.pieces
    values, slopes, bends = np.zeros(shape), np.zeros((*shape, 3)), np.zeros(shape)
    objective.write_pieces(x, values, slopes, bends)
    across = np.where(values[1] > -np.inf, slopes[1, :, 1], 0)
    assert across.max() > 0.9 and across.min() < -0.9


def test_quadratic_objectives_have_the_hessian_their_bands_say(hall: Building, make_setting: MakeSetting) -> None:
    start = np.column_stack([np.linspace(2, 8, 9), np.full(9, 4.0), np.full(9, 1.6)])
    for kind in OBJECTIVES.values():
        objective = kind(make_setting(hall, start))
        if not isinstance(objective, QuadraticObjective):
            continue
        dense = np.diag(objective.bands[0])
        for k in (1, 2):
            dense += np.diag(objective.bands[k, :-k], k) + np.diag(objective.bands[k, :-k], -k)
        for i in range(9):
            step = np.zeros_like(start)
            step[i, 1] = 1.0
            slope = objective.evaluate(start + step)[1] - objective.evaluate(start)[1]
            np.testing.assert_allclose(slope[:, 1], 2 * dense[i], atol=1e-9)


def test_closed_forms_of_the_quadratic_objectives(hall: Building, make_setting: MakeSetting) -> None:
    n = 2001
    s = np.linspace(0, 10, n)
    start = np.column_stack([s, np.zeros(n), np.full(n, 1.6)])
    x = start + np.column_stack([np.zeros(n), 0.5 * np.sin(s), np.zeros(n)])
    setting = make_setting(hall, start)
    square_sin = 5 - np.sin(20) / 4
    square_cos = 5 + np.sin(20) / 4
    expected = {"deviation": 0.25 * square_sin, "length": 10 + 0.25 * square_cos, "smoothness": 0.25 * square_sin}
    for name, value in expected.items():
        assert OBJECTIVES[name](setting).evaluate(x)[0] == pytest.approx(value, rel=2e-3)


def test_eye_clearance_is_the_distance_to_the_wall(hall: Building, make_setting: MakeSetting) -> None:
    x = np.column_stack([np.linspace(4, 8, 5), [0.1, 0.3, 0.5, 0.7, 2.0], np.full(5, 1.6)])
    objective = OBJECTIVES["clearance"](make_setting(hall, x, clearance_of="eye"))
    assert isinstance(objective, PointwiseObjective)
    residual, towards = objective.residuals(x)
    np.testing.assert_allclose(residual, [0.5, 0.3, 0.1, 0, 0], atol=1e-9)
    np.testing.assert_allclose(towards[:3], np.tile([0, -1, 0], (3, 1)), atol=1e-9)


def test_a_point_on_the_geometry_gives_no_nan(hall: Building, make_setting: MakeSetting) -> None:
    x = np.array([[4.0, 0.0, 1.6], [5.0, 0.0, 1.6]])
    for of in ("eye", "body"):
        value, gradient = OBJECTIVES["clearance"](make_setting(hall, x, clearance_of=of)).evaluate(x)
        assert np.isfinite(value) and np.isfinite(gradient).all()


def test_fixed_points_have_no_gradient_and_costs_add_up(hall: Building, make_setting: MakeSetting) -> None:
    start = np.column_stack([np.linspace(2, 8, 30), np.full(30, 0.4), np.full(30, 1.6)])
    fixed = np.zeros(30, bool)
    fixed[[0, 7, 29]] = True
    problem = Problem(make_setting(hall, start), TrajoptConfig(), fixed)
    x = wiggled(start, 0.2)
    value, gradient = problem.evaluate(x)
    assert (gradient[fixed] == 0).all() and (gradient[~fixed] != 0).any()
    assert value == pytest.approx(sum(terms.sum() for terms in problem.terms(x).values()))
    assert problem.linearise(x).value == pytest.approx(value)
