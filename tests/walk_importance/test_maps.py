# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import dataclasses

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scenes import box, building_of, model_of, shell, two_rooms
from scipy.ndimage import distance_transform_edt

from walk_building.errors import ParameterError
from walk_building.model import Part
from walk_importance.config import ImportanceConfig
from walk_importance.distance import distance_map, floor_and_ceiling_faces
from walk_importance.errors import NoFreeVoxelError
from walk_importance.grid import VoxelGrid, fit_grid
from walk_importance.importance_map import reweigh
from walk_importance.obstacle import obstacle_voxels
from walk_importance.pipeline import compute_importance, refine_importance


def unit_grid(*shape: int) -> VoxelGrid:
    return VoxelGrid(origin=np.zeros(3), voxel_size_m=1.0, shape=(shape[0], shape[1], shape[2]))


def test_a_voxel_holds_its_own_centre() -> None:
    grid, _ = fit_grid(np.array([[-3.0, 2.0, 0.0], [5.1, 9.7, 6.3]]), 0.4, 10**6)
    every = np.argwhere(np.ones(grid.shape, bool))
    np.testing.assert_array_equal(grid.indices(grid.centres(every)), every)


@settings(max_examples=50, deadline=None)
@given(st.tuples(*[st.floats(0.0, 60.0)] * 3), st.floats(0.05, 0.6), st.integers(1000, 100_000))
def test_the_grid_covers_the_building_and_keeps_the_cap(
    extent: tuple[float, float, float], size: float, cap: int
) -> None:
    bounds = np.array([[-1.0, 2.0, 3.0], [-1.0 + extent[0], 2.0 + extent[1], 3.0 + extent[2]]])
    grid, notes = fit_grid(bounds, size, cap)
    assert grid.size <= cap
    assert bool(notes) == (grid.voxel_size_m > size)
    assert np.all(grid.origin <= bounds[0])
    assert np.all(grid.origin + np.array(grid.shape) * grid.voxel_size_m >= bounds[1] - 1e-6)


def test_a_coarser_grid_says_what_size_it_took() -> None:
    grid, notes = fit_grid(np.array([[0.0, 0, 0], [50, 50, 10]]), 0.1, 100_000)
    assert f"{grid.voxel_size_m:.3f} m" in notes[0]
    assert grid.size > 80_000  # no coarser than the cap asks for


def test_a_grid_too_coarse_for_a_door_says_so() -> None:
    _, notes = fit_grid(np.array([[0.0, 0, 0], [50, 50, 10]]), 0.25, 1000)
    assert "doors may close" in notes[0]
    _, notes = fit_grid(np.array([[0.0, 0, 0], [20, 20, 10]]), 0.25, 100_000)
    assert "doors" not in notes[0]


@settings(max_examples=40, deadline=None)
@given(st.lists(st.floats(-0.5, 6.5), min_size=9, max_size=9))
def test_obstacle_voxels_are_those_a_triangle_clipped_to_them_is_left_in(corners: list[float]) -> None:
    triangle = np.array(corners).reshape(1, 3, 3)
    found = obstacle_voxels(unit_grid(6, 6, 6), triangle)
    for voxel in np.argwhere(np.ones((6, 6, 6), bool)):
        # Within a hair of touching either answer will do.
        if _clipped(triangle[0], voxel + 1e-3, voxel + 0.999):
            assert found[tuple(voxel)]
        elif not _clipped(triangle[0], voxel - 1e-3, voxel + 1.001):
            assert not found[tuple(voxel)]


def _clipped(polygon: NDArray[np.float64], low: NDArray[np.float64], high: NDArray[np.float64]) -> bool:
    """Sutherland and Hodgman: whether anything is left of a polygon in a box."""
    points = list(polygon)
    for axis in range(3):
        for sign, bound in ((1, low[axis]), (-1, -high[axis])):
            kept = []
            for i, a in enumerate(points):
                b = points[(i + 1) % len(points)]
                da, db = sign * a[axis] - bound, sign * b[axis] - bound
                if da >= 0:
                    kept.append(a)
                if (da >= 0) != (db >= 0):
                    kept.append(a + (b - a) * da / (da - db))
            points = kept
    return len(points) > 0


def test_a_plane_on_whole_voxels_fills_one_layer() -> None:
    floor = box((0, 0, -0.2), (4, 4, 0.0)).triangles
    grid, _ = fit_grid(np.array([[0.0, 0, 0], [4, 4, 3]]), 0.25, 10**6)
    top = floor[np.all(floor[:, :, 2] == 0.0, axis=1)]
    assert np.flatnonzero(obstacle_voxels(grid, top).any(axis=(0, 1))).tolist() == [0]


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1), st.floats(0.5, 9.0), st.floats(0.0, 0.2))
def test_distance_equals_the_euclidean_transform_clipped(seed: int, clip: float, share: float) -> None:
    obstacles = np.random.default_rng(seed).random((9, 12, 7)) < share
    found = distance_map(unit_grid(9, 12, 7), obstacles, clip)
    truth = distance_transform_edt(~obstacles) if obstacles.any() else np.full(obstacles.shape, np.inf)
    np.testing.assert_allclose(found, np.minimum(truth / clip, 1.0), atol=1e-5)


def level_share(meshes: list[trimesh.Trimesh], index: int, kind: str = "mesh", area: float = 4.0) -> float:
    """Share of the area of one mesh that counts as floor or ceiling."""
    first = sum(len(mesh.faces) for mesh in meshes[:index])
    part = Part(name="it", kind=kind, first_face=first, n_faces=len(meshes[index].faces))
    model = dataclasses.replace(model_of(meshes), parts=(part,))
    faces = slice(part.first_face, part.first_face + part.n_faces)
    area_of = meshes[index].area_faces
    return float(area_of[floor_and_ceiling_faces(model, area)[faces]].sum() / area_of.sum())


def test_a_floor_of_an_unlabelled_mesh_is_left_out_and_its_table_is_not() -> None:
    meshes = [box((0, 0, -0.2), (6, 5, 0)), box((1, 1, 0.7), (2.6, 1.9, 0.75))]
    top_and_bottom = 2 * 6 * 5 / meshes[0].area
    assert level_share(meshes, 0) == pytest.approx(top_and_bottom)
    assert level_share(meshes, 1) == 0.0


def test_the_top_of_a_long_wall_is_no_floor() -> None:
    assert level_share([box((0, 0, 0), (40, 0.2, 3))], 0) == 0.0


def test_a_ramp_is_a_floor_and_a_steep_roof_side_is_a_wall() -> None:
    def tilted(degrees: float) -> trimesh.Trimesh:
        plate = box((0, 0, 0), (6, 4, 0.1))
        plate.apply_transform(trimesh.transformations.rotation_matrix(np.radians(degrees), [1, 0, 0]))
        return plate

    assert level_share([tilted(10)], 0) > 0.8
    assert level_share([tilted(60)], 0) == 0.0


@pytest.mark.parametrize(
    ("kind", "share"),
    [
        *((kind, 1.0) for kind in ("IfcSlab", "IfcRoof", "IfcStairFlight", "IfcRamp", "IfcFooting", "IfcSite")),
        *((kind, 0.0) for kind in ("IfcWallStandardCase", "IfcFurniture", "IfcDoor", "IfcColumn")),
        # What has a class that says nothing is asked for its shape: top and bottom, not the sides.
        ("IfcBuildingElementProxy", 60 / 66.6),
    ],
)
def test_the_class_decides_where_there_is_one(kind: str, share: float) -> None:
    assert level_share([box((0, 0, 0), (6, 5, 0.3))], 0, kind) == pytest.approx(share)


def test_a_covering_is_left_out_where_it_lies_flat_only() -> None:
    assert level_share([box((0, 0, 0), (6, 5, 0.02))], 0, "IfcCovering") > 0.95
    assert level_share([box((0, 0, 0), (6, 0.02, 3))], 0, "IfcCovering") < 0.05


def test_in_the_middle_of_a_hall_distance_is_to_the_walls_not_to_the_floor() -> None:
    hall = building_of(shell(9.0, 7.0, 3.0))
    config = ImportanceConfig(distance_clip_m=10.0, visibility_error=1.0)
    maps = compute_importance(hall, config)
    for height in (0.5, 1.5, 2.5):
        voxel = tuple(maps.grid.indices(np.array([[4.5, 3.5, height]]))[0])
        assert maps.distance[voxel] * 10.0 == pytest.approx(3.5, abs=0.5)


def test_importance_is_the_weighted_sum_and_follows_the_weights_without_new_maps() -> None:
    config = ImportanceConfig(weight_obstacle=7.0, weight_distance=2.0, weight_visibility=3.0)
    maps = compute_importance(building_of(two_rooms()), config)
    expected = 7 * (1 - maps.obstacle) + 2 * maps.distance + 3 * maps.visibility
    np.testing.assert_allclose(maps.importance, expected, atol=1e-5)
    other = reweigh(maps, dataclasses.replace(config, weight_distance=0.0))
    np.testing.assert_allclose(other.importance, expected - 2 * maps.distance, atol=1e-5)
    assert other.visibility is maps.visibility


def test_no_obstacle_voxel_wins_with_the_default_weights() -> None:
    maps = compute_importance(building_of(two_rooms()))
    assert maps.importance[maps.obstacle == 1].max() < maps.importance[maps.obstacle == 0].min()


def test_refining_ends_at_the_accuracy_asked_for() -> None:
    building = building_of(two_rooms())
    for wanted in (0.3, 0.05):
        *_, last = refine_importance(building, ImportanceConfig(visibility_error=wanted))
        free = last.obstacle == 0
        assert last.visibility_stderr <= wanted * last.visibility[free].std()
    *_, last = refine_importance(building, ImportanceConfig(visibility_error=0.0, voxel_size_m=0.4))
    assert last.visibility_stderr == 0.0


def test_free_space_indoors_leaves_out_what_lies_outside() -> None:
    # A hall on a lawn: from indoors, the air over the lawn does not count.
    meshes = [*shell(6.0, 5.0), box((-6, -6, -0.4), (12, 11, -0.2))]
    building = building_of(meshes)
    maps = compute_importance(building, ImportanceConfig(free_space="indoors", visibility="exact"))
    seen = maps.visibility > 0
    centres = maps.grid.centres(np.argwhere(seen))
    assert np.all((centres > [-0.1, -0.1, -0.1]) & (centres < [6.1, 5.1, 3.1]))
    assert maps.visibility.max() > 0.95


def test_sources_at_eye_height_give_the_same_shares_there() -> None:
    building = building_of(two_rooms())
    every = compute_importance(building, ImportanceConfig(visibility="exact"))
    eyes = compute_importance(building, ImportanceConfig(visibility="exact", visibility_sources="eye"))
    where = eyes.visibility > 0
    assert 0 < where.sum() < (every.visibility > 0).sum() / 2
    np.testing.assert_array_equal(eyes.visibility[where], every.visibility[where])


def test_a_building_without_a_free_voxel_is_refused_with_the_way_out() -> None:
    # Plates closer to each other than the voxels are big.
    plates = [box((0, 0, 0.3 * k), (5, 5, 0.3 * k + 0.01)) for k in range(3)]
    building = dataclasses.replace(
        building_of(shell(4, 4)), model=model_of(plates), geometry=building_of(plates).geometry
    )
    with pytest.raises(NoFreeVoxelError, match="smaller voxel_size_m"):
        compute_importance(building, ImportanceConfig(voxel_size_m=0.5))


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("weight_distance", -1.0),
        ("weight_visibility", float("nan")),
        ("voxel_size_m", 0.0),
        ("voxel_size_m", 1.2),
        ("max_voxels", 10),
        ("visibility", "radar"),
        ("distance_clip_m", float("inf")),
    ],
)
def test_a_bad_parameter_is_named(field: str, value: object) -> None:
    with pytest.raises(ParameterError, match=field):
        ImportanceConfig(**{field: value})
