# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes of known size written in every format and read back."""

from __future__ import annotations

import logging
import re
import struct
from pathlib import Path

import numpy as np
import pytest
import trimesh
from mesh_files import HIGH, LOW, bounds, box, hall, write

from walk_building.errors import BuildingError, ParameterError
from walk_building.loaders import load_model
from walk_building.model import LoadOptions

_FORMATS = [".glb", ".gltf", ".obj", ".ply", ".stl", ".dae"]


@pytest.mark.parametrize("suffix", _FORMATS)
def test_known_bounds_come_back_in_metres_and_z_up(tmp_path: Path, suffix: str) -> None:
    # glTF is y up by its specification, COLLADA where it says nothing; the others are taken as z up.
    y_up = suffix in (".glb", ".gltf", ".dae")
    model = load_model(write(hall(), tmp_path / f"hall{suffix}", y_up=y_up))
    np.testing.assert_allclose(bounds(model), [LOW, HIGH], atol=1e-5)
    corners = model.vertices[model.faces].reshape(-1, 3)
    on_column = np.isclose(corners, [1.5, 3.5, 2.0], atol=1e-5).all(axis=1)
    assert on_column.any(), "the column's own corner shows that no axis is mirrored"
    assert len(model.faces) == 36


@pytest.mark.parametrize("suffix", _FORMATS)
def test_triangles_still_face_outwards(tmp_path: Path, suffix: str) -> None:
    y_up = suffix in (".glb", ".gltf", ".dae")
    model = load_model(write(hall(), tmp_path / f"hall{suffix}", y_up=y_up))
    corners = model.vertices[model.faces]
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert volume == pytest.approx(hall().volume, rel=1e-5)


@pytest.mark.parametrize("suffix", [".obj", ".ply", ".stl"])
def test_units_and_up_axis_are_taken_from_the_options_where_the_format_is_silent(tmp_path: Path, suffix: str) -> None:
    path = write(hall(), tmp_path / f"hall{suffix}", y_up=True, scale=1 / 0.0254)
    model = load_model(path, LoadOptions(units_m=0.0254, up="y"))
    np.testing.assert_allclose(bounds(model), [LOW, HIGH], atol=1e-5)
    assert model.units_m == 0.0254


@pytest.mark.parametrize("suffix", [".obj", ".ply", ".stl"])
def test_assumed_metres_are_said(tmp_path: Path, suffix: str) -> None:
    path = write(hall(), tmp_path / f"hall{suffix}", y_up=False)
    assert any("metres are assumed" in warning for warning in load_model(path).warnings)
    assert not any("metres" in warning for warning in load_model(path, LoadOptions(units_m=1.0)).warnings)


@pytest.mark.parametrize(("unit", "up"), [("0.0254", "Z_UP"), ("0.01", "Y_UP"), ("1", "X_UP")])
def test_collada_unit_and_up_axis_are_applied(tmp_path: Path, unit: str, up: str) -> None:
    scale = 1 / float(unit)
    scene = hall()
    if up == "X_UP":  # x up, y to the left: z-up coordinates (x, y, z) are written as (z, x, y)
        scene.apply_transform(np.array([[0, 0, 1, 0], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 1]], dtype=float))
    path = write(scene, tmp_path / "hall.dae", y_up=up == "Y_UP", scale=scale)
    text = path.read_text()
    text = re.sub(r"<up_axis>.*?</up_axis>", f'<unit name="x" meter="{unit}"/><up_axis>{up}</up_axis>', text)
    path.write_text(text)
    model = load_model(path)
    assert model.units_m == float(unit)
    np.testing.assert_allclose(bounds(model), [LOW, HIGH], atol=1e-4)


@pytest.mark.parametrize("suffix", [".glb", ".gltf", ".obj"])
def test_parts_keep_their_names(tmp_path: Path, suffix: str) -> None:
    model = load_model(write(hall(), tmp_path / f"hall{suffix}", y_up=suffix != ".obj"))
    assert sorted(part.name for part in model.parts) == ["column", "floor", "wall"]
    assert sum(part.n_faces for part in model.parts) == len(model.faces)
    wall = next(part for part in model.parts if part.name == "wall")
    corners = model.vertices[model.faces[wall.first_face : wall.first_face + wall.n_faces]].reshape(-1, 3)
    np.testing.assert_allclose(np.ptp(corners, axis=0), [0.2, 5.0, 2.8], atol=1e-5)


def test_ignored_parts_are_left_out(tmp_path: Path) -> None:
    path = write(hall(), tmp_path / "hall.glb", y_up=True)
    model = load_model(path, LoadOptions(ignore="^col"))
    assert sorted(part.name for part in model.parts) == ["floor", "wall"]
    assert load_model(path, LoadOptions(ignore="curtain")).warnings[-1].endswith("found no part.")
    with pytest.raises(BuildingError, match="leaves no part"):
        load_model(path, LoadOptions(ignore="mesh"))
    with pytest.raises(ParameterError, match="regular expression"):
        load_model(path, LoadOptions(ignore="("))


@pytest.mark.parametrize("suffix", [".glb", ".gltf"])
def test_every_instance_is_placed_mirrored_ones_too(tmp_path: Path, suffix: str) -> None:
    scene = trimesh.Scene()
    post = box([0, 0, 0], [1, 2, 3])
    for i, x_scale in enumerate((1.0, -1.0)):
        transform = np.diag([x_scale, 1.0, 1.0, 1.0])
        transform[0, 3] = 10.0 * i
        scene.add_geometry(post, node_name=f"post{i}", geom_name="post", transform=transform)
    model = load_model(write(scene, tmp_path / f"posts{suffix}", y_up=True))
    assert [part.n_faces for part in model.parts] == [12, 12]
    np.testing.assert_allclose(bounds(model), [[0, 0, 0], [10, 2, 3]], atol=1e-6)
    corners = model.vertices[model.faces]
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert volume == pytest.approx(12.0)


def test_triangles_only_lines_and_points_are_left_out_and_said(tmp_path: Path) -> None:
    scene = hall()
    scene.add_geometry(trimesh.PointCloud(np.ones((4, 3))), node_name="points")
    scene.add_geometry(trimesh.load_path(np.array([[[0, 0, 0], [90, 0, 0]]], dtype=float)), node_name="line")
    model = load_model(write(scene, tmp_path / "hall.glb", y_up=True))
    np.testing.assert_allclose(bounds(model), [LOW, HIGH], atol=1e-5)
    assert any(warning.startswith("2 lines or point clouds") for warning in model.warnings)


def test_missing_textures_neither_fail_nor_print(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    path = write(hall(), tmp_path / "hall.obj", y_up=False)
    path.write_text("mtllib gone.mtl\nusemtl gone\n" + path.read_text())
    with caplog.at_level(logging.DEBUG):
        assert len(load_model(path).faces) == 36
    ply = write(hall(), tmp_path / "hall.ply", y_up=False)
    ply.write_bytes(ply.read_bytes().replace(b"end_header", b"comment TextureFile gone.png\nend_header", 1))
    assert len(load_model(ply).faces) == 36
    assert capfd.readouterr() == ("", "")
    assert not [record for record in caplog.records if record.levelno >= logging.WARNING]


def test_obj_with_polygons_relative_indices_and_latin_comments(tmp_path: Path) -> None:
    path = tmp_path / "floor.obj"
    path.write_bytes(
        b"# Geb\xe4ude\no first\nv 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nf -4 -3 -2 -1\n"
        b"o second\nv 0 0 9\nv 4 0 9\nv 4 3 9\nv 0 3 9\nf -4 -3 -2 -1\n"
    )
    model = load_model(path)
    assert len(model.faces) == 4
    np.testing.assert_allclose(bounds(model), [[0, 0, 0], [4, 3, 9]])


def test_ascii_stl_is_read(tmp_path: Path) -> None:
    path = tmp_path / "hall.stl"
    path.write_text(hall().to_mesh().export(file_type="stl_ascii"))
    np.testing.assert_allclose(bounds(load_model(path)), [LOW, HIGH], atol=1e-5)


def test_triangles_without_area_and_unused_vertices_are_dropped(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level("INFO")
    path = tmp_path / "floor.obj"
    path.write_text("v 0 0 0\nv 4 0 0\nv 4 3 0\nv nan 0 0\nv 9e9 0 0\nf 1 2 3\nf 1 2 2\nf 1 1 1\n")
    model = load_model(path)
    assert model.vertices.shape == (3, 3) and model.faces.tolist() == [[0, 1, 2]]
    assert "2 triangles without an area were left out" in caplog.text
    assert not any("area" in warning for warning in model.warnings), "no client has to know"


@pytest.mark.parametrize("far", [(5e5, 4e6, 0.0), (0.0, 0.0, 2500.0)])
def test_far_building_is_moved_near_and_the_offset_kept(tmp_path: Path, far: tuple[float, float, float]) -> None:
    path = tmp_path / "hall.obj"
    lines = [
        "v " + " ".join(f"{a + b:.6f}" for a, b in zip(vertex, far, strict=True))
        for vertex in hall().to_mesh().vertices
    ]
    faces = ["f " + " ".join(str(i + 1) for i in face) for face in hall().to_mesh().faces]
    path.write_text("\n".join(lines + faces))
    model = load_model(path)
    np.testing.assert_allclose(bounds(model) + model.offset_m, np.array([LOW, HIGH]) + far, atol=1e-6)
    assert np.abs(model.vertices).max() < 10.0
    assert np.array_equal(model.offset_m != 0.0, np.array(far) != 0.0)


def test_arrays_are_read_only_and_of_the_promised_types(tmp_path: Path) -> None:
    model = load_model(write(hall(), tmp_path / "hall.stl", y_up=False))
    assert model.vertices.dtype == np.float64 and model.faces.dtype == np.int32
    for array in (model.vertices, model.faces, model.offset_m):
        assert not array.flags.writeable and array.flags.c_contiguous


def test_hash_names_content_and_options_but_not_the_place(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    here = write(hall(), tmp_path / "a" / "hall.gltf", y_up=True)
    there = write(hall(), tmp_path / "b" / "other.gltf", y_up=True)
    first = load_model(here).content_hash
    assert re.fullmatch("[0-9a-f]{64}", first)
    assert load_model(there).content_hash == first
    assert load_model(here, LoadOptions(ignore="column")).content_hash != first
    buffer = next((tmp_path / "a").glob("*.bin"))
    data = bytearray(buffer.read_bytes())
    struct.pack_into("<f", data, len(data) - 4, struct.unpack_from("<f", data, len(data) - 4)[0] + 0.5)
    buffer.write_bytes(data)
    assert load_model(here).content_hash != first
