# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The swept body against closed forms and dense sampling."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
import trimesh
from scenes import box, building_of, shell, two_rooms

from walk_building import BodySweep, Geometry, Walker
from walk_building.standing import body_fits

WALKER = Walker()
EYE = WALKER.eye_height_m


def sweep_of(meshes: list[trimesh.Trimesh]) -> BodySweep:
    mesh = trimesh.util.concatenate(meshes)
    return BodySweep(Geometry(np.asarray(mesh.vertices), np.asarray(mesh.faces, dtype=np.int32)), WALKER)


def test_clearance_is_the_distance_from_the_body_to_the_nearest_wall() -> None:
    sweep = sweep_of(shell(6, 6))
    clearance = sweep.standing_clearance([(3, 1, EYE), (0.5, 3, EYE), (0.1, 3, EYE)])
    # In the middle of the room the floor is nearest to the body's lower end, a step below it.
    np.testing.assert_allclose(clearance, [WALKER.step_m, 0.25, 0.0], atol=1e-6)


@pytest.mark.parametrize(("thickness", "free"), [(0.001, False), (0.2, False), (0.0, True)])
def test_a_wall_between_two_free_points_is_never_jumped(thickness: float, free: bool) -> None:
    wall = [box((3.0, 0, 0), (3.0 + thickness, 6, 3))] if thickness else []
    sweep = sweep_of(shell(6, 6) + wall)
    assert sweep.segments_free([(1, 3, EYE), (5, 3, EYE)]).tolist() == [free]


@pytest.mark.parametrize(("door_m", "free"), [(0.55, True), (0.49, False)])
def test_a_door_lets_through_what_is_narrower_than_it(door_m: float, free: bool) -> None:
    assert sweep_of(two_rooms(door_m)).segments_free([(2, 2, EYE), (6, 2, EYE)]).tolist() == [free]


def test_what_is_lower_than_a_step_is_stepped_over_and_what_is_higher_is_not() -> None:
    for height, free in ((WALKER.step_m - 0.02, True), (WALKER.step_m + 0.02, False)):
        sill = box((3, 0, 0), (3.1, 6, height))
        assert sweep_of([*shell(6, 6), sill]).segments_free([(1, 3, EYE), (5, 3, EYE)]).tolist() == [free]


def test_the_sweep_agrees_with_standing_at_many_points_of_the_way() -> None:
    rng = np.random.default_rng(5)
    clutter = [box(tuple(p), tuple(p + rng.uniform(0.1, 0.8, 3))) for p in rng.uniform(0.5, 5, (12, 3)) * (1, 1, 0.4)]
    sweep = sweep_of(shell(6, 6) + clutter)
    path = np.column_stack([rng.uniform(0.3, 5.7, (60, 2)), np.full(60, EYE)])
    swept = sweep.segments_free(path)
    dense = []
    for a, b in itertools.pairwise(path):
        points = a + (b - a) * np.linspace(0, 1, 400)[:, None]
        dense.append(sweep.standing_clearance(points).min())
    sampled = np.array(dense)
    assert swept.any() and (~swept).any()
    assert not swept[sampled == 0.0].any()
    assert swept[sampled > 0.02].all()


def test_two_independent_engines_agree_where_a_body_fits() -> None:
    building = building_of(two_rooms())
    rng = np.random.default_rng(6)
    floor = np.column_stack([rng.uniform(0, 8.2, 800), rng.uniform(0, 4, 800), np.zeros(800)])
    ours = body_fits(building.geometry, WALKER, floor)
    clearance = BodySweep(building.geometry, WALKER).standing_clearance(floor + (0, 0, EYE))
    clear_cut = (clearance == 0.0) | (clearance > 1e-6)
    np.testing.assert_array_equal(ours[clear_cut], clearance[clear_cut] > 0.0)


def test_a_path_of_one_point_has_no_segments() -> None:
    assert sweep_of(shell(4, 4)).segments_free([(2, 2, EYE)]).shape == (0,)
