# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The exact queries against other libraries and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from walk_building import Geometry, ParameterError


def soup(seed: int, n: int) -> trimesh.Trimesh:
    rng = np.random.default_rng(seed)
    corners = rng.uniform(-3, 3, (n, 1, 3)) + rng.uniform(-1, 1, (n, 3, 3))
    return trimesh.Trimesh(corners.reshape(-1, 3), np.arange(3 * n).reshape(-1, 3), process=False)


def geometry_of(mesh: trimesh.Trimesh) -> Geometry:
    return Geometry(np.asarray(mesh.vertices), np.asarray(mesh.faces, dtype=np.int32))


@pytest.mark.parametrize("n", [1, 2, 5, 400])
def test_closest_points_agree_with_trimesh(n: int) -> None:
    mesh = soup(n, n)
    query = np.random.default_rng(1).uniform(-5, 5, (300, 3))
    found = geometry_of(mesh).closest(query)
    expected = trimesh.proximity.closest_point(mesh, query)[1]
    np.testing.assert_allclose(found.distance_m, expected, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(found.points - query, axis=1), expected, atol=1e-12)


def test_closest_points_beyond_the_limit_are_reported_as_none() -> None:
    mesh = trimesh.creation.box(bounds=[(0, 0, 0), (1, 1, 1)])
    found = geometry_of(mesh).closest([(3, 0.5, 0.5), (1.5, 0.5, 0.5)], max_distance_m=1.0)
    assert found.face[0] == -1 and np.isinf(found.distance_m[0]) and np.isnan(found.points[0]).all()
    assert found.distance_m[1] == pytest.approx(0.5)


@pytest.mark.parametrize("n", [1, 3, 400])
def test_rays_agree_with_embree(n: int) -> None:
    mesh = soup(n + 7, n)
    rng = np.random.default_rng(2)
    origins, directions = rng.uniform(-5, 5, (2000, 3)), rng.normal(size=(2000, 3))
    found = geometry_of(mesh).raycast(origins, directions)
    oracle = trimesh.ray.ray_pyembree.RayMeshIntersector(mesh)
    expected = oracle.intersects_first(origins, directions)
    # embree computes in single precision: a ray within its rounding of an edge may go either way.
    assert (found.face == expected).mean() > 0.995


def test_many_queries_give_what_few_give() -> None:
    geometry = geometry_of(soup(3, 200))
    query = np.random.default_rng(3).uniform(-4, 4, (9000, 3))
    np.testing.assert_array_equal(geometry.closest(query).distance_m[:50], geometry.closest(query[:50]).distance_m)


def test_height_above_floor_of_a_box() -> None:
    geometry = geometry_of(trimesh.creation.box(bounds=[(0, 0, -1), (4, 4, 0)]))
    np.testing.assert_allclose(geometry.height_above_floor([(1, 1, 1.6), (2, 3, 0.2)]), [1.6, 0.2])
    assert np.isinf(geometry.height_above_floor([(9, 9, 1)])).all()


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_ray_along_an_axis_hits_a_face_that_its_box_has_no_thickness_in(axis: int) -> None:
    corners = np.array([[0, 0, 0], [2, 0, 0], [0, 2, 0]], dtype=float)
    geometry = Geometry(np.roll(corners, axis - 2, axis=1), np.array([[0, 1, 2]], np.int32))
    origin, direction = np.array([0.5, 0.5, 3.0]), np.array([0.0, 0.0, -1.0])
    hit = geometry.raycast([np.roll(origin, axis - 2)], [np.roll(direction, axis - 2)])
    assert hit.distance_m[0] == pytest.approx(3.0)


@given(st.lists(st.tuples(*[st.floats(-2, 2) for _ in range(9)]), min_size=1, max_size=12), st.integers(0, 99))
@settings(max_examples=60, deadline=None)
def test_closest_point_is_never_farther_than_any_corner(rows: list[tuple[float, ...]], seed: int) -> None:
    corners = np.array(rows).reshape(-1, 3)
    geometry = Geometry(corners, np.arange(len(corners)).reshape(-1, 3).astype(np.int32))
    query = np.random.default_rng(seed).uniform(-4, 4, (5, 3))
    nearest_corner = np.linalg.norm(query[:, None] - corners[None], axis=2).min(axis=1)
    found = geometry.closest(query)
    assert (found.distance_m <= nearest_corner + 1e-12).all()
    assert np.isfinite(found.points).all()


@pytest.mark.parametrize("bad", [[(1.0, 2.0)], [(np.nan, 0, 0)], [(np.inf, 0, 0)], [1.0, 2.0, 3.0]])
def test_bad_points_are_refused_with_what_was_expected(bad: object) -> None:
    geometry = geometry_of(trimesh.creation.box())
    with pytest.raises(ParameterError, match="expected"):
        geometry.closest(bad)


def test_a_zero_direction_is_refused() -> None:
    with pytest.raises(ParameterError, match="zero"):
        geometry_of(trimesh.creation.box()).raycast([(0, 0, 0)], [(0, 0, 0)])


def test_no_triangles_are_refused() -> None:
    with pytest.raises(ParameterError, match="triangle"):
        Geometry(np.zeros((0, 3)), np.zeros((0, 3), np.int32))
