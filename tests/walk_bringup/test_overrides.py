# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What `./walk up` is asked for is checked before any node starts: one sentence and the code 2."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NoReturn

import pytest
import trimesh
import yaml

from walk_bringup.bootstrap.errors import SetupError
from walk_bringup.cli import up as command
from walk_bringup.cli.main import main
from walk_bringup.cli.overrides import overrides_yaml, read_params_file
from walk_bringup.cli.up import NODES, start_configs
from walk_bringup.parameters import NODE_TEXTS, parameters_yaml
from walk_trajopt.config import TimingConfig
from walk_vr_bridge.config import BridgeConfig

SOURCES = Path(__file__).resolve().parents[2] / "src"


@pytest.fixture
def refused(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    """Returns the one sentence with which `./walk up` refuses its arguments, having started nothing."""

    def none_started(*_: object) -> NoReturn:
        raise AssertionError("a node was started")

    monkeypatch.setattr(command.Supervisor, "start", none_started)

    def say(*arguments: str) -> str:
        assert main(["up", "--port", "0", *arguments]) == 2
        said = capsys.readouterr().err
        assert said.startswith("walk: ") and said.count("\n") == 1
        return said

    return say


def test_parameters_go_to_the_node_they_name_with_their_types() -> None:
    given = (
        *("trajopt.timing.speed_mps=1.0", "trajopt.trajopt.points=40", "trajopt.use_sim_time=true"),
        *("importance.load.ignore=a=b", "importance.load.furniture=false", "importance.keypoints_file=1"),
    )
    entries = yaml.safe_load(overrides_yaml(given, ["importance", "trajopt"]))
    read = {node: entry["ros__parameters"] for node, entry in entries.items()}
    assert read == {
        "/**/trajopt": {"timing.speed_mps": 1.0, "trajopt.points": 40, "use_sim_time": True},
        "/**/importance": {"load.ignore": "a=b", "load.furniture": False, "keypoints_file": "1"},
    }


def test_a_whole_number_is_one_where_the_config_wants_a_float_or_a_text() -> None:
    given = ("trajopt.timing.speed_mps=1", "trajopt.load.ignore=123")
    ((_, entry),) = yaml.safe_load(overrides_yaml(given, ["trajopt"])).items()
    values = entry["ros__parameters"]
    assert isinstance(values["timing.speed_mps"], float) and values["load.ignore"] == "123"


@pytest.mark.parametrize(
    ("param", "said"),
    [
        ("importance.keypoints.cone_radius=3", r"did you mean keypoints\.cone_radius_m\?"),
        ("trajopt.timng.speed_mps=1.0", r"did you mean timing\.speed_mps\?"),
        ("sequencer.stat_dir=here", r"did you mean state_dir\?"),
    ],
)
def test_a_misspelt_parameter_is_told_with_the_right_name(param: str, said: str) -> None:
    with pytest.raises(SetupError, match=said):
        overrides_yaml((param,), list(NODES))


@pytest.mark.parametrize("param", ["speed", "trajopt=1", "nobody.x=1", "trajopt.x=", ".x=1"])
def test_parameters_that_do_not_read_are_refused(param: str) -> None:
    with pytest.raises(SetupError, match="--param"):
        overrides_yaml((param,), ["trajopt"])


@pytest.mark.parametrize(
    ("param", "said"),
    [
        ("trajopt.timing.speed_mps=nan", "speed_mps is nan; expected a finite number from 0.05 to 3 m/s"),
        ("trajopt.timing.speed_mps=99", "speed_mps is 99.0"),
        ("trajopt.timing.speed_mps=fast", "speed_mps is 'fast'"),
        ("trajopt.trajopt.points=3.5", "points is '3.5'; expected a whole number"),
        ("trajopt.trajopt.points=1", "points is 1; expected 0, or at least 2"),
        ("trajopt.trajopt.mode=slow", "mode is 'slow'; expected one of"),
        ("importance.load.furniture=maybe", "furniture is 'maybe'; expected true or false"),
        ("sequencer.walker.eye_height_m=2.5", "eye_height_m is 2.5; expected at most height_m"),
        ("vr_bridge.bridge.port=99999", "port is 99999"),
    ],
)
def test_a_bad_value_is_refused_before_anything_starts(refused, param: str, said: str) -> None:
    sentence = refused("--param", param)
    assert f"--param {param!r}: {said}" in sentence


def test_of_two_values_the_later_counts_and_rules_are_kept_by_all_together() -> None:
    faster = ("trajopt.timing.speed_mps=9", "trajopt.timing.speed_mps=2.5", "trajopt.timing.max_speed_mps=2.6")
    timing = start_configs(faster, None, "walk")["trajopt"]["timing"]
    assert isinstance(timing, TimingConfig) and timing.speed_mps == 2.5
    with pytest.raises(SetupError, match=r"speed_mps=2'.*at most max_speed_mps, 1 m/s"):
        start_configs(("trajopt.timing.speed_mps=2", "trajopt.timing.max_speed_mps=1"), None, "walk")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("/**/trajopt: {ros__parameters: {timing: {speed_mps: .nan}}}", "timing.speed_mps: speed_mps is nan"),
        ("/**: {ros__parameters: {load: {furniture: 3}}}", "furniture is 3; expected true or false"),
        ("walk: {trajopt: {ros__parameters: {timing.speed: 1.0}}}", "did you mean timing.speed_mps?"),
        ("/**: [1\n", "is no YAML in line 2"),
    ],
)
def test_a_bad_parameter_file_is_refused_before_anything_starts(refused, tmp_path: Path, text: str, said: str) -> None:
    file = tmp_path / "walk.yaml"
    file.write_text(text)
    sentence = refused("--params-file", str(file))
    assert str(file) in sentence and said in sentence


def test_a_parameter_file_is_read_as_ros_reads_it(tmp_path: Path) -> None:
    file = tmp_path / "walk.yaml"
    file.write_text(
        "/**: {ros__parameters: {walker: {radius_m: 0.3}, somebody_elses: 1}}\n"
        "/other/trajopt: {ros__parameters: {timing: {speed_mps: 99}}}\n"
        "/*/trajopt: {ros__parameters: {timing: {speed_mps: 1}}}\n"
        "robot: {ros__parameters: {wheels: 4}}\n"
    )
    configs = start_configs(("vr_bridge.bridge.port=0",), file, "walk")
    timing, bridge = configs["trajopt"]["timing"], configs["vr_bridge"]["bridge"]
    assert isinstance(timing, TimingConfig) and timing.speed_mps == 1.0
    assert isinstance(bridge, BridgeConfig) and bridge.port == 0
    assert {node: str(groups["walker"]) for node, groups in configs.items()} == dict.fromkeys(
        NODES, str(configs["trajopt"]["walker"])
    )
    assert "radius_m=0.3" in str(configs["trajopt"]["walker"])


def test_the_file_that_is_printed_is_taken(tmp_path: Path) -> None:
    file = tmp_path / "walk.yaml"
    file.write_text(parameters_yaml())
    assert len(read_params_file(file, list(NODES), "walk")) > 100
    start_configs((), file, "walk")


@pytest.mark.parametrize("units", ["nan", "-1", "1e9"])
def test_a_unit_that_cannot_be_is_refused_under_its_own_name(refused, units: str) -> None:
    assert "--units is" in (sentence := refused("--units", units)) and "--param" not in sentence


def test_a_file_without_a_unit_that_needs_one_is_refused_once(refused, tmp_path: Path) -> None:
    house = tmp_path / "house.stl"
    trimesh.creation.box(extents=(1000, 800, 300)).export(house)
    assert "the file does not say its unit" in (sentence := refused(str(house))) and "--units" in sentence
    assert "too small to walk in" in refused(str(house), "--units", "0.0001")
    # The parameter says the same as the option, and it may be one node's alone.
    everywhere = [part for node in NODES for part in ("--param", f"{node}.load.units_m=0.01")]
    assert "expected true or false" in refused(str(house), *everywhere, "--param", "trajopt.load.outdoors=2")
    assert "too small to walk in" in refused(str(house), *everywhere, "--param", "trajopt.load.units_m=0.0005")


@pytest.mark.parametrize(("name", "said"), [("house.xyz", "the suffix .xyz is not known"), ("house.ifc", "is empty")])
def test_a_file_that_is_no_building_is_refused(refused, tmp_path: Path, name: str, said: str) -> None:
    (tmp_path / name).touch()
    if name.endswith("xyz"):
        (tmp_path / name).write_text("x")
    assert said in refused(str(tmp_path / name))


@pytest.mark.parametrize("node", NODES)
def test_the_table_of_texts_is_what_the_nodes_declare(node: str) -> None:
    folder = SOURCES / NODES[node] / NODES[node]
    declared = set(re.findall(r'declare_text\(\s*"(\w+)"', (folder / "node.py").read_text(encoding="utf-8")))
    assert declared | {"building"} == set(NODE_TEXTS[node])
