# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The path while it is edited: what is confirmed stays, what is changed is solved, what comes back is the same."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from walk_building import BodySweep, Building
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.live import LivePath, Revision, live_path
from walk_trajopt.path import OptimisedPath
from walk_trajopt.pieces import Pieces

PLACES = {0: (1, 1), 1: (3, 6), 2: (6, 2), 3: (9, 6), 4: (11, 1)}


def eyes(*xy: tuple[float, float]) -> NDArray[np.float64]:
    return np.array([(x, y, 1.6) for x, y in xy], dtype=np.float64)


def revision(places: dict[int, tuple[float, float]], *locked: int) -> Revision:
    points = eyes(*places.values())
    return Revision(ids=tuple(places), keypoints=points, polyline=points, locked=frozenset(locked))


def free(building: Building, path: OptimisedPath) -> bool:
    return bool(BodySweep(building.geometry, building.walker).segments_free(path.points).all())


def near(path: OptimisedPath, k: int, place: tuple[float, float]) -> float:
    return float(np.linalg.norm(path.points[path.keypoint_index[k], :2] - place))


@pytest.fixture
def live(hall: Building) -> LivePath:
    live = live_path(hall, TrajoptConfig())
    live.follow(revision(PLACES))
    return live


@pytest.fixture
def solves(monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, int]]:
    """The ranges of points that are solved from here on."""
    seen: list[tuple[int, int]] = []
    solve = Pieces.solve

    def watched(self, state, first, last, config):  # type: ignore[no-untyped-def]
        seen.append((first, last))
        return solve(self, state, first, last, config)

    monkeypatch.setattr(Pieces, "solve", watched)
    return seen


def test_the_path_shown_at_the_drag_stays_when_it_is_confirmed(live: LivePath, solves: list[tuple[int, int]]) -> None:
    shown = live.move(2, np.array([6.5, 2.4, 1.6])).path
    solves.clear()
    confirmed = live.follow(revision({**PLACES, 2: (6.5, 2.4)}))
    assert solves == []
    np.testing.assert_array_equal(confirmed.points, shown.points)


def test_a_revision_that_changes_no_path_solves_nothing(live: LivePath, solves: list[tuple[int, int]]) -> None:
    before = live.path()
    after = live.follow(revision(PLACES))
    assert solves == []
    np.testing.assert_array_equal(after.points, before.points)


def test_undone_revisions_bring_the_same_path_back_bit_for_bit(live: LivePath, hall: Building) -> None:
    first = live.path()
    live.move(1, np.array([2.0, 5.0, 1.6]))
    second = live.follow(revision({**PLACES, 1: (2, 5)}))
    third = live.follow(revision({k: v for k, v in PLACES.items() if k != 3}))
    assert free(hall, second) and free(hall, third)
    np.testing.assert_array_equal(live.follow(revision({**PLACES, 1: (2, 5)})).points, second.points)
    np.testing.assert_array_equal(live.follow(revision(PLACES)).points, first.points)


@pytest.mark.parametrize(
    ("what", "places", "far"),
    [
        ("moved", {**PLACES, 3: (8.5, 5)}, (0, 2)),
        ("moved at the end", {**PLACES, 4: (10, 3)}, (0, 3)),
        ("moved at the start", {**PLACES, 0: (2, 2)}, (1, 4)),
        ("inserted", {0: (1, 1), 1: (3, 6), 2: (6, 2), 7: (8, 3), 3: (9, 6), 4: (11, 1)}, (0, 2)),
        ("inserted behind the end", {**PLACES, 7: (11, 4)}, (0, 4)),
        ("deleted", {k: v for k, v in PLACES.items() if k != 3}, (0, 1)),
        ("deleted at the start", {k: v for k, v in PLACES.items() if k != 0}, (2, 4)),
    ],
)
def test_only_legs_that_changed_are_solved_and_the_others_stay(
    live: LivePath,
    hall: Building,
    solves: list[tuple[int, int]],
    what: str,
    places: dict[int, tuple[float, float]],
    far: tuple[int, int],
) -> None:
    before = live.path()
    after = live.follow(revision(places))
    points = sum(last - first for first, last in solves)
    assert points <= 0.75 * len(before.points), what
    assert free(hall, after) and after.colliding == ()
    assert all(near(after, k, place) < 0.8 for k, place in enumerate(places.values()))
    # A curve's tangents reach a little into the legs beside.
    old = before.points[before.keypoint_index[far[0]] + 12 : before.keypoint_index[far[1]] - 12]
    assert len(old) > 5
    assert {tuple(point) for point in old} <= {tuple(point) for point in after.points}


def test_a_changed_tour_costs_little_more_than_one_solved_as_a_whole(live: LivePath, hall: Building) -> None:
    places = {0: (1, 1), 1: (3, 6), 2: (6, 2), 7: (8, 3), 3: (9, 6), 4: (11, 1)}
    warm = live.follow(revision(places))
    cold = live_path(hall, TrajoptConfig()).follow(revision(places))
    assert warm.total_cost <= 1.1 * cold.total_cost
    assert abs(warm.length_m - cold.length_m) < 0.3


def test_many_revisions_keep_the_parameters_of_the_path_in_order(live: LivePath, hall: Building) -> None:
    rng, places, new = np.random.default_rng(0), dict(PLACES), 10
    for _ in range(25):
        kind = rng.integers(3)
        ids = list(places)
        if kind == 0 and len(ids) > 3:
            places = {k: v for k, v in places.items() if k != ids[rng.integers(len(ids))]}
        elif kind == 1:
            at, new = int(rng.integers(len(ids) + 1)), new + 1
            items = list(places.items())
            places = dict([*items[:at], (new, tuple(rng.uniform([1, 1], [11, 7]))), *items[at:]])
        else:
            places = {**places, ids[rng.integers(len(ids))]: tuple(rng.uniform([1, 1], [11, 7]))}
        path = live.follow(revision(places))
        assert (np.diff(path.keypoint_index) > 0).all() and len(path.keypoint_index) == len(places)
        assert free(hall, path)
        np.testing.assert_allclose(path.points[[0, -1]], eyes(*places.values())[[0, -1]], atol=1e-6)
        assert all(near(path, k, place) < 0.8 for k, place in enumerate(places.values()))


def test_what_is_taken_back_is_the_path_of_the_last_revision(live: LivePath) -> None:
    before = live.path()
    assert live.move(2, np.array([6.5, 2.4, 1.6])).accepted
    np.testing.assert_array_equal(live.take_back().points, before.points)


def test_a_locked_keypoint_is_passed_exactly_and_not_moved(live: LivePath, hall: Building) -> None:
    assert near(live.path(), 2, PLACES[2]) > 0.05, "nothing would be shown"
    locked = live.follow(revision(PLACES, 2))
    assert near(locked, 2, PLACES[2]) < 1e-9 and free(hall, locked)
    refused = live.move(2, np.array([6.5, 2.4, 1.6]))
    assert not refused.accepted and "locked" in refused.reason
    beside = live.move(1, np.array([2.5, 5.0, 1.6]))
    assert beside.accepted and near(beside.path, 2, PLACES[2]) < 1e-9
    cold = live_path(hall, TrajoptConfig()).follow(revision(PLACES, 1, 2, 3))
    assert max(near(cold, k, PLACES[k]) for k in (1, 2, 3)) < 1e-9


def test_a_locked_keypoint_is_passed_exactly_even_where_the_path_is_mended(rooms: Building) -> None:
    # In a corner of the door's wall; so few points and no clearance that the smooth path does not pass.
    config = TrajoptConfig(points=12, weight_clearance=0.0, weight_length=5.0, weight_deviation=0.0)
    tour = eyes((1, 1), (3.5, 1.6), (4.1, 2.05), (5, 2), (7, 3.2))
    places = Revision(ids=(0, 1, 2), keypoints=tour[[0, 1, 4]], polyline=tour, locked=frozenset([1]))
    path = live_path(rooms, config).follow(places)
    assert path.repaired != () and free(rooms, path)
    assert near(path, 1, (3.5, 1.6)) < 1e-9


def test_the_manual_mode_is_a_spline_through_the_keypoints_that_says_where_it_collides(rooms: Building) -> None:
    live = live_path(rooms, TrajoptConfig(mode="catmull_rom"))
    places = {0: (1, 1), 1: (3, 3), 2: (7, 3)}
    path = live.follow(revision(places))
    assert path.solver == "catmull_rom" and path.colliding != ()
    assert all(near(path, k, place) < 1e-9 for k, place in enumerate(places.values()))
    moved = live.move(2, np.array([2.0, 1.5, 1.6]))
    assert moved.accepted and moved.path.colliding == () and near(moved.path, 2, (2, 1.5)) < 1e-9
    np.testing.assert_array_equal(live.take_back().points, path.points)


def test_a_path_that_starts_again_is_the_one_that_was_shown(hall: Building, tmp_path: Path) -> None:
    live = live_path(hall, TrajoptConfig(), tmp_path)
    live.follow(revision(PLACES))
    live.move(2, np.array([6.5, 2.4, 1.6]))
    last = revision({**PLACES, 2: (6.5, 2.4)})
    shown = live.follow(last)
    again = live_path(hall, TrajoptConfig(), tmp_path)
    np.testing.assert_array_equal(again.follow(last).points, shown.points)
    assert again.path().cost == shown.cost
    beside = again.move(2, np.array([6.2, 2.2, 1.6])).path, live.move(2, np.array([6.2, 2.2, 1.6])).path
    np.testing.assert_array_equal(beside[0].points, beside[1].points)
    cold = live_path(hall, TrajoptConfig()).follow(last)
    other = live_path(hall, TrajoptConfig(weight_length=0.02), tmp_path).follow(last)
    assert not np.array_equal(cold.points, shown.points) and not np.array_equal(other.points, shown.points)


def test_a_kept_path_that_is_damaged_is_solved_again(hall: Building, tmp_path: Path) -> None:
    cold = live_path(hall, TrajoptConfig(), tmp_path).follow(revision(PLACES))
    (file,) = tmp_path.iterdir()
    file.write_bytes(file.read_bytes()[:1000])
    again = live_path(hall, TrajoptConfig(), tmp_path).follow(revision(PLACES))
    np.testing.assert_array_equal(again.points, cold.points)


@pytest.mark.parametrize("mode", ["optimised", "b_spline"])
def test_an_unknown_keypoint_is_refused(hall: Building, mode: str) -> None:
    live = live_path(hall, TrajoptConfig(mode=mode))
    live.follow(revision(PLACES))
    outcome = live.move(99, np.array([6.5, 2.4, 1.6]))
    assert not outcome.accepted and "no such keypoint" in outcome.reason


def test_a_revision_equals_another_by_its_path_alone() -> None:
    one = revision(PLACES, 2)
    assert one.key == dataclasses.replace(one, locked=frozenset([2, 99])).key
    assert one.key != revision(PLACES).key


@pytest.mark.parametrize("mode", ["optimised", "b_spline"])
def test_what_is_taken_back_of_one_hand_leaves_what_another_drags(hall: Building, mode: str) -> None:
    both, other = live_path(hall, TrajoptConfig(mode=mode)), live_path(hall, TrajoptConfig(mode=mode))
    both.follow(revision(PLACES))
    other.follow(revision(PLACES))
    for k, place in ((1, (3.3, 5.8)), (3, (8.8, 5.7))):
        assert both.move(k, eyes(place)[0]).accepted
    assert other.move(3, eyes((8.8, 5.7))[0]).accepted
    np.testing.assert_array_equal(both.take_back(1).points, other.path().points)
    np.testing.assert_allclose(both.keypoints[3, :2], (8.8, 5.7))
    untouched = other.take_back(3).points
    np.testing.assert_array_equal(both.take_back().points, untouched)
