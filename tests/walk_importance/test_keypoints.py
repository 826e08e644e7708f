# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import dataclasses
import time
from pathlib import Path

import numpy as np
import pytest
from scenes import box, building_of, shell, stair, two_rooms

from walk_building.building import Building
from walk_building.errors import ParameterError
from walk_building.pipeline import load_building
from walk_importance.candidates import find_candidates, lower_by_cone
from walk_importance.config import ImportanceConfig, KeypointConfig
from walk_importance.errors import NoPlaceError, NoPlaceNearError, TooManyKeypointsError
from walk_importance.importance_map import ImportanceMap
from walk_importance.keypoints import Suggestion, snap_keypoint, suggest_keypoints
from walk_importance.pipeline import compute_importance
from walk_importance.view import sees, view_yaws


@pytest.fixture(scope="module")
def rooms() -> Building:
    return building_of(two_rooms())


@pytest.fixture(scope="module")
def rooms_map(rooms: Building) -> ImportanceMap:
    return compute_importance(rooms)


def assert_standable(building: Building, found: Suggestion) -> None:
    assert building.reachable[found.place].all()
    np.testing.assert_allclose(found.positions, building.eyes(found.place))
    np.testing.assert_allclose(np.linalg.norm(found.quat_xyzw, axis=1), 1.0)
    np.testing.assert_array_equal(found.quat_xyzw[:, :2], 0.0)


def test_the_cone_lowers_by_hand_computed_amounts_and_only_on_its_storey() -> None:
    eyes = np.array([[0.0, 0, 0], [1.0, 0, 0], [0, 3.0, 0], [4.0, 0, 0], [9.0, 0, 0], [0, 0, 3.0]])
    score = np.full(6, 5.0)
    lower_by_cone(eyes, score, np.zeros(3), 4.0, 2.0, 1.5)
    np.testing.assert_allclose(score, [3.0, 3.5, 4.5, 5.0, 5.0, 5.0])


def test_every_reachable_room_gets_a_keypoint_where_a_walker_can_stand(
    rooms: Building, rooms_map: ImportanceMap
) -> None:
    found = suggest_keypoints(rooms, rooms_map)
    assert len(rooms.rooms) == 2
    assert set(found.room) == {0, 1}
    assert found.skipped == ()
    assert_standable(rooms, found)


def test_without_a_door_the_other_room_is_listed_with_its_reason() -> None:
    building = building_of(two_rooms(door_m=0.0))
    found = suggest_keypoints(building, compute_importance(building))
    assert len(found.skipped) == 1
    skipped = found.skipped[0]
    assert not building.rooms[skipped.room].reachable
    assert skipped.reason == building.rooms[skipped.room].reason
    assert set(found.room) == {i for i, room in enumerate(building.rooms) if room.reachable}


def test_with_a_count_rooms_come_first_and_those_left_out_are_counted(
    rooms: Building, rooms_map: ImportanceMap
) -> None:
    one = suggest_keypoints(rooms, rooms_map, KeypointConfig(count=1))
    assert len(one.positions) == 1
    assert [s.reason for s in one.skipped] == ["1 keypoints asked for, 2 rooms"]
    assert one.skipped[0].room != one.room[0]
    six = suggest_keypoints(rooms, rooms_map, KeypointConfig(count=6))
    assert len(six.positions) == 6
    assert set(six.room[:2]) == {0, 1}
    assert_standable(rooms, six)


def test_the_first_keypoint_is_the_most_important_candidate(rooms: Building, rooms_map: ImportanceMap) -> None:
    candidates = find_candidates(rooms, rooms_map)
    found = suggest_keypoints(rooms, rooms_map, KeypointConfig(count=1), candidates)
    assert found.score[0] == candidates.score.max()
    np.testing.assert_array_equal(found.score, rooms_map.at(found.positions))


def test_a_wider_cone_drives_keypoints_apart(rooms: Building, rooms_map: ImportanceMap) -> None:
    def nearest(radius: float) -> float:
        config = KeypointConfig(count=6, cone_radius_m=radius, cone_depth=5.0)
        p = suggest_keypoints(rooms, rooms_map, config).positions
        gaps = np.linalg.norm(p[:, None] - p[None], axis=2)
        return float(gaps[np.triu_indices(6, 1)].min())

    assert nearest(6.0) > nearest(0.2)
    assert nearest(0.2) >= 2 * rooms.walker.radius_m


def test_more_keypoints_than_fit_say_how_many_do(rooms: Building, rooms_map: ImportanceMap) -> None:
    with pytest.raises(TooManyKeypointsError) as error:
        suggest_keypoints(rooms, rooms_map, KeypointConfig(count=1000))
    assert 10 < error.value.fitting < 1000
    assert str(error.value.fitting) in str(error.value)


def test_a_long_hall_gets_more_keypoints_than_a_chamber_and_sees_its_floor() -> None:
    def found(length: float) -> tuple[Building, Suggestion]:
        building = building_of(shell(length, 5.0))
        return building, suggest_keypoints(building, compute_importance(building))

    _, chamber = found(4.0)
    hall, many = found(45.0)
    # One sees all of the chamber; a walk needs two.
    assert len(chamber.positions) == 2
    assert len(many.positions) > len(chamber.positions)
    knees = hall.surface.places[hall.reachable] + [0, 0, 0.5]
    seen = np.any([sees(hall.geometry, p, knees, 15.0) for p in many.positions], axis=0)
    assert seen.mean() >= 0.88


def test_both_ends_of_a_stair_are_candidates() -> None:
    building = building_of(stair())
    candidates = find_candidates(building, compute_importance(building))
    height = candidates.eyes[:, 2] - building.walker.eye_height_m
    assert height.min() < 0.1
    assert height.max() > 1.5


def test_the_view_goes_to_the_open_side() -> None:
    building = building_of(shell(12.0, 4.0))
    maps = compute_importance(building)
    yaw = view_yaws(building.geometry, maps, np.array([[1.0, 2.0, 1.6], [11.0, 2.0, 1.6]]))
    np.testing.assert_allclose(np.cos(yaw), [1.0, -1.0], atol=0.2)


def test_sees_stops_at_a_wall_and_at_the_distance() -> None:
    wall = building_of([*shell(10.0, 4.0), box((5, 0, 0), (5.1, 4, 3))])
    eye = np.array([2.0, 2.0, 1.6])
    targets = np.array([[4.0, 2.0, 1.0], [7.0, 2.0, 1.0], [0.5, 3.5, 0.5], [2.0, 2.0, 1.6]])
    assert sees(wall.geometry, eye, targets, 10.0).tolist() == [True, False, True, True]
    assert sees(wall.geometry, eye, targets, 1.0).tolist() == [False, False, False, True]


def test_snapping_stays_near_and_takes_a_better_place(rooms: Building, rooms_map: ImportanceMap) -> None:
    corner = np.array([0.35, 0.35, 1.6])
    found = snap_keypoint(rooms, rooms_map, corner)
    assert_standable(rooms, found)
    assert np.linalg.norm(found.positions[0] - corner) <= 1.5
    assert found.score[0] > rooms_map.at(corner[None])[0]


def test_snapping_where_nothing_is_near_says_how_far_the_next_place_is(
    rooms: Building, rooms_map: ImportanceMap
) -> None:
    candidates = find_candidates(rooms, rooms_map)
    far = np.array([-20.0, 2.0, 1.6])
    with pytest.raises(NoPlaceNearError) as error:
        snap_keypoint(rooms, rooms_map, far, candidates=candidates)
    assert error.value.nearest_m == pytest.approx(np.linalg.norm((candidates.eyes - far)[:, :2], axis=1).min())
    above = snap_keypoint(rooms, rooms_map, np.array([2.0, 2.0, 1.6 + 1.0]))
    assert_standable(rooms, above)
    with pytest.raises(NoPlaceNearError, match="no storey at its height"):
        snap_keypoint(rooms, rooms_map, np.array([2.0, 2.0, 1.6 + 3.0]))


def test_snapping_keeps_away_from_the_keypoints_there_are(rooms: Building, rooms_map: ImportanceMap) -> None:
    near = np.array([2.0, 2.0, 1.6])
    config = KeypointConfig(cone_depth=1e-6)
    taken = np.empty((0, 3))
    for _ in range(4):
        found = snap_keypoint(rooms, rooms_map, near, config, taken=taken)
        gaps = np.linalg.norm(taken - found.positions, axis=1)
        assert (gaps >= 2 * rooms.walker.radius_m).all()
        taken = np.concatenate([taken, found.positions])
    everywhere = find_candidates(rooms, rooms_map).eyes
    with pytest.raises(NoPlaceNearError, match="nor anywhere on that storey"):
        snap_keypoint(rooms, rooms_map, near, config, taken=everywhere)


def test_a_wider_snap_radius_finds_a_place_at_least_as_good(rooms: Building, rooms_map: ImportanceMap) -> None:
    corner = np.array([0.35, 0.35, 1.6])
    flat = KeypointConfig(cone_depth=0.0)
    scores = [
        snap_keypoint(rooms, rooms_map, corner, dataclasses.replace(flat, snap_radius_m=r)).score[0]
        for r in (0.8, 1.2, 2.0, 4.0)
    ]
    assert scores == sorted(scores)
    assert scores[-1] > scores[0]


def test_a_building_nobody_gets_into_says_so(rooms: Building, rooms_map: ImportanceMap) -> None:
    nobody = dataclasses.replace(rooms, reachable=np.zeros_like(rooms.reachable))
    with pytest.raises(NoPlaceError, match="no place in the building can be reached"):
        suggest_keypoints(nobody, rooms_map)


@pytest.mark.parametrize(("field", "value"), [("cone_radius_m", 0.0), ("count", -1), ("cone_depth", float("nan"))])
def test_a_bad_parameter_is_named(field: str, value: object) -> None:
    with pytest.raises(ParameterError, match=field):
        KeypointConfig(**{field: value})


def test_another_cone_answers_within_a_tenth_of_a_second(rooms: Building, rooms_map: ImportanceMap) -> None:
    candidates = find_candidates(rooms, rooms_map)
    suggest_keypoints(rooms, rooms_map, candidates=candidates)
    times = []
    for radius in (1.0, 2.0, 3.0):
        start = time.perf_counter()
        suggest_keypoints(rooms, rooms_map, KeypointConfig(cone_radius_m=radius), candidates)
        times.append(time.perf_counter() - start)
    assert min(times) < 0.1


def test_in_the_duplex_every_room_of_the_dwelling_gets_one(buildings_dir: Path) -> None:
    building = load_building(buildings_dir / "duplex.ifc")
    found = suggest_keypoints(building, compute_importance(building, ImportanceConfig()))
    reachable = {i for i, room in enumerate(building.rooms) if room.reachable}
    assert len(reachable) == 10
    assert set(found.room) >= reachable
    assert {s.room for s in found.skipped} == set(range(len(building.rooms))) - reachable
    assert all(s.reason for s in found.skipped)
    assert_standable(building, found)


def test_a_single_room_gets_two_keypoints_since_a_walk_leads_from_one_to_another() -> None:
    chamber = building_of(shell(5.0, 4.0))
    found = suggest_keypoints(chamber, compute_importance(chamber))
    assert len(found.positions) == 2
    assert np.linalg.norm(found.positions[0] - found.positions[1]) > KeypointConfig().cone_radius_m / 2
    closet = building_of(shell(1.6, 1.6))
    assert len(suggest_keypoints(closet, compute_importance(closet)).positions) == 1, "there is no room for two"
    assert len(suggest_keypoints(chamber, compute_importance(chamber), KeypointConfig(count=1)).positions) == 1
