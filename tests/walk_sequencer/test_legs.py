# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import numpy as np
import pytest
import scenes
from numpy.typing import NDArray
from scipy.sparse.csgraph import dijkstra

from walk_building import BodySweep, Building
from walk_building.floor_grid import lay_floor, walk_between
from walk_sequencer.config import SequencerConfig
from walk_sequencer.pipeline import plan_tour
from walk_sequencer.roadmap import build_roadmap
from walk_sequencer.tour import Tour

EYE = 1.6
SHORTEST = SequencerConfig(comfort_weight=0.0)


def corridor() -> Building:
    """An L of two halls, 2 m wide: x 0..10, y 0..2 and x 8..10, y 0..10; the rest is a closed room."""
    return scenes.building_of([*scenes.shell(10, 10), scenes.box((0, 2, 0), (8, 10, 3))])


def scattered(building: Building, count: int, seed: int = 0) -> NDArray[np.float64]:
    places = np.flatnonzero(building.reachable)
    return building.eyes(np.random.default_rng(seed).choice(places, count, replace=False))


def leg_length(building: Building, a: tuple[float, ...], b: tuple[float, ...], config: SequencerConfig) -> float:
    return float(plan_tour(building, [a, b], config).lengths_m[0, 1])


def grid_lengths(building: Building, tour: Tour) -> NDArray[np.float64]:
    """Lengths over the grid's eight directions: never shorter than the true way, at most 8.3 % longer on the flat."""
    places = building.surface.nearest(tour.stands - [0, 0, EYE], building.reachable)
    return dijkstra(building.surface.graph, indices=places)[:, places]


def test_leg_in_an_empty_room_is_straight() -> None:
    building = scenes.building_of(scenes.shell(8, 6))
    tour = plan_tour(building, [(1.03, 1.04, EYE), (7.02, 5.01, EYE)])
    assert tour.length_m == pytest.approx(np.hypot(5.99, 3.97), abs=1e-6)
    assert len(tour.polyline) == 2


def test_leg_around_a_corner_bends_at_the_corner() -> None:
    # The body's axis keeps its radius from the inner corner (8, 2).
    r, corner = 0.25, np.array([8.0, 2.0])
    a, b = np.array([1.0, 1.0]), np.array([9.0, 9.0])
    arc = []
    for p in (a, b):
        d = np.linalg.norm(p - corner)
        arc.append((np.sqrt(d * d - r * r), np.arccos(r / d)))
    between = np.arccos(np.dot(a - corner, b - corner) / np.linalg.norm(a - corner) / np.linalg.norm(b - corner))
    taut = arc[0][0] + arc[1][0] + r * (2 * np.pi - between - arc[0][1] - arc[1][1])
    length = leg_length(corridor(), (1, 1, EYE), (9, 9, EYE), SequencerConfig(comfort_weight=0.0, start=0))
    assert taut <= length <= 1.03 * taut


def test_leg_goes_through_the_door() -> None:
    tour = plan_tour(scenes.building_of(scenes.two_rooms()), [(0.5, 0.5, EYE), (7.7, 0.5, EYE)], SHORTEST)
    # Taut over the two ends of the door's free strip, which begins at y 1.55 + 0.25.
    taut = 2 * np.hypot(3.5, 1.3) + 0.2
    assert taut - 0.02 <= tour.length_m <= 1.03 * taut


def test_closed_door_makes_the_other_room_unreachable_with_the_reason() -> None:
    building = scenes.building_of(scenes.two_rooms(door_m=0.0))
    tour = plan_tour(building, [(1, 1, EYE), (7, 1, EYE), (2, 2, EYE), (6, 2, EYE)], SequencerConfig(start=0))
    assert sorted(tour.order.tolist()) == [0, 2]
    assert [u.index for u in tour.unreachable] == [1, 3]
    assert "not connected on foot to the start" in tour.unreachable[0].reason
    assert np.isinf(tour.lengths_m[0, 1])
    assert np.isnan(tour.stands[1]).all()


def test_leg_up_a_ramp_has_the_length_of_the_slope() -> None:
    building = scenes.building_of(scenes.ramp(slope=0.125, length=8.0))
    length = leg_length(building, (1, 1, EYE), (11, 1, EYE + 1.0), SequencerConfig())
    assert length == pytest.approx(2 + np.hypot(8, 1), rel=0.005)


def test_leg_up_a_stair_follows_the_stair_smoothly() -> None:
    building = scenes.building_of(scenes.stair(steps=10, rise=0.17, tread=0.28))
    tour = plan_tour(building, [(1, 0.7, EYE), (7.5, 0.7, EYE + 1.7)], SequencerConfig(start=0))
    assert tour.length_m == pytest.approx(6.5 - 2.8 + np.hypot(2.8, 1.7), rel=0.02)
    rise = np.diff(tour.polyline[:, 2])
    assert rise.min() > -0.02
    along = np.concatenate([a + np.linspace(0, 1, 30)[:, None] * (b - a) for a, b in zip(*_ends(tour), strict=True)])
    floor = building.surface.floor_z(along, EYE)
    assert np.abs(along[:, 2] - EYE - floor).max() < 0.06


def _ends(tour: Tour) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    return tour.polyline[:-1], tour.polyline[1:]


@pytest.mark.parametrize("scene", [scenes.two_rooms, scenes.stair, scenes.ramp], ids=lambda scene: scene.__name__)
def test_body_is_free_along_every_leg(scene) -> None:
    building = scenes.building_of(scene())
    tour = plan_tour(building, scattered(building, 9))
    sweep = BodySweep(building.geometry, building.walker)
    assert len(tour.pairs) == 36
    for leg in tour.pairs:
        assert sweep.segments_free(leg.points).all()


@pytest.mark.parametrize("scene", [scenes.two_rooms, scenes.stair], ids=lambda scene: scene.__name__)
def test_legs_are_no_longer_than_the_ways_over_the_grid(scene) -> None:
    building = scenes.building_of(scene())
    tour = plan_tour(building, scattered(building, 10, seed=3), SHORTEST)
    grid = grid_lengths(building, tour)
    # Half a cell at either end, where a keypoint stands beside its place; steps of a stair only lengthen the grid's.
    assert (tour.lengths_m <= 1.01 * grid + building.surface.cell_m).all()
    assert (tour.lengths_m >= grid / 1.35 - building.surface.cell_m).all()


def test_lengths_are_a_metric_and_belong_to_the_legs() -> None:
    building = scenes.building_of(scenes.two_rooms())
    tour = plan_tour(building, scattered(building, 8))
    d = tour.lengths_m
    np.testing.assert_array_equal(d, d.T)
    assert (np.diag(d) == 0).all()
    assert (d[:, None, :] <= (d[:, :, None] + d[None]) * 1.05).all()
    straight = np.linalg.norm(tour.stands[:, None] - tour.stands[None], axis=2)
    assert (d >= straight - 1e-9).all()
    for leg in tour.pairs:
        assert leg.length_m == pytest.approx(np.linalg.norm(np.diff(leg.points, axis=0), axis=1).sum())
        np.testing.assert_allclose(leg.points[[0, -1]], tour.stands[[leg.start, leg.goal]], atol=1e-9)


def test_comfort_keeps_legs_off_the_walls_for_a_little_more_length() -> None:
    building, ends = corridor(), [(1.0, 1.0, EYE), (9.0, 9.0, EYE)]
    near, far = (plan_tour(building, ends, SequencerConfig(comfort_weight=w, start=0)) for w in (0.0, 3.0))
    sweep = BodySweep(building.geometry, building.walker)
    clearance = [sweep.standing_clearance(t.polyline[1:-1]).min() for t in (near, far)]
    assert clearance[1] > clearance[0] + 0.05
    assert near.length_m < far.length_m < 1.1 * near.length_m


def test_few_milestones_miss_no_room() -> None:
    # Five milestones cannot see one another through the doors: the ways along the floor join them.
    building = scenes.building_of(scenes.two_rooms(door_m=0.7))
    tour = plan_tour(building, scattered(building, 8), SequencerConfig(milestones=5))
    assert len(tour.order) == 8
    assert np.isfinite(tour.lengths_m).all()
    assert (tour.lengths_m <= 1.15 * grid_lengths(building, tour) + 0.1).all()


def test_roadmap_is_connected_where_prm_left_parts_apart() -> None:
    building, joined = corridor(), 0
    surface = building.surface
    part = surface.component == surface.component[surface.nearest([(1, 1, 0)])[0]]
    for seed in range(6):
        config = SequencerConfig(milestones=4, seed=seed)
        roadmap = build_roadmap(surface, building.walker, part, config)
        joined += roadmap.joined
        assert np.isfinite(dijkstra(roadmap.graph)).all()
    assert joined > 0


def test_straight_walks_agree_with_the_surface() -> None:
    building = scenes.building_of(scenes.two_rooms())
    ground, kept = lay_floor(building.surface, building.reachable, EYE, 0.3, 0.5)
    random = np.random.default_rng(2)
    pairs = random.integers(0, len(kept), (400, 2))
    mine = [walk_between(ground, a, b) < np.inf for a, b in pairs]
    theirs = [building.surface.segment_walkable(int(kept[a]), int(kept[b]), building.reachable) for a, b in pairs]
    assert 50 < sum(mine) < 350
    assert np.mean(np.array(mine) == np.array(theirs)) > 0.97
