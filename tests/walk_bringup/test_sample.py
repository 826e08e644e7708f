# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The sample building: the stored file, what stands in it, and that a walker gets everywhere."""

from __future__ import annotations

import itertools
import os
import subprocess
import sys
import types
from pathlib import Path
from typing import Any

import ifcopenshell
import ifcopenshell.geom
import ifcopenshell.util.element
import ifcopenshell.validate
import numpy as np
import pytest
import trimesh

from walk_bringup.sample import location, make_sample, plan, sample_path
from walk_bringup.sample.circulation import RISERS, TREAD
from walk_bringup.sample.rooms import rooms
from walk_bringup.sample.walls import walls
from walk_building.building import Building
from walk_building.model import LoadOptions
from walk_building.pipeline import load_building


@pytest.fixture(scope="module")
def stored() -> Any:
    return ifcopenshell.open(sample_path())


@pytest.fixture(scope="module")
def meshes(stored: Any) -> dict[str, tuple[Any, trimesh.Trimesh]]:
    settings = ifcopenshell.geom.settings()
    settings.set("use-world-coords", True)
    found = {}
    for shape in ifcopenshell.geom.iterate(settings, stored):
        vertices, faces = np.reshape(shape.geometry.verts, (-1, 3)), np.reshape(shape.geometry.faces, (-1, 3))
        found[shape.guid] = (stored.by_guid(shape.guid), trimesh.Trimesh(vertices, faces, process=False))
    return found


@pytest.fixture(scope="module")
def building() -> Building:
    return load_building(sample_path())


def test_stored_file_is_what_the_script_makes(tmp_path: Path) -> None:
    made = make_sample(tmp_path / "another name.ifc")
    assert made.read_bytes() == sample_path().read_bytes(), "run python -m walk_bringup.sample and store its file"


def test_command_writes_the_same_bytes_whatever_the_hash_seed(tmp_path: Path) -> None:
    output = tmp_path / "made.ifc"
    environment = {**os.environ, "PYTHONHASHSEED": "12345", "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    command = [sys.executable, "-m", "walk_bringup.sample", str(output)]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True, timeout=60)
    assert str(output) in done.stdout
    assert output.read_bytes() == sample_path().read_bytes()


def test_command_says_in_a_sentence_where_it_cannot_write(tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    command = [sys.executable, "-m", "walk_bringup.sample", str(tmp_path / "nowhere" / "made.ifc")]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 2
    assert "nowhere" in done.stderr and "Traceback" not in done.stderr


# The validator leaves the file of its rules open.
@pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning")
def test_file_keeps_the_rules_of_its_schema(stored: Any) -> None:
    logger = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(stored, logger, express_rules=True)
    assert logger.statements == []


def test_every_element_is_named_and_belongs_to_a_storey_or_a_whole(stored: Any) -> None:
    for element in stored.by_type("IfcElement"):
        assert element.Name
        if not element.is_a("IfcOpeningElement"):
            assert ifcopenshell.util.element.get_container(element) is not None, element
    identities = [root.GlobalId for root in stored.by_type("IfcRoot")]
    assert len(set(identities)) == len(identities)


def test_building_holds_what_the_sample_has_to_show(stored: Any) -> None:
    count = {kind: len(stored.by_type(kind)) for kind in ("IfcBuildingStorey", "IfcStair", "IfcRamp", "IfcRoof")}
    assert count == {"IfcBuildingStorey": 2, "IfcStair": 1, "IfcRamp": 1, "IfcRoof": 1}
    names = {space.LongName for space in stored.by_type("IfcSpace")}
    assert {"Column hall", "Gallery", "Ramp", "Stair"} <= names
    assert len(names) == len(stored.by_type("IfcSpace")) == len(rooms()) >= 8
    openings = [opening for wall in walls() for opening in wall.openings]
    assert len(stored.by_type("IfcDoor")) == sum(opening.kind == "door" for opening in openings) >= 8
    assert len(stored.by_type("IfcWindow")) > sum(opening.kind == "window" for opening in openings)  # and skylights
    assert len([c for c in stored.by_type("IfcColumn") if c.Name.startswith("Column")]) == len(plan.COLUMNS) >= 8
    assert len(stored.by_type("IfcFurniture")) > 50
    assert all(ifcopenshell.util.element.get_types(described) for described in stored.by_type("IfcTypeProduct"))


def test_file_stays_small(meshes: dict[str, tuple[Any, trimesh.Trimesh]]) -> None:
    assert sample_path().stat().st_size < 600_000
    assert sum(len(mesh.faces) for element, mesh in meshes.values() if element.is_a("IfcElement")) < 30_000


def test_ramp_and_stair_keep_what_is_walked_with_ease() -> None:
    for upper in (False, True):
        line = plan.ramp_lane(upper)
        slopes = [abs(b[1] - a[1]) / (b[0] - a[0]) for a, b in itertools.pairwise(line)]
        assert sum(slope == 0 for slope in slopes) == 1  # the rest
        assert all(1 / 12 <= slope <= 1 / 8 for slope in slopes if slope)
    riser = plan.RISE / (2 * RISERS)
    assert riser <= 0.17
    assert 0.59 <= 2 * riser + TREAD <= 0.65  # the rule of the step


def test_openings_lie_in_their_walls_and_do_not_meet() -> None:
    for wall in walls():
        along = 0 if wall.high[0] - wall.low[0] >= wall.high[1] - wall.low[1] else 1
        at = wall.low[along]
        for opening in sorted(wall.openings, key=lambda opening: opening.at):
            assert opening.at - opening.width / 2 > at, (wall.name, opening)
            at = opening.at + opening.width / 2
            assert wall.foot + opening.sill + opening.height < wall.top
            assert opening.kind != "door" or opening.width >= 0.9
        assert at <= wall.high[along]


def test_a_point_lies_in_one_room_at_most(meshes: dict[str, tuple[Any, trimesh.Trimesh]]) -> None:
    points = np.random.default_rng(1).uniform((0, 0, 0), (plan.LENGTH, plan.DEPTH, plan.ROOF), (4000, 3))
    spaces = [mesh for element, mesh in meshes.values() if element.is_a("IfcSpace")]
    upwards = np.tile((0.0, 0.0, 1.0), (len(points), 1))
    holders = np.zeros(len(points), dtype=int)
    for space in spaces:
        _, ray = space.ray.intersects_id(points, upwards, multiple_hits=True)
        holders += np.bincount(ray, minlength=len(points)) % 2
    assert holders.max() == 1
    assert (holders == 1).mean() > 0.6  # and the rooms fill most of the house


def test_every_room_is_reached_on_both_storeys(building: Building) -> None:
    assert len(building.rooms) == len(rooms())
    assert [(room.name, room.reason) for room in building.rooms if not room.reachable] == []
    assert {room.storey for room in building.rooms} == {0, 1}


def test_no_place_of_the_tour_is_outside(building: Building) -> None:
    places = building.surface.places[building.reachable]
    assert np.all(places[:, :2] > 0.0) and np.all(places[:, :2] < (plan.LENGTH, plan.DEPTH))
    assert np.all(places[:, 2] >= -0.01) and np.all(places[:, 2] <= plan.RISE + 0.01)


@pytest.mark.parametrize("missing", ["^IfcStairFlight$", "^IfcRampFlight$"])
def test_stair_and_ramp_each_join_the_storeys_alone(missing: str) -> None:
    building = load_building(sample_path(), LoadOptions(ignore=missing))
    storeys = {room.storey for room in building.rooms if room.reachable}
    assert storeys == {0, 1}


def test_storeys_are_apart_without_stair_and_ramp() -> None:
    building = load_building(sample_path(), LoadOptions(ignore="^Ifc(Stair|Ramp)Flight$"))
    assert len({room.storey for room in building.rooms if room.reachable}) == 1


def test_path_is_found_in_an_installed_share_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    installed = tmp_path / "share" / "walk_bringup"
    (installed / "buildings").mkdir(parents=True)
    (installed / "buildings" / "sample.ifc").write_text("x", encoding="ascii")
    packages = types.ModuleType("ament_index_python.packages")
    packages.get_package_share_directory = lambda name: str(tmp_path / "share" / name)  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "ament_index_python", types.ModuleType("ament_index_python"))
    monkeypatch.setitem(sys.modules, "ament_index_python.packages", packages)
    monkeypatch.setattr(location, "__file__", str(tmp_path / "a" / "b" / "c" / "location.py"))
    assert location.sample_path() == installed / "buildings" / "sample.ifc"


def test_missing_sample_is_said_with_the_way_to_make_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(location, "__file__", str(tmp_path / "a" / "b" / "c" / "location.py"))
    monkeypatch.setitem(sys.modules, "ament_index_python.packages", None)
    with pytest.raises(FileNotFoundError, match=r"python -m walk_bringup\.sample"):
        location.sample_path()
