# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Doors known by name, and closed doors that nothing names."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
import trimesh
from room_scores import SAMPLE, door_score
from scenes import box, building_of, shell, two_rooms

from walk_building import Building, LoadOptions, ParameterError, load_building
from walk_building.loaders import load_model


def leaf(x: float = 4.08, thickness_m: float = 0.04, top_m: float = 2.1) -> trimesh.Trimesh:
    return box((x, 1.55, 0), (x + thickness_m, 2.45, top_m))


def turned(meshes: list[trimesh.Trimesh], angle_deg: float) -> Building:
    turn = trimesh.transformations.rotation_matrix(np.radians(angle_deg), (0, 0, 1))
    return building_of([mesh.copy().apply_transform(turn) for mesh in meshes])


@pytest.mark.parametrize(
    "name", ["Door", "door_01", "front door", "Tür", "Innentuer 3", "porte-2", "Puerta", "voordeur", "SlidingDoor"]
)
def test_names_of_doors_are_known(name: str) -> None:
    assert re.search(LoadOptions().doors, name)


@pytest.mark.parametrize(
    "name",
    ["Doorframe", "door_01_frame", "outdoor floor", "indoors", "doormat", "Türrahmen", "corridor", "wall", "grandeur"]
    + ["structure", "carport", "transporter", "doorway", "Türgriff", "fixtures", "Natur", "furniture"],
)
def test_names_of_other_things_are_no_doors(name: str) -> None:
    assert not re.search(LoadOptions().doors, name)


def _export(path: Path, leaf_name: str) -> Path:
    scene = trimesh.Scene()
    for k, mesh in enumerate(two_rooms()):
        scene.add_geometry(mesh, node_name=f"wall{k}", geom_name=f"wall{k}")
    scene.add_geometry(leaf(), node_name=leaf_name, geom_name=leaf_name)
    turn = trimesh.transformations.rotation_matrix(-np.pi / 2, (1, 0, 0))
    scene.apply_transform(turn)  # glTF is y up
    scene.export(path)
    return path


def test_a_leaf_named_door_stands_open_and_is_listed(tmp_path: Path) -> None:
    building = load_building(_export(tmp_path / "house.glb", "Door 7"))
    assert [door.name for door in building.model.doors] == ["Door 7"]
    assert building.model.doors[0].size == pytest.approx([0.04, 0.9, 2.1], abs=1e-3)
    assert all(room.reachable for room in building.rooms) and len(building.rooms) == 2
    assert any("stand open: 1" in warning for warning in building.warnings)


def test_the_pattern_can_be_changed_and_switched_off(tmp_path: Path) -> None:
    path = _export(tmp_path / "house.glb", "Blatt 7")
    assert not load_model(path).doors
    assert len(load_model(path, LoadOptions(doors="Blatt")).doors) == 1
    assert not load_model(path, LoadOptions(doors="")).doors
    with pytest.raises(ParameterError, match="doors"):
        load_model(path, LoadOptions(doors="("))


def test_only_parts_of_a_doors_size_are_doors(tmp_path: Path) -> None:
    path = _export(tmp_path / "house.glb", "Door 7")
    everything = load_model(path, LoadOptions(doors="."))
    names = {door.name for door in everything.doors}
    assert "Door 7" in names and not names & {"wall0", "wall1", "wall2", "wall3"}, "the shell is no door"
    assert all(1.5 <= door.size[2] <= 3.2 and door.size[:2].max() <= 2.6 for door in everything.doors)


def test_a_file_that_is_one_part_stays_whole(tmp_path: Path) -> None:
    box((0, 0, 0), (1, 0.1, 2)).export(tmp_path / "door.ply")
    model = load_model(tmp_path / "door.ply", LoadOptions(units_m=1.0, up="z"))
    assert len(model.faces) == 12 and not model.doors


@pytest.mark.parametrize("angle_deg", [0.0, 90.0, 27.0])
def test_a_closed_leaf_is_reported_with_its_place_and_size(angle_deg: float) -> None:
    building = turned([*two_rooms(), leaf()], angle_deg)
    (door,) = building.closed_doors
    c, s = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    assert door.position == pytest.approx([c * 4.1 - s * 2.0, s * 4.1 + c * 2.0, 0.0], abs=0.05)
    assert (door.width_m, door.height_m, door.thickness_m) == pytest.approx((0.9, 2.1, 0.04), abs=0.05)
    assert abs(door.normal @ (c, s)) == pytest.approx(1.0, abs=0.01)
    warning = next(w for w in building.warnings if "Closed doors here?" in w)
    assert "--doors" in warning and f"({door.position[0]:.1f}, {door.position[1]:.1f}" in warning


def test_a_sheet_without_thickness_is_reported() -> None:
    sheet = trimesh.Trimesh(
        vertices=[(4.1, 1.55, 0), (4.1, 2.45, 0), (4.1, 2.45, 2.1), (4.1, 1.55, 2.1)], faces=[(0, 1, 2), (0, 2, 3)]
    )
    assert len(building_of([*two_rooms(), sheet]).closed_doors) == 1


def test_what_is_no_closed_door_is_not_reported() -> None:
    open_leaf = box((3.1, 1.51, 0), (4.0, 1.55, 2.05))
    thin_wall = [box((4.0, 0, 0), (4.1, 4, 3))]
    screen = [box((4.0, 1.5, 0), (4.05, 2.5, 2.1))]
    window = [box((4.0, 1.55, 0), (4.2, 2.45, 0.9)), box((4.08, 1.55, 0.9), (4.12, 2.45, 2.1))]
    cupboard = [box((4.0, 1.0, 0), (4.6, 2.0, 2.1))]
    for meshes in (
        two_rooms(),
        [*two_rooms(), open_leaf],
        shell(8.2, 4.0) + thin_wall,
        shell(8.2, 4.0) + screen,
        two_rooms() + window,
        shell(8.2, 4.0) + cupboard,
        two_rooms(0.0),
    ):
        assert building_of(meshes).closed_doors == ()


def test_closed_doors_of_the_sample_are_found_without_its_classes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    score = door_score(SAMPLE, tmp_path, monkeypatch)
    # 17 of 19: the other two are 2 m wide.
    assert score.recall >= 17 / 19 and score.precision == 1.0


def test_closed_doors_of_the_duplex_are_found_without_its_classes(
    buildings_dir: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    score = door_score(buildings_dir / "duplex.ifc", tmp_path, monkeypatch)
    # 12 of 14: the other two lead outdoors, where there is no ground to stand on.
    assert score.recall >= 12 / 14 and score.precision == 1.0


@pytest.mark.parametrize("name", ["willowgarage.dae", "small_house.ply", "duplex.ifc"])
def test_open_doorways_are_not_reported(name: str, buildings_dir: Path) -> None:
    assert load_building(buildings_dir / name).closed_doors == ()
