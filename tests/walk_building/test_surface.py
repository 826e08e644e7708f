# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The walkable surface of scenes with known answers."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from scenes import box, building_of, model_of, ramp, shell, stair, two_rooms
from scipy.sparse.csgraph import dijkstra

from walk_building import BodySweep, BuildingError, LoadOptions, Walker, prepare_building

EYE = Walker().eye_height_m


def test_a_room_is_walkable_up_to_a_body_from_its_walls() -> None:
    building = building_of(shell(6, 4))
    inside = building.surface.places[building.reachable]
    assert inside[:, 2] == pytest.approx(0.0)
    assert building.reachable.sum() * building.surface.place_area_m2 == pytest.approx(5.5 * 3.5, rel=0.05)
    assert inside[:, 0].min() >= 0.25 and inside[:, 0].max() <= 5.75


def test_the_roof_is_not_indoors_unless_asked_for() -> None:
    meshes = shell(6, 4)
    assert not building_of(meshes).surface.indoor[building_of(meshes).surface.places[:, 2] > 1].any()
    outside = building_of(meshes, outdoors=True)
    assert outside.reachable.sum() > 0


def test_a_door_joins_two_rooms_and_a_wall_parts_them() -> None:
    for door_m, joined in ((0.9, True), (0.0, False), (0.45, False)):
        building = building_of(two_rooms(door_m))
        a, b = building.surface.nearest([(1, 2, 0), (7, 2, 0)])
        assert (building.surface.component[a] == building.surface.component[b]) == joined


@pytest.mark.parametrize(("rise", "joined"), [(0.17, True), (0.24, True), (0.35, False)])
def test_a_stair_is_climbed_as_far_as_its_steps_allow(rise: float, joined: bool) -> None:
    building = building_of(stair(steps=8, rise=rise))
    low, high = building.surface.nearest([(1, 0.7, 0), (3 + 8 * 0.28 + 2, 0.7, 8 * rise)])
    assert (building.surface.component[low] == building.surface.component[high]) == joined


@pytest.mark.parametrize(("slope", "joined"), [(0.125, True), (0.7, True), (1.0, False)])
def test_a_ramp_is_climbed_up_to_the_steepest_slope(slope: float, joined: bool) -> None:
    building = building_of(ramp(slope=slope, length=4.0))
    low, high = building.surface.nearest([(1, 1, 0), (7, 1, 4 * slope)])
    assert (building.surface.component[low] == building.surface.component[high]) == joined


def test_floor_height_is_exact_on_a_ramp_and_smooth_on_a_stair() -> None:
    building = building_of(ramp(slope=0.125))
    x = np.linspace(2.5, 9.5, 40)
    eyes = np.column_stack([x, np.full(40, 0.4), EYE + 0.125 * (x - 2)])
    plane = building.surface.floor_plane(eyes, EYE)
    np.testing.assert_allclose(plane[:, 0], 0.125 * (x - 2), atol=2e-3)
    np.testing.assert_allclose(plane[:, 1], 0.125, atol=5e-3)

    steps = building_of(stair())
    x = np.linspace(3.3, 5.5, 300)
    eyes = np.column_stack([x, np.full(300, 0.7), EYE + 0.17 / 0.28 * (x - 3)])
    z = steps.surface.floor_z(eyes, EYE)
    assert np.abs(np.diff(z)).max() < 0.05, "the floor jumps as the treads do"
    assert np.abs(z - 0.17 / 0.28 * (x - 3)).max() < 0.2


def test_there_is_no_floor_where_there_is_no_building() -> None:
    surface = building_of(shell(6, 4)).surface
    assert np.isnan(surface.floor_z([(50, 50, 1.6), (3, 2, 40)], EYE)).all()


def test_neighbours_are_mutual_and_a_step_apart() -> None:
    surface = building_of(stair()).surface
    source = np.repeat(np.arange(len(surface.places)), np.diff(surface.indptr))
    pairs = set(zip(source.tolist(), surface.neighbours.tolist(), strict=True))
    assert all((b, a) in pairs for a, b in pairs)
    assert np.abs(surface.places[source, 2] - surface.places[surface.neighbours, 2]).max() <= 0.25
    assert surface.edge_length_m.max() <= np.hypot(0.1 * np.sqrt(2), 0.25) + 1e-9


def test_the_body_passes_between_all_neighbours() -> None:
    building = building_of([*two_rooms(0.8), box((1.5, 1.5, 0), (2.1, 2.3, 0.75))])
    surface, sweep = building.surface, BodySweep(building.geometry, building.walker)
    rng = np.random.default_rng(0)
    for p in rng.choice(np.flatnonzero(building.reachable), 150):
        q = surface.neighbours[rng.integers(surface.indptr[p], surface.indptr[p + 1])]
        if building.reachable[q]:
            assert sweep.segments_free(building.eyes(np.array([p, q]))).all()


def test_a_straight_walk_is_free_for_the_body_wherever_the_surface_allows_it() -> None:
    building = building_of([*two_rooms(0.8), box((1.5, 1.5, 0), (2.1, 2.3, 0.75))])
    surface, sweep = building.surface, BodySweep(building.geometry, building.walker)
    rng = np.random.default_rng(1)
    pairs = rng.choice(np.flatnonzero(building.reachable), (300, 2))
    walkable = [surface.segment_walkable(a, b, building.reachable) for a, b in pairs]
    assert 20 < sum(walkable) < 280
    for (a, b), ok in zip(pairs, walkable, strict=True):
        if ok:
            assert sweep.segments_free(building.eyes(np.array([a, b]))).all()


def test_a_straight_walk_leads_through_no_wall() -> None:
    surface = building_of(two_rooms()).surface
    left, right, beyond = surface.nearest([(1, 0.5, 0), (7, 0.5, 0), (7, 2, 0)])
    everywhere = np.ones(len(surface.places), bool)
    assert not surface.segment_walkable(left, right, everywhere)
    middle = surface.nearest([(1, 2, 0)])[0]
    assert surface.segment_walkable(middle, beyond, everywhere)


def test_nearest_is_the_nearest_of_all_places() -> None:
    surface = building_of(two_rooms()).surface
    dice = np.random.default_rng(0)
    low, high = surface.places.min(axis=0), surface.places.max(axis=0)
    beside = surface.places[dice.integers(0, len(surface.places), 500)] + dice.normal(0.0, 0.2, (500, 3))
    points = np.concatenate([dice.uniform(low - 3.0, high + 3.0, (500, 3)), beside, [(1e19, 0.0, 0.0)]])
    gap = np.linalg.norm(surface.places[None] - points[:, None], axis=2)
    found = surface.nearest(points)
    assert np.array_equal(gap[np.arange(len(points)), found], gap.min(axis=1))
    assert surface.nearest([(1e300, 0.0, 0.0)]) == [-1]  # farther than a distance can tell


def test_clearance_is_the_distance_to_where_standing_ends() -> None:
    building = building_of(shell(6, 4))
    p = building.surface.nearest([(3, 2, 0)])[0]
    assert building.surface.clearance_m[p] == pytest.approx(1.75, abs=0.1)


def test_the_graph_measures_the_way_around_a_wall() -> None:
    building = building_of(two_rooms())
    surface = building.surface
    a, b = surface.nearest([(3.5, 0.5, 0), (4.7, 0.5, 0)])
    length = dijkstra(surface.graph, indices=a)[b]
    around = 2 * np.hypot(0.25, 1.3) + 0.7
    assert around * 0.9 < length < around * 1.2


def test_rooms_are_parted_at_the_door_and_named() -> None:
    rooms = building_of(two_rooms()).rooms
    assert [round(r.area_m2) for r in rooms] == pytest.approx([12, 12], abs=1)
    assert len({r.name for r in rooms}) == 2
    assert all(r.reachable for r in rooms)


def test_a_room_without_a_way_into_it_is_reported_with_the_reason() -> None:
    building = building_of([*two_rooms(0.0)])
    closed = [r for r in building.rooms if not r.reachable]
    assert len(closed) == 1 and "no way on foot" in closed[0].reason


def test_two_storeys_are_found_and_the_stairless_one_reported() -> None:
    building = building_of(shell(6, 4) + shell(6, 4, z=3.2))
    assert [round(s.elevation_m, 1) for s in building.storeys] == [0.0, 3.2]
    assert sorted(r.storey for r in building.rooms if not r.reachable) in ([0], [1])


def test_without_ceilings_the_walls_tell_in_from_out() -> None:
    ground = box((-10, -10, -0.2), (16, 14, 0))
    west, east, _, north = shell(6, 4)[2:]
    south_with_door = [box((0, -0.2, 0), (2.5, 0, 3)), box((3.5, -0.2, 0), (6, 0, 3))]
    building = building_of([ground, west, east, north, *south_with_door])
    inside = building.surface.places[building.reachable]
    assert inside[:, :2].min(axis=0) == pytest.approx([0.3, 0.3], abs=0.6)
    assert inside[:, :2].max(axis=0) == pytest.approx([5.7, 3.7], abs=0.1)


def test_a_model_nobody_can_stand_on_is_refused_with_the_next_step() -> None:
    with pytest.raises(BuildingError, match=r"no floor.*--units"):
        building_of([trimesh.creation.cone(radius=0.5, height=3.0)])


def test_a_tall_walker_fits_under_less() -> None:
    low_beam = box((2.9, 0, 1.7), (3.1, 4, 3))
    meshes = [*shell(6, 4), low_beam]
    small = prepare_building(model_of(meshes), LoadOptions(), Walker(height_m=1.5, eye_height_m=1.4))
    tall = prepare_building(model_of(meshes), LoadOptions(), Walker())
    assert small.reachable.sum() > 1.5 * tall.reachable.sum(), "the beam stops the tall one"
    assert small.hash != tall.hash


def test_the_inside_of_a_block_is_no_room_but_that_of_a_single_sheet_is() -> None:
    platform = box((-0.2, 4.2, 0), (6.2, 10, 2.5))
    building = building_of([*shell(6, 4), platform])
    assert building.surface.places[building.reachable, 1].max() < 4
    sheet = building_of([trimesh.creation.box(bounds=[(0, 0, 0), (6, 4, 3)])])
    assert len(sheet.rooms) == 1 and sheet.rooms[0].reachable


def test_a_house_read_in_the_wrong_unit_is_refused_before_it_takes_all_memory() -> None:
    house = [part.apply_scale(100.0) for part in two_rooms()]
    with pytest.raises(BuildingError, match=r"too large to plan in at once: 860 x 440 x 340 m.*--units"):
        building_of(house)


def test_a_room_that_a_step_parts_is_listed_with_what_is_not_reached() -> None:
    # Two thirds of the hall's floor are 0.6 m higher: no walker gets up there, and no wall parts them.
    building = building_of([*shell(12, 4, height=3.4), box((4, 0, 0), (12, 4, 0.6))])
    heights = sorted((round(float(room.centre[2]), 1), room.reachable) for room in building.rooms)
    assert heights == [(0.0, False), (0.6, True)]
    assert sum(room.area_m2 for room in building.rooms) > 36
