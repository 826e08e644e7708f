# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk export` as a user calls it."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest
import trimesh
from rcl_interfaces.msg import ParameterEvent
from rclpy.parameter import Parameter
from scenes import two_rooms

from walk_bag import BagTopic, BagWriter
from walk_bag.bag_reader import read_bag
from walk_bag.imports import recorded_building
from walk_bag.parameter_watch import TOPIC as PARAMETERS
from walk_bag.walkthrough import bag_topic
from walk_bringup.cli.main import main
from walk_building.loaders import load_model
from walk_building.model import LoadOptions
from walk_building.pipeline import building_hash
from walk_building.walker import Walker
from walk_ros import conversions as c
from walk_ros.diagnostics import Diagnostics
from walk_ros.raw import to_bytes

STAMP = 1_700_000_000_000_000_000


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    """Two seconds along x."""

    class Walk:
        t_s = np.array([0.0, 2.0])
        positions = np.array([[1.0, 2.0, 1.6], [3.0, 2.0, 1.6]])
        quat_xyzw = np.array([[0.0, 0.0, 0.0, 1.0]] * 2)
        velocities = accelerations = np.zeros((2, 3))

    with BagWriter(tmp_path / "tour.mcap") as writer:
        writer.write(bag_topic("trajectory"), STAMP, to_bytes(c.trajectory_to_msg(Walk(), STAMP)))
    return tmp_path / "tour.mcap"


def rows(path: Path) -> np.ndarray:
    return np.loadtxt(path, delimiter=",", skiprows=1)


def test_without_a_building_it_says_where_positions_are(bag: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", str(bag), "--to", "csv"]) == 0
    assert "near the origin; --building FILE" in capsys.readouterr().out
    assert rows(bag.with_name("tour-csv.csv"))[-1, :4] == pytest.approx([2.0, 3.0, 2.0, 1.6])


def test_the_report_beside_the_bag_tells_where_the_building_stands(bag: Path) -> None:
    facts = {"building": {"file": "rooms.ply", "offset_m": [100.0, 200.0, 300.0]}}
    bag.with_name("report.json").write_text(json.dumps(facts))
    assert main(["export", str(bag), "--to", "csv", "--out", str(bag.with_name("x.csv"))]) == 0
    assert rows(bag.with_name("x.csv"))[0, 1:4] == pytest.approx([101.0, 202.0, 301.6])


def test_the_building_that_is_named_stands_beside_the_camera(bag: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = bag.with_name("rooms.ply")
    trimesh.util.concatenate(two_rooms()).export(file)
    assert main(["export", str(bag), "--to", "glb", "--building", str(file)]) == 0
    assert "note" not in capsys.readouterr().out
    assert "Building" in trimesh.load(bag.with_name("tour-glb.glb")).graph.nodes_geometry


def test_another_building_than_the_planned_one_is_noticed(bag: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = bag.with_name("rooms.ply")
    trimesh.util.concatenate(two_rooms()).export(file)
    facts = {"building": {"file": "rooms.ply", "content_hash": "other", "offset_m": [0.0, 0.0, 0.0]}}
    bag.with_name("report.json").write_text(json.dumps(facts))
    assert main(["export", str(bag), "--to", "glb", "--building", str(file)]) == 0
    assert "is not what the walk was planned in" in capsys.readouterr().out


def name_building(bag: Path, file: Path, options: LoadOptions) -> None:
    """Puts into the bag what a plan tells of its building."""
    told = Diagnostics("/walk/plan")
    told.building(str(file), "abc")
    told.note(content_hash=load_model(file, options).content_hash, load=json.dumps(dataclasses.asdict(options)),
              offset_m="[10.0, 0.0, 0.0]")  # fmt: skip
    messages = list(read_bag(bag))
    with BagWriter(bag) as writer:
        writer.write(bag_topic("/diagnostics"), STAMP, to_bytes(told.to_msg(STAMP)))
        for message in messages:
            writer.write(message.topic, message.stamp_ns, message.data)


def test_a_bag_that_names_its_building_needs_no_other_word(bag: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = bag.with_name("rooms.ply")
    trimesh.util.concatenate(two_rooms()).export(file)
    name_building(bag, file, LoadOptions(units_m=0.5))
    assert main(["export", str(bag), "--to", "glb"]) == 0
    assert "note" not in capsys.readouterr().out
    width = np.ptp(trimesh.load(bag.with_name("tour-glb.glb")).geometry["Building"].bounds, axis=0)[0]
    assert width == pytest.approx(0.5 * np.ptp(trimesh.load(file).bounds, axis=0)[0])


def test_a_building_that_was_changed_or_is_gone_is_said(bag: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = bag.with_name("rooms.ply")
    trimesh.util.concatenate(two_rooms()).export(file)
    name_building(bag, file, LoadOptions())
    trimesh.util.concatenate(two_rooms()[:-1]).export(file)
    assert main(["export", str(bag), "--to", "glb"]) == 0
    assert "is not what the walk was planned in" in capsys.readouterr().out
    file.unlink()
    assert main(["export", str(bag), "--to", "glb"]) == 0
    assert "is not there any more; --building FILE shows it" in capsys.readouterr().out
    assert main(["export", str(bag), "--to", "csv"]) == 0
    assert rows(bag.with_name("tour-csv.csv"))[0, 1] == pytest.approx(11.0)


def name_building_as_nodes_do(bag: Path, file: Path, options: LoadOptions) -> None:
    """Puts into the bag what a recorder hears of a running graph: diagnostics and the nodes' parameters."""
    told = Diagnostics("walk/sequencer")
    told.building(str(file), building_hash(load_model(file, options), options, Walker()))
    shared = {"load": options, "walker": Walker()}
    values = {f"{g}.{n}": v for g, config in shared.items() for n, v in dataclasses.asdict(config).items()}
    event = ParameterEvent(
        node="/walk/sequencer", new_parameters=[Parameter(n, value=v).to_parameter_msg() for n, v in values.items()]
    )
    watched = BagTopic(
        name=PARAMETERS, type_name="rcl_interfaces/msg/ParameterEvent", latched=False, reliable=True, depth=1000
    )
    messages = list(read_bag(bag))
    with BagWriter(bag) as writer:
        writer.write(watched, STAMP, to_bytes(event))
        writer.write(bag_topic("/diagnostics"), STAMP, to_bytes(told.to_msg(STAMP)))
        for message in messages:
            writer.write(message.topic, message.stamp_ns, message.data)


def test_a_recorded_session_is_exported_with_the_load_options_it_was_run_with(
    bag: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = bag.with_name("rooms.ply")
    trimesh.util.concatenate(two_rooms()).export(file)
    name_building_as_nodes_do(bag, file, LoadOptions(units_m=0.5))
    named = recorded_building(bag)
    assert named.load == LoadOptions(units_m=0.5) and named.walker == Walker()
    assert main(["export", str(bag), "--to", "glb"]) == 0
    assert "note" not in capsys.readouterr().out
    width = np.ptp(trimesh.load(bag.with_name("tour-glb.glb")).geometry["Building"].bounds, axis=0)[0]
    assert width == pytest.approx(0.5 * np.ptp(trimesh.load(file).bounds, axis=0)[0])
    # What the command line says goes before, and is noticed; so is another file.
    assert main(["export", str(bag), "--to", "glb", "--units", "m"]) == 0
    assert "or was loaded otherwise" in capsys.readouterr().out
    trimesh.util.concatenate(two_rooms()[:-1]).export(file)
    assert main(["export", str(bag), "--to", "glb"]) == 0
    assert "is not what the walk was planned in" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--to", "mp4"], "--building"),
        (["--to", "csv", "--from", "viewpoint"], "holds no viewpoint"),
        (["--to", "keypoints-json"], "holds none"),
        (["--to", "blender", "--fps", "0"], "fps is 0"),
        (["--to", "glb", "--building", "missing.ifc"], "missing.ifc"),
        (["--to", "avi"], "is not one of"),
    ],
)
def test_what_cannot_be_is_one_sentence_and_exit_code_2(
    bag: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], said: str
) -> None:
    assert main(["export", str(bag), *arguments]) == 2
    message = capsys.readouterr().err
    assert said in message and message.startswith("walk: ") and message.count("\n") == 1
    assert [path.name for path in bag.parent.iterdir()] == ["tour.mcap"]
