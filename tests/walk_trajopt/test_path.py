# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From a tour to a checked path: resampling, the guarantee, the repair, splines, bad input."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
import trimesh
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scenes import box, building_of, shell

from walk_building import BodySweep, Building, ParameterError
from walk_trajopt.check import PathCheck
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.curve import refine
from walk_trajopt.objectives import OBJECTIVES
from walk_trajopt.pipeline import optimise_path
from walk_trajopt.polyline import Polyline
from walk_trajopt.resample import keypoint_arcs, resample
from walk_trajopt.spline import spline_path


def eyes(*xy: tuple[float, float]) -> NDArray[np.float64]:
    return np.array([(x, y, 1.6) for x, y in xy], dtype=np.float64)


def swept_free(building: Building, points: NDArray[np.float64]) -> bool:
    return bool(BodySweep(building.geometry, building.walker).segments_free(points).all())


def densely_free(building: Building, points: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Brute force: the body stood at every few millimetres of each segment."""
    sweep = BodySweep(building.geometry, building.walker)
    return np.array(
        [(sweep.standing_clearance(a + np.linspace(0, 1, 60)[:, None] * (b - a)) > 1e-4).all()
         for a, b in itertools.pairwise(points)]
    )  # fmt: skip


def test_resampling_keeps_number_ends_and_keypoints() -> None:
    line = Polyline(eyes((0, 0), (3, 0), (3, 4), (10, 4)))
    arcs = keypoint_arcs(line, eyes((0, 0), (3, 4), (10, 4)))
    np.testing.assert_allclose(arcs, [0, 7, 14])
    for n in (3, 10, 101):
        samples = resample(line, arcs, n)
        assert len(samples.points) == n
        np.testing.assert_allclose(samples.points[samples.keypoint_index], eyes((0, 0), (3, 4), (10, 4)))
        steps = np.diff(samples.arc_m)
        assert n == 3 or steps.max() < 1.6 * steps.min()


def test_keypoints_are_passed_in_their_order_where_a_tour_comes_by_twice() -> None:
    line = Polyline(eyes((0, 0), (2, 0), (4, 0), (2, 0), (0, 0)))
    np.testing.assert_allclose(keypoint_arcs(line, eyes((4, 0), (2, 0))), [4, 6])
    np.testing.assert_allclose(keypoint_arcs(line, eyes((2, 0), (4, 0))), [2, 4])


def test_a_refined_curve_is_as_near_as_asked() -> None:
    angle = np.linspace(0, np.pi, 13)
    circle = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    fine, place = refine(circle, 1e-3)
    chord = np.linalg.norm(np.diff(fine, axis=0), axis=1)
    assert (np.abs(np.linalg.norm(fine, axis=1) - 1) < 5e-3).all()
    assert (chord**2 / 8 < 1.5e-3).all() and (np.diff(place) > 0).all()
    np.testing.assert_allclose(fine[np.isin(place, np.arange(13))], circle, atol=1e-12)


def test_the_quick_check_agrees_with_dense_sampling(rooms: Building) -> None:
    rng = np.random.default_rng(3)
    points = np.column_stack([rng.uniform(0.3, 7.9, 60), rng.uniform(0.3, 3.7, 60), np.full(60, 1.6)])
    found = PathCheck(rooms.geometry, rooms.walker).segments_free(points)
    dense = densely_free(rooms, points)
    assert 5 < found.sum() < 55
    assert not (found & ~dense).any(), "a segment passed on which the body stands in the geometry"
    np.testing.assert_array_equal(found, dense)


@pytest.mark.parametrize(("gap_m", "passes"), [(0.0, False), (0.00015, False), (0.0003, True), (0.002, True)])
def test_the_quick_check_is_stricter_than_the_library_along_a_wall(hall: Building, gap_m: float, passes: bool) -> None:
    y = hall.walker.radius_m + gap_m
    # Grazing in parallel, in a long and in short segments, and towards and away from the wall.
    points = eyes((3, y), (9, y), (9.05, y), (9.1, y), (9.4, y + 0.2), (9.7, y), (9.7, y))
    found = PathCheck(hall.geometry, hall.walker).segments_free(points)
    np.testing.assert_array_equal(found, passes)
    assert not (found & ~BodySweep(hall.geometry, hall.walker).segments_free(points)).any()


def test_what_a_check_remembers_never_changes_its_answer(rooms: Building) -> None:
    rng = np.random.default_rng(4)
    check, answers = PathCheck(rooms.geometry, rooms.walker), []
    along = np.linspace(0.0, 1.0, 80)[:, None]
    for drag in range(60):
        # A hand draws the middle of a way about, through walls and back; now and then it begins somewhere else.
        if drag % 20 == 0:
            ends = np.column_stack([rng.uniform(0.4, 7.8, 2), rng.uniform(0.4, 3.6, 2), (1.6, 1.6)])
            pull = np.zeros(3)
        pull = pull + np.append(rng.normal(scale=0.03, size=2), 0.0)
        points = (1 - along) * ends[0] + along * ends[1] + np.sin(np.pi * along) * pull
        answers.append(check.segments_free(points, remember=True))
        np.testing.assert_array_equal(answers[-1], PathCheck(rooms.geometry, rooms.walker).segments_free(points))
    assert 0.1 < np.mean(answers) < 0.99, "the test would say nothing"


def test_path_is_free_smooth_and_near_its_keypoints(rooms: Building) -> None:
    tour = eyes((1, 1), (1, 2), (7, 2), (7, 3.2))
    path = optimise_path(rooms, tour, tour[[0, 1, 3]])
    assert path.colliding == () and swept_free(rooms, path.points)
    np.testing.assert_allclose(path.points[[0, -1]], tour[[0, -1]])
    assert (np.linalg.norm(path.points[path.keypoint_index] - tour[[0, 1, 3]], axis=1) < 0.8).all()
    assert path.length_m < Polyline(tour).length_m
    assert np.abs(path.points[:, 2] - 1.6).max() < 0.03
    direction = np.diff(path.points, axis=0)
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    assert (direction[1:] * direction[:-1]).sum(axis=1).min() > np.cos(np.radians(30))
    assert not path.points.flags.writeable


@pytest.mark.parametrize("points", [12, 40])
def test_a_thin_wall_between_two_points_is_found_and_repaired(screen: Building, points: int) -> None:
    # So few points and no clearance: a smooth path cuts straight through the screen.
    tour = eyes((1, 1), (3.5, 4.6), (4.0, 4.9), (4.5, 4.6), (7, 1))
    config = TrajoptConfig(points=points, weight_clearance=0.0, weight_length=5.0, weight_deviation=0.0)
    unchecked = np.column_stack([np.linspace(1, 7, points), np.full(points, 1.0), np.full(points, 1.6)])
    assert not swept_free(screen, unchecked)
    path = optimise_path(screen, tour, tour[[0, -1]], config)
    assert path.repaired != ()
    assert path.colliding == () and swept_free(screen, path.points)
    for stretch in path.repaired:
        assert 0 <= stretch.start_m <= stretch.end_m <= path.length_m
        assert (stretch.after_keypoint, stretch.before_keypoint) == (0, 1)


def test_where_even_the_tour_collides_the_stretch_is_named(screen: Building) -> None:
    tour = eyes((1, 1), (7, 1))
    path = optimise_path(screen, tour, tour)
    assert len(path.colliding) >= 1 and not swept_free(screen, path.points)
    arc = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(path.points, axis=0), axis=1))])
    bad = ~BodySweep(screen.geometry, screen.walker).segments_free(path.points)
    for begin, end in zip(arc[:-1][bad], arc[1:][bad], strict=True):
        assert any(s.start_m - 1e-6 <= begin and end <= s.end_m + 1e-6 for s in path.colliding)
    assert "keypoints 0 and 1" in str(path.colliding[0])


@pytest.mark.parametrize("kind", ["catmull_rom", "b_spline"])
def test_a_spline_passes_its_keypoints_in_order_and_tells_what_it_hits(rooms: Building, kind: str) -> None:
    keypoints = eyes((1, 1), (3, 3), (1.5, 2.5), (7, 3), (6, 1))
    path = spline_path(rooms, keypoints, kind=kind)
    np.testing.assert_allclose(path.points[path.keypoint_index], keypoints, atol=1e-9)
    assert (np.diff(path.keypoint_index) > 0).all()
    assert bool(path.colliding) != swept_free(rooms, path.points)
    assert path.colliding, "the way from 1.5, 2.5 to 7, 3 leads through the wall beside the door"
    assert spline_path(rooms, keypoints[:3], kind=kind).colliding == ()


def test_bad_input_is_named(rooms: Building) -> None:
    good = eyes((1, 1), (3, 3))
    with pytest.raises(ParameterError, match="polyline"):
        optimise_path(rooms, good[:1], good)
    with pytest.raises(ParameterError, match="polyline"):
        optimise_path(rooms, np.repeat(good[:1], 3, axis=0), good)
    with pytest.raises(ParameterError, match="nan or inf"):
        optimise_path(rooms, good * np.nan, good)
    with pytest.raises(ParameterError, match="keypoints"):
        optimise_path(rooms, good, np.zeros((2, 2)))
    with pytest.raises(ParameterError, match="points"):
        optimise_path(rooms, eyes((1, 1), (2, 1), (3, 1)), eyes((1, 1), (2, 1), (3, 1)), TrajoptConfig(points=2))
    with pytest.raises(ParameterError, match="one of weight_"):
        TrajoptConfig(**{f"weight_{name}": 0.0 for name in OBJECTIVES})
    with pytest.raises(ParameterError, match="weight_length"):
        TrajoptConfig(weight_length=-1.0)
    with pytest.raises(ParameterError, match="weight_length"):
        TrajoptConfig(weight_length=float("nan"))
    with pytest.raises(ParameterError, match="kind"):
        spline_path(rooms, good, kind="bezier")
    with pytest.raises(ParameterError, match="keypoints"):
        spline_path(rooms, good[:1])


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.tuples(st.floats(0.3, 11.7), st.floats(0.3, 7.7)), min_size=2, max_size=8))
def test_any_walk_in_an_empty_room_is_free_and_finite(hall: Building, xy: list[tuple[float, float]]) -> None:
    tour = eyes(*xy)
    if np.linalg.norm(np.diff(tour, axis=0), axis=1).sum() < 0.05:
        return
    path = optimise_path(hall, tour, tour, TrajoptConfig(points=60))
    assert np.isfinite(path.points).all()
    assert path.colliding == () and swept_free(hall, path.points)
    np.testing.assert_allclose(path.points[[0, -1]], tour[[0, -1]], atol=1e-9)


def half_level() -> Building:
    """A room with a podium of half a metre and a ramp up to it, open at its side."""
    low, high = [(0.1, 2.0, 0.0), (1.4, 2.0, 0.0)], [(0.1, 3.5, 0.5), (1.4, 3.5, 0.5)]
    feet = [(0.1, 3.5, 0.0), (1.4, 3.5, 0.0)]
    ramp = trimesh.convex.convex_hull(np.array(low + high + feet))
    return building_of([*shell(4.8, 6.0), box((0.0, 3.5, 0.0), (4.8, 6.0, 0.5)), ramp])


def floor_below(building: Building, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """The height of the first triangle straight below, every 2 cm along a path, by trimesh."""
    arc = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    every = np.arange(0, arc[-1], 0.02)
    along = np.column_stack([np.interp(every, arc, points[:, axis]) for axis in range(3)])
    mesh = trimesh.Trimesh(building.geometry.vertices, building.geometry.faces, process=False)
    found, ray, _ = mesh.ray.intersects_location(along, np.tile([0.0, 0.0, -1.0], (len(along), 1)))
    floor = np.full(len(along), -np.inf)
    np.maximum.at(floor, ray, found[:, 2])
    return floor


def test_nobody_steps_off_the_side_of_a_ramp() -> None:
    # The body meets nothing there: it hangs from an eye that goes on smoothly from the one height to the other.
    building = half_level()
    tour = np.array([(0.75, 5, 2.1), (0.75, 3.5, 2.1), (0.75, 1.9, 1.6), (1.9, 1.9, 1.6), (2.1, 3.0, 1.6)])
    for config in (
        TrajoptConfig(),
        TrajoptConfig(weight_length=1.0),
        TrajoptConfig(weight_deviation=0, weight_length=3),
    ):
        path = optimise_path(building, tour, tour[[0, -1]], config)
        assert swept_free(building, path.points)
        # Places stand for a tenth of a metre of the ramp, over which it rises by 3 cm.
        assert np.abs(np.diff(floor_below(building, path.points))).max() <= building.walker.step_m + 0.05
    assert path.repaired, "the scene does not tempt"
    line = np.array([(0.75, 3.3, 2.03), (1.3, 3.2, 2.0), (2.2, 3.1, 1.6)])
    assert PathCheck(building.geometry, building.walker).segments_free(line).all()
    found = PathCheck(building.geometry, building.walker, building.surface).segments_free(line)
    assert found.tolist() == [True, False]
