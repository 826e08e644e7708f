# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""IFC files made here, of known sizes, in several units and schemas."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
import pytest
from ifc_scene import UNIT_M, IfcScene, two_storeys

from walk_building.errors import BuildingError
from walk_building.loaders import load_model
from walk_building.model import LoadOptions


@pytest.mark.parametrize("schema", ["IFC2X3", "IFC4", "IFC4X3"])
@pytest.mark.parametrize("unit", list(UNIT_M))
def test_boxes_come_out_with_their_sizes_in_metres(tmp_path: Path, schema: str, unit: str) -> None:
    model = load_model(two_storeys(schema=schema, unit=unit).write(tmp_path / "house.ifc"))
    np.testing.assert_allclose(model.vertices.min(axis=0), [0, 0, -0.2], atol=1e-9)
    np.testing.assert_allclose(model.vertices.max(axis=0), [6, 4, 3], atol=1e-9)
    assert model.units_m == pytest.approx(UNIT_M[unit])
    assert [(s.name, s.elevation_m) for s in model.storeys] == [("Ground", 0.0), ("Upper", pytest.approx(3.0))]
    assert model.warnings == ()


def test_doors_stand_open_and_spaces_are_no_obstacles(tmp_path: Path) -> None:
    model = load_model(two_storeys().write(tmp_path / "house.ifc"))
    assert sorted(part.name for part in model.parts) == ["chair", "floor 0", "floor 1", "wall", "window"]
    (door,) = model.doors
    assert (door.name, door.storey) == ("front door", "Ground")
    np.testing.assert_allclose(door.centre, [1.45, 0.05, 1.05], atol=1e-9)
    np.testing.assert_allclose(door.size, [0.9, 0.1, 2.1], atol=1e-9)
    (space,) = model.spaces
    assert (space.name, space.long_name, space.storey) == ("G01", "Hall", "Ground")
    corners = space.vertices[space.faces]
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert volume == pytest.approx(6 * 3.8 * 2.8)


def test_wall_keeps_the_cut_of_its_door(tmp_path: Path) -> None:
    model = load_model(two_storeys().write(tmp_path / "house.ifc"))
    (wall,) = [part for part in model.parts if part.kind == "IfcWall"]
    corners = model.vertices[model.faces[wall.first_face : wall.first_face + wall.n_faces]]
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert volume == pytest.approx(0.2 * (6 * 2.8 - 0.9 * 2.1))


@pytest.mark.parametrize("schema", ["IFC2X3", "IFC4"])
def test_furniture_can_be_left_out(tmp_path: Path, schema: str) -> None:
    scene = two_storeys(schema=schema)
    kind = "IfcFurnishingElement" if schema == "IFC2X3" else "IfcFurniture"
    scene.box(kind, "table", scene.file.by_type("IfcBuildingStorey")[0], (4, 2, 0), (1, 1, 0.7))
    model = load_model(scene.write(tmp_path / "house.ifc"), LoadOptions(furniture=False))
    assert sorted(part.name for part in model.parts) == ["floor 0", "floor 1", "wall", "window"]


def test_ignore_drops_by_name_and_by_class(tmp_path: Path) -> None:
    path = two_storeys().write(tmp_path / "house.ifc")
    model = load_model(path, LoadOptions(ignore="^chair$|IfcWindow|IfcSpace"))
    assert sorted(part.name for part in model.parts) == ["floor 0", "floor 1", "wall"]
    assert model.spaces == ()


@pytest.mark.parametrize("unit", ["metre", "millimetre"])
def test_far_building_is_moved_near_and_keeps_its_millimetres(tmp_path: Path, unit: str) -> None:
    origin = (3_512_345.678, 5_412_345.123, 432.1)
    near = load_model(two_storeys().write(tmp_path / "near.ifc"))
    far = load_model(two_storeys(unit=unit, origin=origin).write(tmp_path / "far.ifc"))
    assert np.abs(far.vertices).max() < 1000
    assert np.array_equal(far.offset_m, np.round(far.offset_m)) and far.offset_m[2] == 0.0
    np.testing.assert_allclose(far.vertices + far.offset_m, near.vertices + np.array(origin), atol=1e-6)
    np.testing.assert_allclose(far.doors[0].centre + far.offset_m, near.doors[0].centre + np.array(origin), atol=1e-6)
    assert far.storeys[1].elevation_m == pytest.approx(432.1 + 3.0)


def test_far_coordinates_inside_the_shapes_keep_their_millimetres(tmp_path: Path) -> None:
    scene = IfcScene()
    storey = scene.storey("Ground", 0.0)
    slab = scene.box("IfcSlab", "floor", storey, (0, 0, 0), (6, 4, 0.2))
    slab.Representation.Representations[0].Items[0].Position = scene.axes((3_512_345.678, 5_412_345.123, 0))
    model = load_model(scene.write(tmp_path / "far.ifc"))
    low = model.vertices.min(axis=0) + model.offset_m
    np.testing.assert_allclose(low, [3_512_345.678, 5_412_345.123, 0], atol=1e-5)
    np.testing.assert_allclose(np.ptp(model.vertices, axis=0), [6, 4, 0.2], atol=1e-5)


def test_mapped_items_are_placed_at_every_product(tmp_path: Path) -> None:
    scene = IfcScene()
    storey = scene.storey("Ground", 0.0)
    origin = scene.make(
        "IfcRepresentationMap", MappingOrigin=scene.axes((0, 0, 0)), MappedRepresentation=scene.box_shape((1, 1, 1))
    )
    for i in range(3):
        column = scene.box("IfcColumn", f"column {i}", storey, (10.0 * i, 0, 0), (1, 1, 1))
        target = scene.make("IfcCartesianTransformationOperator3D", LocalOrigin=scene.point(0, 0, 0), Scale=1.0)
        item = scene.make("IfcMappedItem", MappingSource=origin, MappingTarget=target)
        column.Representation.Representations[0].Items = [item]
        column.Representation.Representations[0].RepresentationType = "MappedRepresentation"
    model = load_model(scene.write(tmp_path / "columns.ifc"))
    assert [part.n_faces for part in model.parts] == [12, 12, 12]
    np.testing.assert_allclose(np.ptp(model.vertices, axis=0), [21, 1, 1])


def test_pieces_of_a_door_are_left_out_with_it(tmp_path: Path) -> None:
    scene = two_storeys()
    storey = scene.file.by_type("IfcBuildingStorey")[0]
    door = scene.box("IfcDoor", "gate", storey, (3, 0, 0), (1, 0.1, 2))
    leaf = scene.box("IfcPlate", "leaf", storey, (3, 0, 0), (1, 0.05, 2))
    for relation in list(leaf.ContainedInStructure):
        scene.file.remove(relation)
    scene.aggregate(door, leaf)
    model = load_model(scene.write(tmp_path / "house.ifc"))
    assert "leaf" not in {part.name for part in model.parts}
    assert {door.name for door in model.doors} == {"front door", "gate"}


def test_storeys_that_are_all_placed_at_zero_take_their_declared_elevation(tmp_path: Path) -> None:
    scene = two_storeys(unit="millimetre")
    for storey in scene.file.by_type("IfcBuildingStorey"):
        storey.ObjectPlacement.RelativePlacement = scene.axes((0, 0, 0))
    model = load_model(scene.write(tmp_path / "house.ifc"))
    assert [s.elevation_m for s in model.storeys] == pytest.approx([0.0, 3.0])


@pytest.mark.parametrize("name", ["IFC2X_FINAL", "IFC2X3_TC1"])
def test_old_names_of_the_schema_are_read_as_ifc2x3(tmp_path: Path, name: str) -> None:
    path = two_storeys(schema="IFC2X3").write(tmp_path / "new.ifc")
    old = tmp_path / "old.ifc"
    old.write_text(path.read_text().replace("FILE_SCHEMA(('IFC2X3'))", f"FILE_SCHEMA(('{name}'))"))
    assert name in old.read_text()
    np.testing.assert_array_equal(load_model(old).vertices, load_model(path).vertices)


def test_zipped_ifc_is_read(tmp_path: Path) -> None:
    path = two_storeys().write(tmp_path / "house.ifc")
    zipped = tmp_path / "house.ifczip"
    with zipfile.ZipFile(zipped, "w") as archive:
        archive.write(path, "house.ifc")
    np.testing.assert_array_equal(load_model(zipped).faces, load_model(path).faces)


@pytest.mark.parametrize("encoding", ["utf-8", "latin-1"])
def test_raw_umlauts_in_names_are_read(tmp_path: Path, encoding: str) -> None:
    path = two_storeys().write(tmp_path / "house.ifc")
    path.write_bytes(path.read_text().replace("'chair'", "'Büro'").encode(encoding))
    assert "Büro" in {part.name for part in load_model(path).parts}


def test_unknown_schema_is_refused_with_the_known_ones(tmp_path: Path) -> None:
    path = two_storeys().write(tmp_path / "house.ifc")
    path.write_text(path.read_text().replace("'IFC4'", "'IFC4X1'"))
    with pytest.raises(BuildingError, match=r"schema 'IFC4X1' cannot be read; .*IFC2X3, IFC4"):
        load_model(path)


def test_cut_short_file_is_refused(tmp_path: Path) -> None:
    path = two_storeys().write(tmp_path / "house.ifc")
    path.write_bytes(path.read_bytes()[:-200])
    with pytest.raises(BuildingError, match="cut short"):
        load_model(path)


def test_file_without_products_is_refused(tmp_path: Path) -> None:
    with pytest.raises(BuildingError, match="no triangles"):
        load_model(IfcScene().write(tmp_path / "empty.ifc"))


def test_unreadable_geometry_is_named(tmp_path: Path) -> None:
    scene = two_storeys()
    scene.file.by_type("IfcWindow")[0].Representation.Representations[0].Items[0].SweptArea.XDim = -1.0
    model = load_model(scene.write(tmp_path / "house.ifc"))
    assert "window" not in {part.name for part in model.parts}
    assert any("'window'" in warning for warning in model.warnings)


def test_engine_writes_nothing_to_the_terminal(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    scene = two_storeys()
    scene.file.by_type("IfcSlab")[0].Representation.Representations[0].Items[0].Depth = 0.0
    load_model(scene.write(tmp_path / "house.ifc"))
    assert capfd.readouterr() == ("", "")


def test_override_of_the_unit_beats_the_file(tmp_path: Path) -> None:
    path = two_storeys(unit="millimetre").write(tmp_path / "house.ifc")
    model = load_model(path, LoadOptions(units_m=0.002))
    np.testing.assert_allclose(np.ptp(model.vertices, axis=0), [12, 8, 6.4])
    assert model.storeys[1].elevation_m == pytest.approx(6.0)


def test_file_without_a_length_unit_is_taken_in_metres_and_says_so(tmp_path: Path) -> None:
    scene = two_storeys()
    scene.file.remove(scene.file.by_type("IfcUnitAssignment")[0])
    path = scene.write(tmp_path / "house.ifc")
    model = load_model(path)
    np.testing.assert_allclose(np.ptp(model.vertices, axis=0), [6, 4, 3.2])
    assert any("metres are assumed" in warning for warning in model.warnings)
    assert load_model(path, LoadOptions(units_m=0.5)).vertices.max() == pytest.approx(3.0)


def test_space_without_name_or_storey_is_kept(tmp_path: Path) -> None:
    scene = two_storeys()
    space = scene.file.by_type("IfcSpace")[0]
    space.Name = space.LongName = None
    scene.file.remove(space.Decomposes[0])
    (found,) = load_model(scene.write(tmp_path / "house.ifc")).spaces
    assert found.name == f"IfcSpace #{space.id()}" and (found.long_name, found.storey) == ("", "")


def test_wrong_types_in_a_damaged_file_are_refused(tmp_path: Path) -> None:
    path = two_storeys().write(tmp_path / "house.ifc")
    text = path.read_text()
    wall = next(line for line in text.splitlines() if "=IFCWALL(" in line)
    placement = wall.split(",")[5]
    path.write_text(text.replace(wall, wall.replace(wall.split(",")[6], placement)))
    with pytest.raises(BuildingError, match="damaged"):
        load_model(path)
