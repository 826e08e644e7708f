# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The figures of walks whose answers are known in closed form."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from numpy.typing import NDArray
from scenes import box, building_of, shell, stair, two_rooms

from walk_building import Building
from walk_building.sweep import BodySweep
from walk_plan.clearance import LIMIT_M, SideClearance
from walk_plan.quality import PathQuality, flat_floor, height_errors, measure, rms_jerk, turn_rates
from walk_plan.rooms import rooms_entered
from walk_plan.seen import seen_share
from walk_plan.wording import setting
from walk_trajopt.trajectory import Trajectory


def straight(start: list[float], end: list[float], speed: float = 1.0, count: int = 50) -> Trajectory:
    """A walk along a line at constant speed that looks ahead."""
    a, b = np.array(start), np.array(end)
    length = float(np.linalg.norm(b - a))
    t = np.linspace(0.0, length / speed, count)
    ahead = (b - a) / length
    yaw = np.arctan2(ahead[1], ahead[0])
    return Trajectory(
        t_s=t,
        positions=a + np.outer(t * speed, ahead),
        velocities=np.tile(speed * ahead, (count, 1)),
        accelerations=np.zeros((count, 3)),
        quat_xyzw=np.tile([0.0, 0.0, np.sin(yaw / 2), np.cos(yaw / 2)], (count, 1)),
        stop=np.zeros(count, bool),
    )


def measured(building: Building, trajectory: Trajectory) -> PathQuality:
    sweep = BodySweep(building.geometry, building.walker)
    path = trajectory.positions
    return measure("test", building, sweep, SideClearance(building), path, trajectory, np.zeros((0, 3)))


@pytest.fixture(scope="module")
def rooms() -> Building:
    return building_of(two_rooms())


@pytest.fixture(scope="module")
def hall() -> Building:
    return building_of(shell(6, 4))


def test_a_straight_walk_has_the_length_time_and_speed_it_was_given(rooms: Building) -> None:
    quality = measured(rooms, straight([1, 2, 1.6], [7, 2, 1.6], speed=1.5))
    assert quality.length_m == pytest.approx(6.0)
    assert quality.duration_s == pytest.approx(4.0)
    assert quality.median_speed_mps == quality.peak_speed_mps == pytest.approx(1.5)
    assert quality.rms_jerk_mps3 == pytest.approx(0.0, abs=1e-9)
    assert quality.peak_turn_rate_radps == pytest.approx(0.0, abs=1e-6)


def test_clearance_is_the_free_width_of_the_door(rooms: Building) -> None:
    quality = measured(rooms, straight([1, 2, 1.6], [7, 2, 1.6], count=301))
    # A door of 0.9 m leaves 0.2 m on each side of a body of 0.5 m.
    assert quality.min_clearance_m == pytest.approx(0.2, abs=1e-3)
    assert quality.colliding_segments == 0


def test_a_walk_through_a_wall_collides_where_the_wall_is_and_nowhere_else(rooms: Building) -> None:
    quality = measured(rooms, straight([1, 1, 1.6], [7, 1, 1.6], count=61))
    # The wall is 0.2 m thick, the body 0.5 m wide, a segment 0.1 m long.
    assert 7 <= quality.colliding_segments <= 9
    assert quality.segments == 60
    assert quality.min_clearance_m == 0.0


def test_side_clearance_knows_walls_but_neither_floor_nor_lintel(hall: Building) -> None:
    lintel = building_of([*shell(6, 4), box((0, 0, 2.0), (6, 4, 2.5))])
    eyes = np.array([[3.0, 2.0, 1.6], [1.0, 2.0, 1.6], [0.25, 2.0, 1.6]])
    for building in (hall, lintel):
        assert SideClearance(building).at(eyes) == pytest.approx([1.75, 0.75, 0.0], abs=1e-6)


def test_side_clearance_knows_a_table_and_stops_at_its_limit() -> None:
    empty = building_of(shell(12, 12))
    table = building_of([*shell(12, 12), box((7, 5, 0.7), (8, 7, 0.75))])
    eye = np.array([[6.0, 6.0, 1.6]])
    assert SideClearance(empty).at(eye) == pytest.approx([LIMIT_M])
    assert SideClearance(table).at(eye) == pytest.approx([0.75])


def test_jerk_of_a_speed_that_swings_is_its_closed_form() -> None:
    t = np.linspace(0.0, 40.0, 4001)
    walk = straight([0, 0, 1.6], [10, 0, 1.6], count=len(t))
    speed = 1.0 + 0.5 * np.sin(t)
    swinging = dataclasses.replace(walk, t_s=t, velocities=np.outer(speed, [1.0, 0.0, 0.0]))
    assert rms_jerk(swinging) == pytest.approx(0.5 / np.sqrt(2), rel=0.02)
    half = {name: getattr(swinging, name)[::2] for name in ("t_s", "velocities")}
    assert rms_jerk(dataclasses.replace(swinging, **half)) == pytest.approx(rms_jerk(swinging), rel=1e-3)


def test_turn_rate_is_that_of_a_steady_turn() -> None:
    t = np.linspace(0.0, 2.0, 21)
    half = 0.7 * t / 2
    quat = np.column_stack([np.zeros((21, 2)), np.sin(half), np.cos(half)])
    walk = dataclasses.replace(straight([0, 0, 1.6], [1, 0, 1.6], count=21), t_s=t, quat_xyzw=quat)
    assert turn_rates(walk) == pytest.approx(np.full(20, 0.7))


def test_height_figures_tell_an_eye_that_bobs(hall: Building) -> None:
    walk = straight([1, 2, 1.6], [5, 2, 1.6], count=401)
    steady = measured(hall, walk)
    assert steady.flat_height_std_m == pytest.approx(0.0, abs=1e-6)
    assert steady.height_deviation_m == pytest.approx(0.0, abs=1e-6)
    bob = walk.positions + np.outer(0.1 * np.sin(np.linspace(0, 20 * np.pi, 401)), [0, 0, 1])
    moved = measured(hall, dataclasses.replace(walk, positions=bob))
    assert moved.flat_height_std_m == pytest.approx(0.1 / np.sqrt(2), rel=0.1)
    assert moved.height_deviation_m == pytest.approx(0.1, rel=0.05)


def test_a_stair_is_not_flat_floor_and_its_ends_are() -> None:
    building = building_of(stair())
    x = np.arange(0.5, 8.0, 0.1)
    floor = np.clip((x - 3.0) / 0.28, 0, 10) * 0.17
    eyes = np.column_stack([x, np.full_like(x, 0.7), floor + 1.6])
    flat = flat_floor(building, eyes)
    assert flat[x < 2.0].all() and flat[x > 6.8].all()
    assert not flat[(x > 3.3) & (x < 5.5)].any()
    assert np.nanmax(np.abs(height_errors(building, eyes))) < 0.12


def test_all_of_an_empty_room_is_seen_and_a_wall_hides_what_is_behind() -> None:
    generator = np.random.default_rng(0)
    near = generator.uniform([0.1, 0.1, 0.1], [3.9, 3.9, 2.9], (200, 3))
    far = near + [4.2, 0.0, 0.0]
    closed = building_of(two_rooms(door_m=0.0)).geometry
    path = np.array([[1.0, 1.0, 1.6], [3.0, 3.0, 1.6]])
    assert seen_share(closed, path, near) == 1.0
    assert seen_share(closed, path, far) == 0.0
    assert seen_share(closed, path, np.vstack([near, far])) == 0.5
    assert np.isnan(seen_share(closed, path, np.zeros((0, 3))))


def test_share_seen_equals_one_ray_for_each_pair(rooms: Building) -> None:
    generator = np.random.default_rng(1)
    targets = generator.uniform([0.1, 0.1, 0.1], [8.1, 3.9, 2.9], (150, 3))
    path = np.array([[1.0, 3.0, 1.6], [2.0, 3.0, 1.6]])
    # The path is a metre long, so it is looked from at its two ends.
    seen = np.zeros(150, bool)
    for eye in path:
        rays = targets - eye
        hits = rooms.geometry.raycast(np.tile(eye, (150, 1)), rays).distance_m
        seen |= hits >= np.linalg.norm(rays, axis=1)
    assert 0.2 < seen.mean() < 1.0
    assert seen_share(rooms.geometry, path, targets) == pytest.approx(seen.mean())


def test_rooms_are_entered_in_the_order_of_the_walk(rooms: Building) -> None:
    def eyes(xs: list[float]) -> NDArray[np.float64]:
        return np.array([[x, 2.0, 1.6] for x in xs])

    forth = rooms_entered(rooms, eyes([1.0, 2.0, 6.0]))
    assert len(forth) == 2
    assert rooms_entered(rooms, eyes([6.0, 2.0, 1.0, 6.0])) == forth[::-1]
    assert rooms_entered(rooms, eyes([1.0, 2.0])) == forth[:1]


@pytest.mark.parametrize(
    ("value", "default", "shown"),
    [
        (True, False, "yes"), (0.25, 1.0, "0.25"), (3, 1, "3"), ("", "x", "–"), ("auto", "", "auto"),
        ("a" * 60, "a" * 60, "usual names"), ("b" * 60, "a" * 60, "names of one's own"),
    ],
)  # fmt: skip
def test_a_setting_is_shown_as_a_client_reads_it(value: object, default: object, shown: str) -> None:
    assert setting(value, default) == shown  # type: ignore[arg-type]
