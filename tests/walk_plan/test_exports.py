# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What is written can be read back, by other programs too, and says the same."""

from __future__ import annotations

import dataclasses
import html
import json
import re
import struct
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from walk_bag.exports.axes import camera_quat_xyzw, to_gltf
from walk_bag.exports.glb import write_glb
from walk_bag.exports.resample import resample
from walk_bag.exports.shapes import tube
from walk_bag.exports.trajectory_csv import write_trajectory_csv
from walk_bag.imports import recorded_building
from walk_plan.drawing.floor import storey_bounds
from walk_plan.options import plan_config, plan_options
from walk_plan.outputs import ride_of, write_tour_bag
from walk_plan.pipeline import make_walkthrough
from walk_plan.report import write_report
from walk_plan.stages import StageClock
from walk_plan.summary import as_plain, summary
from walk_plan.walkthrough import Walkthrough


@pytest.fixture(scope="module")
def far_away(walkthrough: Walkthrough) -> Walkthrough:
    """The same plan of a building that stands far from the origin of its file."""
    model = dataclasses.replace(walkthrough.building.model, offset_m=np.array([5e5, 4e6, 120.0]))
    return dataclasses.replace(walkthrough, building=dataclasses.replace(walkthrough.building, model=model))


def test_csv_has_the_poses_of_the_trajectory_in_the_files_own_coordinates(
    far_away: Walkthrough, tmp_path: Path
) -> None:
    path = tmp_path / "trajectory.csv"
    write_trajectory_csv(path, ride_of(far_away))
    assert path.read_text().splitlines()[0] == "t,x,y,z,qx,qy,qz,qw,stop"
    table = np.loadtxt(path, delimiter=",", skiprows=1)
    trajectory = far_away.trajectory
    at = np.searchsorted(table[:, 0], trajectory.t_s - 1e-4)
    expected = trajectory.positions + [5e5, 4e6, 120.0]
    assert table[at, 1:4] == pytest.approx(expected, abs=1e-4)
    same = np.abs(np.einsum("ij,ij->i", table[at, 4:8], trajectory.quat_xyzw))
    assert same == pytest.approx(np.ones(len(at)), abs=1e-6)


def test_csv_rows_are_at_most_a_tenth_of_a_second_apart_and_rise(walkthrough: Walkthrough, tmp_path: Path) -> None:
    path = tmp_path / "trajectory.csv"
    sparse = {
        field.name: getattr(walkthrough.trajectory, field.name)[::40]
        for field in dataclasses.fields(walkthrough.trajectory)
    }
    write_trajectory_csv(
        path,
        dataclasses.replace(
            ride_of(walkthrough), **{k: v for k, v in sparse.items() if k in ("t_s", "positions", "quat_xyzw", "stop")}
        ),
    )
    table = np.loadtxt(path, delimiter=",", skiprows=1)
    steps = np.diff(table[:, 0])
    assert steps.min() > 0.0 and steps.max() <= 0.1
    assert np.linalg.norm(table[:, 4:8], axis=1) == pytest.approx(np.ones(len(table)), abs=1e-6)


def test_samples_between_lie_on_the_straight_line_that_was_checked(walkthrough: Walkthrough) -> None:
    trajectory = walkthrough.trajectory
    fine = resample(trajectory, 0.005)
    assert np.isin(trajectory.t_s, fine.t_s).all()
    assert np.diff(fine.t_s).max() <= 0.005 + 1e-12
    k = np.clip(np.searchsorted(trajectory.t_s, fine.t_s, side="right") - 1, 0, len(trajectory.t_s) - 2)
    a, b = trajectory.positions[k], trajectory.positions[k + 1]
    off = np.linalg.norm(np.cross(fine.positions - a, b - a), axis=1) / np.maximum(np.linalg.norm(b - a, axis=1), 1e-9)
    assert off.max() < 1e-6
    assert np.einsum("ij,ij->i", fine.quat_xyzw[1:], fine.quat_xyzw[:-1]).min() > 0.9


def parts_of_glb(path: Path) -> tuple[dict[str, object], bytes]:
    data = path.read_bytes()
    magic, version, length = struct.unpack("<III", data[:12])
    assert (magic, version, length) == (0x46546C67, 2, len(data))
    size, kind = struct.unpack("<II", data[12:20])
    assert kind == 0x4E4F534A
    return json.loads(data[20 : 20 + size]), data[28 + size :]


def array_of(document: dict, binary: bytes, index: int) -> NDArray[np.float32]:
    accessor = document["accessors"][index]
    view = document["bufferViews"][accessor["bufferView"]]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
    return np.frombuffer(binary, "<f4", accessor["count"] * width, view["byteOffset"]).reshape(-1, width)


def test_another_programs_loader_finds_building_path_and_keypoints_in_the_glb(
    walkthrough: Walkthrough, tmp_path: Path
) -> None:
    path = tmp_path / "walkthrough.glb"
    write_glb(path, ride_of(walkthrough))
    scene = trimesh.load(path)
    meshes = {name: scene.geometry[scene.graph[name][1]] for name in scene.graph.nodes_geometry}
    building = walkthrough.building.geometry
    found = sum(len(mesh.faces) for name, mesh in meshes.items() if not name.startswith(("Keypoint", "Path")))
    assert found == len(building.faces)
    low, high = to_gltf(building.bounds)[:, [0, 1]].min(axis=0), building.bounds[1, 2]
    assert scene.bounds[0, :2] == pytest.approx(low, abs=1e-5) and scene.bounds[1, 1] == pytest.approx(high, abs=1e-5)
    assert sum(name.startswith("Keypoint") for name in meshes) == len(walkthrough.keypoints)
    for number, keypoint in enumerate(to_gltf(walkthrough.keypoints), start=1):
        assert scene.graph[f"Keypoint {number}"][0][:3, 3] == pytest.approx(keypoint, abs=1e-5)
    assert meshes["Path"].is_watertight


def test_the_camera_of_the_glb_walks_and_looks_as_the_trajectory(walkthrough: Walkthrough, tmp_path: Path) -> None:
    path = tmp_path / "walkthrough.glb"
    write_glb(path, ride_of(walkthrough))
    document, binary = parts_of_glb(path)
    (animation,) = document["animations"]
    channels = {
        channel["target"]["path"]: animation["samplers"][channel["sampler"]] for channel in animation["channels"]
    }
    node = document["nodes"][animation["channels"][0]["target"]["node"]]
    assert "camera" in node
    t = array_of(document, binary, channels["translation"]["input"])[:, 0]
    positions = array_of(document, binary, channels["translation"]["output"])
    turns = Rotation.from_quat(array_of(document, binary, channels["rotation"]["output"]))
    trajectory = walkthrough.trajectory
    assert t[0] == 0.0 and t[-1] == pytest.approx(trajectory.t_s[-1] - trajectory.t_s[0], abs=1e-4)
    assert positions[[0, -1]] == pytest.approx(to_gltf(trajectory.positions[[0, -1]]), abs=1e-4)
    # A camera of glTF looks along its -z axis; the walker along its x axis, with z up.
    looks = turns.apply([0.0, 0.0, -1.0])[[0, -1]]
    ahead = Rotation.from_quat(trajectory.quat_xyzw[[0, -1]]).apply([1.0, 0.0, 0.0])
    assert looks == pytest.approx(to_gltf(ahead), abs=1e-5)
    assert (turns.apply([0.0, 1.0, 0.0])[:, 1] > 0.9).all()


def test_a_level_look_north_is_no_rotation_of_a_gltf_camera() -> None:
    north = np.array([[0.0, 0.0, np.sin(np.pi / 4), np.cos(np.pi / 4)]])
    assert np.abs(camera_quat_xyzw(north)[0]) == pytest.approx([0.0, 0.0, 0.0, 1.0], abs=1e-12)


def test_tube_is_closed_and_has_the_volume_of_a_prism() -> None:
    bend = np.array([[0.0, 0, 0], [2, 0, 0], [4, 0, 0], [4, 2, 1], [4, 4, 2]])
    vertices, faces = tube(bend, 0.1, sides=24)
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    assert mesh.is_watertight and mesh.is_winding_consistent
    straight = trimesh.Trimesh(*tube(np.array([[0.0, 0, 0], [1, 0, 0], [3, 0, 0]]), 0.1, sides=24), process=False)
    assert straight.volume == pytest.approx(3.0 * 12 * 0.1**2 * np.sin(2 * np.pi / 24), rel=1e-6)


class Collector(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.words: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data: str) -> None:
        self.words.append(data)


def test_report_is_one_file_that_names_every_room_and_asks_for_nothing(
    walkthrough: Walkthrough, tmp_path: Path
) -> None:
    path = tmp_path / "report.html"
    write_report(path, walkthrough, summary(walkthrough))
    page = path.read_text(encoding="utf-8")
    collector = Collector()
    collector.feed(page)
    text = " ".join(collector.words)
    assert not re.search(r'(src|href)="(?!data:)', page) and "http" not in re.sub(r"base64,[^\"]*", "", page)
    pictures = [attrs for tag, attrs in collector.tags if tag == "img"]
    assert len(pictures) == 3 and all(attrs["alt"] for attrs in pictures)
    for room in walkthrough.building.rooms:
        assert room.name in text
    for word in ("collisions", "Length", "Rooms entered", "Curve through the viewpoints", "Order by spanning tree"):
        assert word in text
    assert not re.search(r"\bnan\b|None", text)


def test_the_plan_for_a_wide_walker_shows_the_whole_storey_and_lists_every_room(
    walkthrough: Walkthrough, rooms_file: Path, tmp_path: Path
) -> None:
    wide = make_walkthrough(rooms_file, plan_config({"radius": 0.6}), StageClock(lambda stage, fraction: None))
    for ours, usual in zip(storey_bounds(wide.building, 0), storey_bounds(walkthrough.building, 0), strict=True):
        np.testing.assert_allclose(ours, usual, atol=0.11)
    assert len(wide.visits) == len(walkthrough.visits) == 2
    write_report(tmp_path / "report.html", wide, summary(wide))
    assert "The way there is too narrow for a walker 1.2 m wide" in (tmp_path / "report.html").read_text("utf-8")


def test_every_setting_in_the_report_has_a_meaning_and_a_unit(walkthrough: Walkthrough, tmp_path: Path) -> None:
    write_report(tmp_path / "report.html", walkthrough, summary(walkthrough))
    page = html.unescape((tmp_path / "report.html").read_text("utf-8"))
    for name, value in (("radius", "0.25 m"), ("max slope", "40°"), ("speed", "1.4 m/s"), ("begin", "entrance")):
        (option,) = (option for option in plan_options() if option.name == name.replace(" ", "-"))
        assert f"<dt>{name}<small>{option.field.metadata['doc']}</small></dt><dd>{value}</dd>" in page


def test_report_escapes_what_the_building_brings(walkthrough: Walkthrough, tmp_path: Path) -> None:
    evil = "<script>alert(1)</script>"
    named = dataclasses.replace(walkthrough, warnings=(evil,))
    write_report(tmp_path / "report.html", named, summary(named))
    assert evil not in (tmp_path / "report.html").read_text(encoding="utf-8")


def test_summary_is_json_with_every_figure(walkthrough: Walkthrough) -> None:
    again = json.loads(json.dumps(summary(walkthrough), allow_nan=False))
    ours = again["quality"][0]
    assert ours["name"] == "ours" and ours["length_m"] == pytest.approx(walkthrough.quality.length_m)
    assert {"ours", "spline", "mst_dfs"} <= {quality["name"] for quality in again["quality"]}
    assert again["building"]["hash"] == walkthrough.building.hash
    assert again["config"]["walker"]["radius_m"] == 0.25
    assert [keypoint["number"] for keypoint in again["keypoints"]] == list(range(1, len(walkthrough.keypoints) + 1))
    assert {"load", "importance", "tour", "trajectory"} <= set(again["stages_s"])
    assert again["peak_memory_mib"] > 10


def test_what_is_not_finite_becomes_null() -> None:
    value = {"a": np.float32("nan"), "b": (np.int64(3), float("inf")), "c": np.array([[1.5]])}
    assert as_plain(value) == {"a": None, "b": [3, None], "c": [[1.5]]}


def test_the_bag_of_a_plan_names_its_building(far_away: Walkthrough, tmp_path: Path) -> None:
    write_tour_bag(tmp_path / "tour.mcap", far_away)
    named = recorded_building(tmp_path / "tour.mcap")
    model = far_away.building.model
    assert Path(named.path) == model.source.resolve() and named.hash == far_away.building.hash
    assert named.content_hash == model.content_hash and named.load == far_away.config.load
    assert named.offset_m == pytest.approx(model.offset_m)
