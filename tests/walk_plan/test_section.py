# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Horizontal sections, and labels that keep off each other."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scenes import box

from walk_building import Part
from walk_building.geometry import Geometry
from walk_plan.along import densified, every, walked_m
from walk_plan.drawing import style
from walk_plan.drawing.labels import LabelBoard, ring
from walk_plan.section import cut, cut_segments


def geometry_of(*meshes: trimesh.Trimesh) -> tuple[Geometry, list[Part]]:
    parts, first = [], 0
    for mesh in meshes:
        parts.append(Part(name="part", kind="IfcWall", first_face=first, n_faces=len(mesh.faces)))
        first += len(mesh.faces)
    whole = trimesh.util.concatenate(list(meshes))
    return Geometry(np.array(whole.vertices, float), np.array(whole.faces, np.int32)), parts


def test_a_box_is_cut_in_its_rectangle() -> None:
    geometry, parts = geometry_of(box((0, 0, 0), (3, 0.2, 2.5)))
    section = cut(geometry, 1.2, parts)
    (line,) = section.lines
    assert np.allclose(line[0], line[-1])
    assert shapely.Polygon(line).equals(shapely.box(0, 0, 3, 0.2))
    assert sum(solid.area for solid in section.solids) == pytest.approx(0.6)


def test_walls_are_solid_and_the_room_between_them_is_not() -> None:
    walls = [
        box((0, 0, 0), (5, 0.3, 3)),
        box((0, 4, 0), (5, 4.3, 3)),
        box((0, 0.3, 0), (0.3, 4, 3)),
        box((4.7, 0.3, 0), (5, 4, 3)),
    ]
    section = cut(*geometry_of(*walls)[:1], 1.2, geometry_of(*walls)[1])
    assert sum(solid.area for solid in section.solids) == pytest.approx(5 * 4.3 - 4.4 * 3.7)


def test_nothing_is_cut_above_the_building() -> None:
    geometry, parts = geometry_of(box((0, 0, 0), (1, 1, 1)))
    assert cut(geometry, 5.0, parts).lines == ()
    # The very top counts as below the plane, the very bottom as above it: never half a triangle.
    for z in (0.0, 1.0):
        segments, face = cut_segments(geometry.vertices, geometry.faces, z)
        assert len(segments) == len(face) and np.isfinite(segments).all()


def test_segments_agree_with_another_librarys_section() -> None:
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=2.0)
    segments, face = cut_segments(np.asarray(mesh.vertices), np.asarray(mesh.faces, np.int32), 0.37)
    theirs = trimesh.intersections.mesh_plane(mesh, [0, 0, 1], [0, 0, 0.37])
    length = np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1)
    assert length.sum() == pytest.approx(np.linalg.norm(theirs[:, 1] - theirs[:, 0], axis=1).sum())
    centres = segments.mean(axis=1)
    triangles = np.asarray(mesh.vertices)[mesh.faces[face]]
    assert (centres >= triangles[:, :, :2].min(axis=1) - 1e-9).all()


@settings(max_examples=50, deadline=None)
@given(
    st.lists(st.tuples(st.floats(0, 500), st.floats(0, 300)), min_size=1, max_size=40),
    st.tuples(st.floats(4, 80), st.floats(4, 30)),
)
def test_placed_labels_never_overlap_and_stay_on_the_paper(
    points: list[tuple[float, float]], size: tuple[float, float]
) -> None:
    made = style.figure(5, 3)
    axes = made.add_axes((0, 0, 1, 1))
    board = LabelBoard(axes)
    for point in points:
        board.place(ring(np.array(point), (20.0, 40.0)), size)
    frame = axes.bbox.extents
    boxes = [shapely.box(*taken) for taken in board.boxes]
    assert all(
        frame[0] <= x0 and frame[1] <= y0 and x1 <= frame[2] and y1 <= frame[3] for x0, y0, x1, y1 in board.boxes
    )
    overlaps = [a.intersection(b).area for i, a in enumerate(boxes) for b in boxes[i + 1 :]]
    assert max(overlaps, default=0.0) < 1e-6


def test_a_label_keeps_off_what_it_must_not_cover() -> None:
    board = LabelBoard(style.figure(5, 3).add_axes((0, 0, 1, 1)))
    here = np.array([[100.0, 100.0]])
    assert board.place(here, (20.0, 10.0), avoid=np.array([[105.0, 102.0]])) is None
    assert board.place(here, (20.0, 10.0), avoid=np.array([[111.0, 100.0]])) is not None


@pytest.mark.parametrize(("length", "expected"), [(1.0, 1.0), (4.99, 2.0), (5.0, 5.0), (19.0, 10.0), (0.3, 0.2)])
def test_scale_bars_are_round(length: float, expected: float) -> None:
    assert style.round_length(length) == pytest.approx(expected)


def test_points_along_a_polyline_are_even_and_keep_its_ends() -> None:
    corner = np.array([[0.0, 0, 0], [3, 0, 0], [3, 4, 0]])
    assert walked_m(corner) == pytest.approx([0, 3, 7])
    points = every(corner, 0.5)
    assert np.diff(walked_m(points)).max() <= 0.5 + 1e-12
    assert points[[0, -1]] == pytest.approx(corner[[0, -1]])
    fine = densified(corner, 0.3)
    assert np.linalg.norm(np.diff(fine, axis=0), axis=1).max() <= 0.3 + 1e-12
    assert all(np.any(np.all(np.isclose(fine, point), axis=1)) for point in corner)
