# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import ast
import json
import runpy
import sys
import types
from pathlib import Path
from typing import Any

import pytest
import yaml

from walk_bringup.cli.up import NODES, keypoint_params

SHARE = Path(__file__).resolve().parents[2] / "src" / "walk_bringup"
LAUNCH = (SHARE / "launch" / "walk.launch.py").read_text(encoding="utf-8")


def _calls(name: str) -> list[ast.Call]:
    calls = (node for node in ast.walk(ast.parse(LAUNCH)) if isinstance(node, ast.Call))
    return [call for call in calls if isinstance(call.func, ast.Name) and call.func.id == name]


def test_launch_file_describes_every_argument() -> None:
    declared = {
        call.args[0].value: {keyword.arg for keyword in call.keywords}
        for call in _calls("DeclareLaunchArgument")
        if isinstance(call.args[0], ast.Constant)
    }
    assert set(declared) == {
        *("building", "keypoints_file", "namespace", "params_file", "log_level", "use_sim_time", "respawn"),
        *("port", "lan", "viewer_port", "parent_frame", "pose"),
    }
    assert all("description" in keywords and "default_value" in keywords for keywords in declared.values())


def test_launch_file_uses_only_arguments_it_declares() -> None:
    used = {call.args[0].value for call in _calls("LaunchConfiguration") if isinstance(call.args[0], ast.Constant)}
    declared = {
        call.args[0].value for call in _calls("DeclareLaunchArgument") if isinstance(call.args[0], ast.Constant)
    }
    assert used == declared


def test_launch_file_starts_the_nodes_that_up_starts() -> None:
    assignments = (node for node in ast.parse(LAUNCH).body if isinstance(node, ast.Assign))
    nodes = next(node.value for node in assignments if getattr(node.targets[0], "id", "") == "NODES")
    assert ast.literal_eval(nodes) == NODES


class _Made(dict[str, Any]):
    """What stands for a class of launch: its arguments, by name or in a row."""

    def __init__(self, *row: Any, **named: Any) -> None:
        super().__init__(named, row=row)

    def perform(self, context: dict[str, str]) -> str:
        return context.get(self["row"][0], "")


def _launched(monkeypatch: pytest.MonkeyPatch, **arguments: str) -> dict[str, dict[str, Any]]:
    """Returns the parameters that the launch file sets by itself, by node; launch is no Python wheel."""
    names = ("LaunchContext", "LaunchDescription", "DeclareLaunchArgument", "OpaqueFunction", "LaunchConfiguration")
    made = dict.fromkeys((*names, "PathJoinSubstitution", "Node", "ParameterValue", "FindPackageShare"), _Made)
    for module in ("actions", "substitutions"):
        monkeypatch.setitem(sys.modules, f"launch.{module}", types.SimpleNamespace(**made))
    for module in ("launch", "launch_ros", *(f"launch_ros.{m}" for m in ("actions", "substitutions"))):
        monkeypatch.setitem(sys.modules, module, types.SimpleNamespace(**made))
    monkeypatch.setitem(sys.modules, "launch_ros.parameter_descriptions", types.SimpleNamespace(**made))
    values = runpy.run_path(str(SHARE / "launch" / "walk.launch.py"))
    values["generate_launch_description"]()
    nodes = values["_nodes"](arguments)
    return {node["name"]: {k: v for part in node["parameters"][2:] for k, v in part.items()} for node in nodes}


def test_keypoints_of_a_file_begin_a_session_as_with_up(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    file = tmp_path / "mine.csv"
    file.write_text("x,y,z\n1,2,1.6\n")
    told = _launched(monkeypatch, keypoints_file=str(file))
    assert told["importance"]["keypoints_file"]["row"] == (str(file),)
    assert told["sequencer"].pop("editing.session_start_s") > 1.7e9
    asked = (param.partition("=") for param in keypoint_params(file) if param.startswith("sequencer."))
    assert told["sequencer"] == {name.removeprefix("sequencer."): value != "false" for name, _, value in asked}
    # Without a file, what a parameter file says of it counts.
    assert _launched(monkeypatch)["sequencer"] == {}


def test_rviz_shows_topics_of_the_table() -> None:
    from walk_ros.topics import TOPICS, absolute_name

    layout = yaml.safe_load((SHARE / "rviz" / "walk.rviz").read_text(encoding="utf-8"))
    shown = [display["Topic"] for display in layout["Visualization Manager"]["Displays"] if "Topic" in display]
    table = {absolute_name(name): topic.qos for name, topic in TOPICS.items()}
    assert shown
    for topic in shown:
        durability = table[topic["Value"]].durability.name.replace("_", " ").title()
        assert topic["Durability Policy"] == durability, topic["Value"]


def test_rviz_shows_every_topic_that_it_has_a_display_for() -> None:
    from walk_ros.topics import TOPICS, absolute_name, type_name

    kinds = {"PointCloud2", "OccupancyGrid", "PoseArray", "MarkerArray", "Path", "PoseStamped"}
    drawn = {absolute_name(name) for name, spec in TOPICS.items() if type_name(spec.type).rpartition("/")[2] in kinds}
    layout = yaml.safe_load((SHARE / "rviz" / "walk.rviz").read_text(encoding="utf-8"))
    shown = {d["Topic"]["Value"] for d in layout["Visualization Manager"]["Displays"] if "Topic" in d}
    # The markers of the keypoints show the same places, with names and marks.
    assert drawn - shown == {absolute_name("keypoints")}


def test_rviz_edits_keypoints_under_the_name_of_the_editor() -> None:
    from walk_ros.editor import FEEDBACK, SERVICE, UPDATE
    from walk_ros.topics import absolute_name

    layout = yaml.safe_load((SHARE / "rviz" / "walk.rviz").read_text(encoding="utf-8"))
    displays = layout["Visualization Manager"]["Displays"]
    (editor,) = [d for d in displays if d["Class"] == "rviz_default_plugins/InteractiveMarkers"]
    # RViz adds the names of the protocol itself.
    names = [
        f"{editor['Interactive Markers Namespace']}/{n}" for n in ("update", "feedback", "get_interactive_markers")
    ]
    assert names == [absolute_name(name) for name in (UPDATE, FEEDBACK, SERVICE)]
    assert editor["Enabled"]
    assert "rviz_default_plugins/Interact" in [tool["Class"] for tool in layout["Visualization Manager"]["Tools"]]


def test_foxglove_shows_topics_of_the_table_and_every_panel_it_lays_out() -> None:
    from walk_ros.topics import TOPICS, absolute_name

    layout = json.loads((SHARE / "foxglove" / "walk.json").read_text(encoding="utf-8"))
    table = {absolute_name(name) for name in TOPICS}
    assert set(layout["configById"]["3D!walk"]["topics"]) <= table
    assert layout["configById"]["RawMessages!answers"]["topicPath"] in table

    def panels(node: Any) -> set[str]:
        return {node} if isinstance(node, str) else panels(node["first"]) | panels(node["second"])

    assert panels(layout["layout"]) == set(layout["configById"])
