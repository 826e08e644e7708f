# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What was recorded or exported is read again."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from walk_bag import BagError, BagWriter
from walk_bag.errors import ExportError
from walk_bag.exports import export_ride
from walk_bag.exports.ride import Ride
from walk_bag.imports import RecordedBuilding, load_ride, recorded_building
from walk_bag.keypoint_files import read_keypoints
from walk_bag.walkthrough import bag_topic
from walk_ros import conversions as c
from walk_ros.diagnostics import Diagnostics
from walk_ros.raw import to_bytes

STAMP = 1_700_000_000_000_000_000


def a_ride(samples: int = 21) -> Ride:
    rng = np.random.default_rng(4)
    quat = Rotation.from_rotvec(np.outer(np.linspace(0.0, 7.0, samples), [0, 0, 1])).as_quat()
    positions = rng.normal(size=(samples, 3))
    positions[10:14] = positions[10]
    stop = np.zeros(samples, bool)
    stop[11:13] = True
    return Ride(
        t_s=np.linspace(0.0, 2.0, samples), positions=positions, quat_xyzw=quat, stop=stop,
        keypoints=rng.normal(size=(3, 3)), keypoint_quat_xyzw=Rotation.random(3, random_state=1).as_quat(),
        offset_m=np.array([7.0, 8.0, 9.0]),
    )  # fmt: skip


def write_bag(path: Path, ride: Ride, topics: tuple[str, ...] = ("trajectory", "viewpoint", "keypoints")) -> None:
    class Moving:
        t_s, positions, quat_xyzw = ride.t_s, ride.positions, ride.quat_xyzw
        velocities = accelerations = np.zeros_like(ride.positions)

    with BagWriter(path) as writer:
        if "keypoints" in topics:
            msg = c.keypoints_to_msg(ride.keypoints, ride.keypoint_quat_xyzw, STAMP)
            writer.write(bag_topic("keypoints"), STAMP, to_bytes(msg))
        if "trajectory" in topics:
            writer.write(bag_topic("trajectory"), STAMP, to_bytes(c.trajectory_to_msg(Moving(), STAMP)))
        for t, p, q in zip(ride.t_s, ride.positions, ride.quat_xyzw, strict=True):
            if "viewpoint" in topics:
                at = STAMP + round(t * 1e9)
                writer.write(bag_topic("viewpoint"), at, to_bytes(c.viewpoint_to_msg(p, q, at)))


@pytest.mark.parametrize("source", ["trajectory", "viewpoint"])
def test_a_recorded_camera_path_is_read_back(tmp_path: Path, source: str) -> None:
    ride = a_ride()
    write_bag(tmp_path / "tour.mcap", ride)
    again = load_ride(tmp_path / "tour.mcap", source)
    np.testing.assert_allclose(again.t_s, ride.t_s, atol=1e-9)
    np.testing.assert_array_equal(again.positions, ride.positions)
    turn = Rotation.from_quat(again.quat_xyzw) * Rotation.from_quat(ride.quat_xyzw).inv()
    np.testing.assert_allclose(turn.magnitude(), 0.0, atol=1e-7)
    assert (np.einsum("ij,ij->i", again.quat_xyzw[1:], again.quat_xyzw[:-1]) > 0).all()
    np.testing.assert_array_equal(again.stop, ride.stop)
    np.testing.assert_array_equal(again.keypoints, ride.keypoints)


@pytest.mark.parametrize("name", ["keypoints-csv", "keypoints-json"])
def test_keypoints_go_out_and_come_back(tmp_path: Path, name: str) -> None:
    ride = a_ride()
    path = tmp_path / f"k.{name.rpartition('-')[2]}"
    export_ride(ride, name, path)
    again = read_keypoints(path)
    np.testing.assert_allclose(again.positions, ride.keypoints + ride.offset_m, atol=1e-6)
    np.testing.assert_allclose(again.quat_xyzw, ride.keypoint_quat_xyzw, atol=1e-6)


def test_a_table_made_by_hand_is_read(tmp_path: Path) -> None:
    path = tmp_path / "k.csv"
    path.write_text("label, x, y, z, yaw_deg, remark\nhall, 1, 2, 1.6, 90, nice\n, 3, 4, 1.6, ,\n")
    found = read_keypoints(path)
    assert found.positions.tolist() == [[1, 2, 1.6], [3, 4, 1.6]] and found.labels == ("hall", "")
    assert found.looks.tolist() == [True, False]
    np.testing.assert_allclose(Rotation.from_quat(found.quat_xyzw).apply([1, 0, 0]), [[0, 1, 0], [1, 0, 0]], atol=1e-12)


def test_a_bare_list_of_positions_is_read(tmp_path: Path) -> None:
    path = tmp_path / "k.json"
    path.write_text('[[1, 2, 3], {"position": [4, 5, 6], "label": "b"}]')
    assert read_keypoints(path).positions.tolist() == [[1, 2, 3], [4, 5, 6]]


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("k.csv", "", "is empty; its first line names the columns"),
        ("k.csv", "a;b;c\n1;2;3\n", "no column 'x': its first line reads 'a;b;c'"),
        ("k.csv", "x,y,z\n1,5,2,3\n", "line 2 has more values than the 3 columns"),
        ("k.csv", "x,y,z\n", "holds no keypoint"),
        ("k.csv", "x,y,z\n1,2,nan\n", "line 2: z is 'nan'; expected a finite number"),
        ("k.csv", "x,y,z\n1,2,3\n1,two,3\n", "line 3: y is 'two'"),
        ("k.csv", "x,y,z\n1,2\n", "line 2 has no z"),
        ("k.csv", "x,y,z,qx,qy,qz,qw\n1,2,3,1,1,0,0\n", "length 1.414"),
        ("k.json", "{", "is not JSON"),
        ("k.json", "3", "no list of keypoints"),
        ("k.json", "[[1, 2]]", r"keypoint 1: position is \[1, 2\]; expected 3 finite numbers"),
        ("k.json", "[[1, 2, true]]", r"keypoint 1: position is \[1, 2, true\]"),
        ("k.json", "[[1, 2, 1e999]]", "keypoint 1: position"),
        ("k.json", "[null]", "keypoint 1 has no position"),
        ("k.json", '[{"position": [1, 2, 3], "label": 4}]', "label is 4"),
        ("k.txt", "x,y,z\n1,2,3", "from .csv and .json files and from bags"),
    ],
)
def test_a_bad_file_is_refused_in_a_sentence(tmp_path: Path, name: str, text: str, said: str) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(ExportError, match=said):
        read_keypoints(tmp_path / name)


def test_no_file_and_no_text_are_said(tmp_path: Path) -> None:
    with pytest.raises(ExportError, match="No such file"):
        read_keypoints(tmp_path / "none.csv")
    (tmp_path / "k.json").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ExportError, match="UTF-8"):
        read_keypoints(tmp_path / "k.json")


def test_a_bag_without_a_walk_is_said(tmp_path: Path) -> None:
    write_bag(tmp_path / "k.mcap", a_ride(), ("keypoints",))
    with pytest.raises(BagError, match="holds no trajectory"):
        load_ride(tmp_path / "k.mcap")
    with pytest.raises(
        BagError, match="no viewpoint: nobody played the walk while it was recorded; what was planned is"
    ):
        load_ride(tmp_path / "k.mcap", "viewpoint")


@pytest.mark.parametrize("samples", [1, 5])
def test_a_session_in_which_nobody_moved_is_said(tmp_path: Path, samples: int) -> None:
    ride = a_ride()
    still = dataclasses.replace(
        ride, t_s=ride.t_s[:samples], positions=np.zeros((samples, 3)), quat_xyzw=np.tile([0, 0, 0, 1.0], (samples, 1))
    )
    write_bag(tmp_path / "k.mcap", still, ("viewpoint",))
    with pytest.raises(BagError, match="no viewpoint that moves: nobody played"):
        load_ride(tmp_path / "k.mcap", "viewpoint")


def test_the_building_is_read_from_the_diagnostics(tmp_path: Path) -> None:
    told = Diagnostics("/walk/trajopt")
    told.building("/data/house.ifc", "abc")
    with BagWriter(tmp_path / "d.mcap") as writer:
        writer.write(bag_topic("/diagnostics"), STAMP, to_bytes(told.to_msg(STAMP)))
    assert recorded_building(tmp_path / "d.mcap") == RecordedBuilding(path="/data/house.ifc", hash="abc")
    write_bag(tmp_path / "k.mcap", a_ride())
    assert recorded_building(tmp_path / "k.mcap") == RecordedBuilding()


def test_the_json_of_keypoints_is_plain(tmp_path: Path) -> None:
    export_ride(a_ride(), "keypoints-json", tmp_path / "k.json")
    assert set(json.loads((tmp_path / "k.json").read_text())["keypoints"][0]) == {"position", "quat_xyzw"}
