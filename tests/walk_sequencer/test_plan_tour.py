# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import scenes

from walk_building import Building, load_building
from walk_building.errors import ParameterError
from walk_sequencer.bench import bench
from walk_sequencer.config import SequencerConfig
from walk_sequencer.order import order_cost
from walk_sequencer.pipeline import plan_tour
from walk_sequencer.tour import Tour

EYE = 1.6
POINTS = [(1.0, 1.0, EYE), (7.0, 1.0, EYE), (3.0, 3.0, EYE), (7.0, 3.0, EYE), (1.0, 3.5, EYE)]


@pytest.fixture(scope="module")
def rooms() -> Building:
    return scenes.building_of(scenes.two_rooms())


def digest(tour: Tour) -> str:
    parts = [tour.order, tour.lengths_m, tour.polyline, *(leg.points for leg in tour.pairs)]
    return hashlib.sha256(b"".join(np.ascontiguousarray(p).tobytes() for p in parts)).hexdigest()


def test_tour_visits_every_keypoint_once(rooms: Building) -> None:
    tour = plan_tour(rooms, POINTS)
    assert sorted(tour.order.tolist()) == list(range(5))
    assert [(leg.start, leg.goal) for leg in tour.legs] == list(zip(tour.order, tour.order[1:], strict=False))
    assert tour.length_m == pytest.approx(order_cost(tour.lengths_m, tour.order))
    for index in tour.order:
        assert np.linalg.norm(tour.polyline - tour.stands[index], axis=1).min() < 1e-9
    assert tour.method == "exact"
    assert not tour.polyline.flags.writeable


@pytest.mark.parametrize("method", ["auto", "exact", "local_search", "mst_dfs", "given"])
def test_start_and_end_are_kept(rooms: Building, method: str) -> None:
    tour = plan_tour(rooms, POINTS, SequencerConfig(method=method, start=3, end=2))
    assert (tour.order[0], tour.order[-1]) == (3, 2)


def test_given_order_is_kept(rooms: Building) -> None:
    assert plan_tour(rooms, POINTS, SequencerConfig(method="given")).order.tolist() == [0, 1, 2, 3, 4]


def test_no_keypoints_make_an_empty_tour(rooms: Building) -> None:
    tour = plan_tour(rooms, np.zeros((0, 3)))
    assert (len(tour.order), len(tour.legs), tour.length_m, tour.polyline.shape) == (0, 0, 0.0, (0, 3))


def test_one_keypoint_is_a_tour_without_legs(rooms: Building) -> None:
    tour = plan_tour(rooms, POINTS[:1])
    assert (tour.order.tolist(), len(tour.legs), tour.length_m) == ([0], 0, 0.0)
    np.testing.assert_allclose(tour.polyline, [POINTS[0]], atol=1e-9)


def test_keypoints_at_one_spot_are_all_visited(rooms: Building) -> None:
    tour = plan_tour(rooms, [POINTS[0]] * 3 + [POINTS[1]])
    assert sorted(tour.order.tolist()) == [0, 1, 2, 3]
    assert tour.lengths_m[0, 1] == 0.0
    assert tour.length_m == pytest.approx(tour.lengths_m[0, 3])


def test_keypoint_without_floor_is_reported_with_the_distance(rooms: Building) -> None:
    tour = plan_tour(rooms, [*POINTS, (30.0, 0.0, EYE), (1.0, 1.0, 9.0)])
    assert [u.index for u in tour.unreachable] == [5, 6]
    reason = "no floor to stand on within 0.5 m of the point 1.6 m below it; the nearest is 21.88 m away"
    assert tour.unreachable[0].reason == reason
    assert sorted(tour.order.tolist()) == [0, 1, 2, 3, 4]


def test_unreachable_start_leaves_the_start_free(rooms: Building) -> None:
    tour = plan_tour(rooms, [(30.0, 0.0, EYE), *POINTS], SequencerConfig(start=0))
    assert sorted(tour.order.tolist()) == [1, 2, 3, 4, 5]


def test_keypoint_in_a_wall_is_moved_beside_it(rooms: Building) -> None:
    tour = plan_tour(rooms, [(4.05, 0.6, EYE), POINTS[0]])
    assert not tour.unreachable
    assert 0.2 < np.linalg.norm(tour.stands[0] - [4.05, 0.6, EYE]) < 0.5


def test_start_decides_which_part_the_tour_is_in() -> None:
    apart = scenes.building_of(scenes.two_rooms(door_m=0.0))
    for start, visited in ((0, [0, 2, 4]), (1, [1, 3])):
        assert sorted(plan_tour(apart, POINTS, SequencerConfig(start=start)).order.tolist()) == visited


@pytest.mark.parametrize("bad", [[(1, 2)], [(1.0, np.nan, 1.6)], [(np.inf, 0, 0)], [1, 2, 3]])
def test_bad_keypoints_are_refused_with_a_sentence(rooms: Building, bad: list) -> None:
    with pytest.raises(ParameterError, match="keypoints is"):
        plan_tour(rooms, bad)


@pytest.mark.parametrize("config", [{"start": 5}, {"end": 9}, {"start": 1, "end": 1}])
def test_ends_that_are_no_two_keypoints_are_refused(rooms: Building, config: dict) -> None:
    with pytest.raises(ParameterError):
        plan_tour(rooms, POINTS, SequencerConfig(**config))


def test_planning_again_from_the_previous_tour_changes_nothing_but_time(rooms: Building) -> None:
    first = plan_tour(rooms, POINTS)
    edited = [*POINTS[:2], (2.5, 2.0, EYE), *POINTS[3:], (6.0, 2.0, EYE)]
    warm, cold = plan_tour(rooms, edited, previous=first), plan_tour(rooms, edited)
    assert digest(warm) == digest(cold)
    assert warm.roadmap is first.roadmap
    kept = {(leg.start, leg.goal): leg.points for leg in warm.pairs}
    assert kept[0, 1] is next(leg.points for leg in first.pairs if (leg.start, leg.goal) == (0, 1))


def test_a_changed_seed_builds_another_roadmap(rooms: Building) -> None:
    first = plan_tour(rooms, POINTS)
    assert plan_tour(rooms, POINTS, SequencerConfig(seed=2), previous=first).roadmap is not first.roadmap


PROGRAM = """
import sys, scenes
sys.path.insert(0, {folder!r})
from test_plan_tour import POINTS, digest
from walk_sequencer.pipeline import plan_tour
print(digest(plan_tour(scenes.building_of(scenes.two_rooms()), POINTS)))
"""


def test_two_processes_plan_the_same_tour_bit_for_bit(rooms: Building) -> None:
    here = Path(__file__).parent
    paths = [str(here.parent), *sys.path]
    out = subprocess.run(
        [sys.executable, "-c", PROGRAM.format(folder=str(here))],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(p for p in paths if p), "PYTHONHASHSEED": "77"},
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
    )
    assert out.stdout.split()[-1] == digest(plan_tour(rooms, POINTS))
    assert "leaked" not in out.stderr


def test_upper_floor_without_stairs_is_reported(buildings_dir: Path) -> None:
    building = load_building(buildings_dir / "large_building.ifc")
    surface = building.surface
    upper = np.flatnonzero(surface.indoor & (surface.places[:, 2] > 3.5) & (surface.places[:, 2] < 4.5))
    ground = np.flatnonzero(building.reachable)
    tour = plan_tour(building, building.eyes(np.array([ground[100], upper[len(upper) // 2], ground[-100]])))
    assert [u.index for u in tour.unreachable] == [1]
    assert "not connected on foot to the start" in tour.unreachable[0].reason


def test_duplex_is_walked_over_its_stairs(buildings_dir: Path) -> None:
    building = load_building(buildings_dir / "duplex.ifc")
    places = np.flatnonzero(building.reachable)
    tour = plan_tour(building, building.eyes(np.random.default_rng(1).choice(places, 20)))
    assert not tour.unreachable
    assert np.ptp(tour.polyline[:, 2]) > 3.0
    # Steps are never jumped: no piece of the way is steeper than a stair.
    pieces = np.diff(tour.polyline, axis=0)
    assert (np.abs(pieces[:, 2]) <= 1.0 * np.hypot(pieces[:, 0], pieces[:, 1]) + 0.02).all()


def test_bench_reports_times_and_the_gain_over_the_tree_order(rooms: Building) -> None:
    figures = bench(rooms, POINTS)
    assert figures["pairs"] == 10
    assert figures["roadmap_s"] + figures["legs_s"] + figures["order_s"] <= figures["plan_s"]
    assert figures["mst_dfs_ratio"] >= 1.0 - 1e-9
