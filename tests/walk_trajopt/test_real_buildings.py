# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Tours of real buildings end free of collisions, level and at the wished speed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from walk_building import BodySweep, Building, load_building
from walk_sequencer.config import SequencerConfig
from walk_sequencer.pipeline import plan_tour
from walk_trajopt import TimingConfig, TrajoptConfig, optimise_path, time_path
from walk_trajopt.bench import bench_trajectory

FILES = ["duplex.ifc", "large_building.ifc", "small_house.ply", "willowgarage.dae", "parking_garage.dae"]
_MOST = 20  # keypoints: all seventy rooms of the office would take the sequencer, not us, too long here


def keypoints_of(building: Building) -> np.ndarray:
    """The place farthest from the walls of each reachable room, and some more where there are few rooms."""
    surface, random = building.surface, np.random.default_rng(1)
    chosen = []
    for room in building.rooms:
        places = room.places[building.reachable[room.places]] if room.reachable else room.places[:0]
        if len(places):
            chosen.append(places[np.argmax(surface.clearance_m[places])])
    if len(chosen) < 6:
        open_floor = np.flatnonzero(building.reachable & (surface.clearance_m > 0.5))
        chosen.extend(random.choice(open_floor, 8 - len(chosen), replace=False))
    return building.eyes(np.array(chosen[:_MOST]))


@pytest.mark.slow
@pytest.mark.parametrize("file", FILES)
def test_the_walk_is_free_level_and_brisk(file: str, buildings_dir: Path) -> None:
    building = load_building(buildings_dir / file)
    keypoints = keypoints_of(building)
    tour = plan_tour(building, keypoints, SequencerConfig())
    visited = keypoints[tour.order]
    path = optimise_path(building, tour.polyline, visited)

    assert path.colliding == ()
    sweep = BodySweep(building.geometry, building.walker)
    assert sweep.segments_free(path.points).all()
    assert np.linalg.norm(path.points[path.keypoint_index] - visited, axis=1).max() < 1.0

    config = TimingConfig()
    trajectory = time_path(path, config)
    plane = building.surface.floor_plane(trajectory.positions, building.walker.eye_height_m)
    flat = np.hypot(plane[:, 1], plane[:, 2]) < 0.02
    height = trajectory.positions[flat, 2] - plane[flat, 0]
    assert height.std() <= 0.05 and height.mean() == pytest.approx(building.walker.eye_height_m, abs=0.02)

    speed = np.interp(np.arange(0, trajectory.duration_s, 0.05), trajectory.t_s, trajectory.speed_mps)
    assert np.median(speed) == pytest.approx(config.speed_mps, rel=0.1)
    steps = np.diff(trajectory.t_s)
    assert steps.min() > 0 and steps.max() <= 0.1
    flips = np.einsum("ij,ij->i", trajectory.quat_xyzw[1:], trajectory.quat_xyzw[:-1])
    assert flips.min() > 0.999, "a step in the look direction"


def test_the_bench_measures_every_solver(rooms: Building) -> None:
    tour = np.array([[1, 1, 1.6], [1, 2, 1.6], [7, 2, 1.6], [7, 3, 1.6]])
    found = bench_trajectory(rooms, tour, tour[[0, 1, 3]], TrajoptConfig(points=40, max_iterations=60), edits=5)
    assert {
        "solve_ms",
        "edit_p50_ms",
        "trimesh_over_edit",
        "bvh_over_solve",
        "cost_lbfgs",
        "solve_lbfgs_whitened_ms",
    } <= set(found)
    assert found["points"] == 40 and all(np.isfinite(v) and v >= 0 for v in found.values())
