# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Edits: local, checked, refused with a reason, undone bit for bit."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from walk_building import BodySweep, Building, ParameterError
from walk_building.route import Router
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.optimiser import Optimiser


def eyes(*xy: tuple[float, float]) -> NDArray[np.float64]:
    return np.array([(x, y, 1.6) for x, y in xy], dtype=np.float64)


@pytest.fixture
def optimiser(hall: Building) -> Optimiser:
    keypoints = eyes((1, 1), (3, 6), (6, 2), (9, 6), (11, 1))
    optimiser = Optimiser(hall, keypoints, keypoints)
    optimiser.solve()
    optimiser.check()
    return optimiser


def test_an_edit_changes_only_the_legs_beside_it(optimiser: Optimiser, hall: Building) -> None:
    before = optimiser.path()
    outcome = optimiser.move_keypoint(3, (9.3, 5.5, 1.6))
    after = outcome.path
    assert outcome.accepted and outcome.reason == ""
    untouched = before.keypoint_index[2] - 20
    np.testing.assert_array_equal(after.points[:untouched], before.points[:untouched])
    assert np.linalg.norm(after.points[after.keypoint_index[3]] - (9.3, 5.5, 1.6)) < 0.8
    assert BodySweep(hall.geometry, hall.walker).segments_free(after.points).all()


def test_many_small_drags_end_where_one_large_one_does(optimiser: Optimiser) -> None:
    start = optimiser.state
    for t in np.linspace(0.1, 1, 10):
        assert optimiser.move_keypoint(2, (6 + t, 2 + t, 1.6)).accepted
    dragged = optimiser.path()
    optimiser.state = start
    jumped = optimiser.move_keypoint(2, (7, 3, 1.6)).path
    assert dragged.total_cost == pytest.approx(jumped.total_cost, rel=0.05)
    assert np.abs(dragged.length_m - jumped.length_m) < 0.1


def test_costs_kept_beside_an_edit_are_those_of_the_whole_path(optimiser: Optimiser) -> None:
    rng = np.random.default_rng(0)
    for _ in range(12):
        keypoint = int(rng.integers(5))
        hasty = bool(rng.integers(2))
        assert optimiser.move_keypoint(keypoint, (*rng.uniform([1, 1], [11, 7]), 1.6), hasty=hasty).accepted
        optimiser.path()  # a hasty move leaves them out until somebody asks
        kept, whole = optimiser.state.terms, optimiser.pieces.terms(optimiser.state)
        for name, terms in whole.items():
            np.testing.assert_allclose(kept[name], terms, atol=1e-9, err_msg=name)


def test_a_state_taken_back_undoes_bit_for_bit(optimiser: Optimiser) -> None:
    state, path = optimiser.state, optimiser.path()
    assert optimiser.move_keypoint(1, (2, 5, 1.6)).accepted
    assert optimiser.move_keypoint(4, (11, 2, 1.6)).accepted
    optimiser.state = state
    np.testing.assert_array_equal(optimiser.path().points, path.points)


def test_ends_can_be_moved(optimiser: Optimiser) -> None:
    assert optimiser.move_keypoint(0, (1, 3, 1.6)).accepted
    path = optimiser.move_keypoint(4, (10, 0.5, 1.6)).path
    np.testing.assert_allclose(path.points[[0, -1]], eyes((1, 3), (10, 0.5)), atol=1e-6)


def test_a_long_drag_brings_its_own_points(optimiser: Optimiser) -> None:
    count = len(optimiser.state.x)
    assert optimiser.move_keypoint(1, (1, 7.5, 1.6)).accepted
    assert optimiser.move_keypoint(2, (11, 7, 1.6)).accepted
    spacing = np.linalg.norm(np.diff(optimiser.state.start, axis=0), axis=1)
    assert len(optimiser.state.x) != count and spacing.max() < 1.6 * np.median(spacing)


def test_an_edit_without_a_way_keeps_the_last_path_and_says_why(screen: Building) -> None:
    keypoints = eyes((1, 1), (2, 3), (1, 5))
    optimiser = Optimiser(screen, keypoints, keypoints)
    optimiser.solve()
    before = optimiser.check()
    through_the_screen = optimiser.move_keypoint(1, (6, 3, 1.6))
    assert not through_the_screen.accepted and "touch" in through_the_screen.reason
    outside = optimiser.move_keypoint(1, (20, 3, 1.6))
    assert not outside.accepted and "no floor" in outside.reason
    np.testing.assert_array_equal(optimiser.path().points, before.points)


@pytest.mark.parametrize("hasty", [False, True])
def test_a_router_leads_a_dragged_keypoint_round_the_screen(screen: Building, hasty: bool) -> None:
    keypoints = eyes((1, 1), (2, 3), (1, 5))
    optimiser = Optimiser(screen, keypoints, keypoints, router=Router(screen))
    optimiser.solve()
    optimiser.check()
    sweep = BodySweep(screen.geometry, screen.walker)
    # Through the screen, which ends at y = 4, back in front of it, and through it again.
    for place in ((6, 3), (6.2, 3), (2, 3), (6, 2), (6, 1)):
        outcome = optimiser.move_keypoint(1, (*place, 1.6), hasty=hasty)
        assert outcome.accepted, outcome.reason
        assert sweep.segments_free(outcome.path.points).all()
        assert np.linalg.norm(outcome.path.points[outcome.path.keypoint_index[1], :2] - place) < 0.75
    assert outcome.path.points[:, 1].max() > 4.2


def test_hasty_moves_keep_what_they_found_and_the_last_one_forgets_it(rooms: Building) -> None:
    # Points half a metre apart and a corner to cut: without more weight on the clearance the curve collides.
    keypoints = eyes((1, 0.6), (3.5, 3.2), (7, 0.6))
    optimiser = Optimiser(rooms, keypoints, keypoints, TrajoptConfig(points=12), router=Router(rooms))
    optimiser.solve()
    optimiser.check()
    sweep = BodySweep(rooms.geometry, rooms.walker)
    firm = []
    for t in np.linspace(0.0, 1.0, 30):
        outcome = optimiser.move_keypoint(1, (3.5 + t, 3.2 - t, 1.6), hasty=True)
        firm.append(int((optimiser.state.firmness > 1.0).sum()))
        assert not outcome.accepted or sweep.segments_free(outcome.path.points).all()
    assert max(firm) > 0, "the test would say nothing"
    dragged = optimiser.move_keypoint(1, (3.5, 3.2, 1.6))
    fresh = Optimiser(rooms, keypoints, keypoints, TrajoptConfig(points=12))
    fresh.solve()
    fresh.check()
    direct = fresh.move_keypoint(1, (3.5, 3.2, 1.6))
    assert dragged.accepted and sweep.segments_free(dragged.path.points).all()
    assert dragged.path.total_cost <= 1.05 * direct.path.total_cost


def test_a_replanned_leg_takes_the_place_of_a_bent_one(screen: Building) -> None:
    keypoints = eyes((1, 1), (2, 3), (1, 5))
    optimiser = Optimiser(screen, keypoints, keypoints)
    optimiser.solve()
    optimiser.check()
    there = eyes((1, 1), (3.4, 4.7), (4, 5), (4.6, 4.7), (6, 3))
    back = eyes((6, 3), (4.6, 4.7), (4, 5), (3.4, 4.9), (1, 5))
    outcome = optimiser.move_keypoint(1, (6, 3, 1.6), before=there, after=back)
    assert outcome.accepted, outcome.reason
    assert BodySweep(screen.geometry, screen.walker).segments_free(outcome.path.points).all()
    assert outcome.path.points[:, 0].max() > 5.2


def test_bad_edits_are_named(optimiser: Optimiser) -> None:
    with pytest.raises(ParameterError, match="index below 5"):
        optimiser.move_keypoint(5, (1, 1, 1.6))
    with pytest.raises(ParameterError, match="finite"):
        optimiser.move_keypoint(1, (np.nan, 1, 1.6))
