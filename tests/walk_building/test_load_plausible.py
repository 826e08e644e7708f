# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What is loaded but doubtful is said."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from walk_building.errors import BuildingError
from walk_building.loaders import load_model
from walk_building.model import LoadOptions

_TO_Y_UP = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], dtype=float)


def building(size: tuple[float, float, float], slabs: int, walls: int) -> trimesh.Trimesh:
    """Slabs of 0.2 m from the ground up, and as many walls across and along as asked for."""
    x, y, z = size
    boxes = [([0, 0, u], [x, y, u + 0.2]) for u in np.linspace(0, z - 0.2, slabs)]
    boxes += [([u, 0, 0], [u + 0.2, y, z]) for u in np.linspace(0, x - 0.2, walls)]
    boxes += [([0, u, 0], [x, u + 0.2, z]) for u in np.linspace(0, y - 0.2, walls)]
    return trimesh.util.concatenate([trimesh.creation.box(bounds=bounds) for bounds in boxes])


# House with a roof, office without one and with many walls, hall, row of shops without a roof, tower.
_BUILDINGS = [
    ((10, 8, 6), 3, 3),
    ((60, 50, 3), 1, 14),
    ((40, 20, 10), 2, 2),
    ((100, 10, 4), 1, 2),
    ((20, 20, 90), 31, 3),
]


@pytest.mark.parametrize(("size", "slabs", "walls"), _BUILDINGS)
def test_upright_buildings_are_not_suspected(
    tmp_path: Path, size: tuple[float, float, float], slabs: int, walls: int
) -> None:
    path = tmp_path / "house.stl"
    building(size, slabs, walls).export(path)
    assert not any("on its side" in warning for warning in load_model(path).warnings)


@pytest.mark.parametrize(("size", "slabs", "walls"), _BUILDINGS[:4])
def test_building_on_its_side_is_set_upright_where_the_file_names_no_axis(
    tmp_path: Path, size: tuple[float, float, float], slabs: int, walls: int
) -> None:
    path = tmp_path / "house.stl"
    building(size, slabs, walls).apply_transform(_TO_Y_UP).export(path)
    model = load_model(path)
    assert any("y is taken as up (--up z" in warning for warning in model.warnings)
    np.testing.assert_allclose(np.ptp(model.vertices, axis=0), size, atol=1e-4)
    asked = load_model(path, LoadOptions(up="y"))
    assert not any("up" in warning for warning in asked.warnings)
    np.testing.assert_array_equal(asked.vertices, model.vertices)


@pytest.mark.parametrize("unit_m", [1.0, 0.01, 0.0254])
def test_the_side_a_building_lies_on_does_not_depend_on_its_unit(tmp_path: Path, unit_m: float) -> None:
    path = tmp_path / "house.stl"
    building((60, 50, 3), 1, 14).apply_transform(_TO_Y_UP).apply_scale(1 / unit_m).export(path)
    np.testing.assert_allclose(
        np.ptp(load_model(path, LoadOptions(units_m=unit_m)).vertices, axis=0), (60, 50, 3), 1e-4
    )


@pytest.mark.parametrize(("size", "slabs", "walls"), _BUILDINGS[:4])
def test_the_users_axis_goes_before_what_is_seen(
    tmp_path: Path, size: tuple[float, float, float], slabs: int, walls: int
) -> None:
    path = tmp_path / "house.stl"
    building(size, slabs, walls).apply_transform(_TO_Y_UP).export(path)
    model = load_model(path, LoadOptions(up="z"))
    assert any("--up y" in warning for warning in model.warnings)
    np.testing.assert_allclose(np.ptp(model.vertices, axis=0), np.array(size)[[0, 2, 1]], atol=1e-4)


def test_a_house_in_centimetres_without_a_unit_asks_for_it(tmp_path: Path) -> None:
    path = tmp_path / "house.stl"
    building((1000, 800, 600), 3, 3).export(path)
    with pytest.raises(BuildingError, match=r"in centimetres 10 x 8 x 6 m: .*--units \(mm, cm"):
        load_model(path)
    np.testing.assert_allclose(np.ptp(load_model(path, LoadOptions(units_m=0.01)).vertices, axis=0), (10, 8, 6), 1e-4)
    assert np.ptp(load_model(path, LoadOptions(units_m=1.0)).vertices[:, 2]) == pytest.approx(600)


def test_z_up_gltf_is_told_to_try_z(tmp_path: Path) -> None:
    path = tmp_path / "house.glb"
    building((10, 8, 6), 3, 3).export(path)
    assert any("--up z" in warning for warning in load_model(path).warnings)
    assert load_model(path, LoadOptions(up="z")).warnings == ()


def test_coarse_coordinates_are_said(tmp_path: Path) -> None:
    far = building((10, 8, 6), 3, 3).apply_translation([600_000, 5_400_000, 0])
    single, double = tmp_path / "far.stl", tmp_path / "far.obj"
    far.export(single)
    double.write_text(far.export(file_type="obj", digits=3))
    assert any("steps of 500 mm" in warning for warning in load_model(single).warnings)
    assert not any("steps" in warning for warning in load_model(double).warnings)


def test_a_part_that_fits_32_bits_by_chance_is_no_coarse_file(tmp_path: Path) -> None:
    """Whole metres are exact in 32 bits, wherever they are."""
    shift = np.array([600_000.0, 5_400_000.0, 0.0])
    whole = trimesh.creation.box(bounds=[[0, 0, 0], [10, 8, 6]]).apply_translation(shift)
    exact = building((10, 8, 6), 3, 3).apply_translation(shift)
    for name, meshes in (("one", [whole]), ("both", [exact, whole])):
        path = tmp_path / f"{name}.obj"
        lines, first = [], 1
        for k, mesh in enumerate(meshes):
            lines += [f"o part{k}", *("v {:.3f} {:.3f} {:.3f}".format(*v) for v in mesh.vertices)]
            lines += ["f {} {} {}".format(*(face + first)) for face in mesh.faces]
            first += len(mesh.vertices)
        path.write_text("\n".join(lines) + "\n")
        model = load_model(path)
        assert len(model.parts) == len(meshes)
        assert not any("32-bit" in warning for warning in model.warnings)


def test_furniture_cannot_be_told_apart_in_a_mesh(tmp_path: Path) -> None:
    path = tmp_path / "house.stl"
    building((10, 8, 6), 3, 3).export(path)
    assert any("furniture" in warning for warning in load_model(path, LoadOptions(furniture=False)).warnings)


def test_a_unit_in_which_nobody_could_stand_upright_is_doubted(tmp_path: Path) -> None:
    path = tmp_path / "house.stl"
    building((12, 14, 6.2), 3, 3).export(path)
    feet = load_model(path, LoadOptions(units_m=0.3048)).warnings
    assert any("only 1.89 m high" in warning and "--units" in warning for warning in feet)
    assert not any(" m high" in warning for warning in load_model(path).warnings)
