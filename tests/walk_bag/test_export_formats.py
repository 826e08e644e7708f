# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What is exported says where the eye is and where it looks, as other programs read it."""

from __future__ import annotations

import dataclasses
import importlib
import json
import re
import subprocess
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import imageio_ffmpeg
import numpy as np
import pytest
import pyvista
import trimesh
import yaml
from pxr import Gf, Usd, UsdGeom
from scenes import box, model_of, two_rooms
from scipy.spatial.transform import Rotation
from trajectory_msgs.msg import MultiDOFJointTrajectory
from vtkmodules.vtkCommonCore import vtkLogger
from vtkmodules.vtkIOImport import vtkGLTFImporter
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow

from walk_bag.errors import ExportError
from walk_bag.exports import EXPORTERS, export_ride
from walk_bag.exports.look import coloured
from walk_bag.exports.renderer import Renderer
from walk_bag.exports.ride import ExportConfig, Ride
from walk_building import Model, Part
from walk_building.errors import ParameterError
from walk_ros import conversions as c
from walk_ros.raw import from_bytes, to_bytes

OFFSET = np.array([500.0, -300.0, 20.0])
FPS = 10.0
CONFIG = ExportConfig(fps=FPS, width=160, height=120)


def yaw(angles: list[float]) -> np.ndarray:
    return Rotation.from_rotvec(np.outer(np.deg2rad(angles), [0, 0, 1])).as_quat()


def rooms() -> Model:
    """Two rooms and a door, and a red box at the far end, which is a part of its own."""
    model = model_of([*two_rooms(), box((7.4, 1.0, 0.0), (8.0, 3.0, 2.0))])
    wall = Part(name="walls", kind="IfcWall", first_face=0, n_faces=len(model.faces) - 12)
    box_part = Part(name="box", kind="IfcFurniture", first_face=len(model.faces) - 12, n_faces=12)
    return dataclasses.replace(model, parts=(wall, box_part))


@pytest.fixture(scope="module")
def ride() -> Ride:
    """From one room into the other in 3 s, a stop, and a turn to the north."""
    return Ride(
        t_s=np.array([0.0, 3.0, 4.0, 4.5]),
        positions=np.array([[1.0, 2.0, 1.6], [6.0, 2.0, 1.6], [6.0, 2.0, 1.6], [6.0, 2.0, 1.6]]),
        quat_xyzw=yaw([0.0, 0.0, 0.0, 90.0]),
        stop=np.array([False, True, True, True]),
        keypoints=np.array([[1.0, 2.0, 1.6], [6.0, 2.0, 1.6]]),
        keypoint_quat_xyzw=yaw([0.0, 90.0]),
        offset_m=OFFSET,
        model=rooms(),
        building_name="rooms.ifc",
        building_hash="abc",
    )


@pytest.fixture(scope="module")
def written(ride: Ride, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Every format."""
    folder = tmp_path_factory.mktemp("exports")
    paths = {name: folder / f"{name}{exporter.suffix}" for name, exporter in EXPORTERS.items()}
    for name, path in paths.items():
        export_ride(ride, name, path, CONFIG)
    return paths


def test_every_format_writes_one_file_and_nothing_beside_it(written: dict[str, Path]) -> None:
    (folder,) = {path.parent for path in written.values()}
    assert sorted(folder.iterdir()) == sorted(written.values())
    assert all(path.stat().st_size > 100 for path in written.values())


def test_two_other_loaders_open_the_glb(written: dict[str, Path], ride: Ride) -> None:
    scene = trimesh.load(written["glb"])
    assert {"Wall", "Furniture", "Path", "Keypoint 1", "Keypoint 2"} <= set(scene.graph.nodes_geometry)
    assert scene.geometry["Wall"].faces.shape[0] + scene.geometry["Furniture"].faces.shape[0] == len(ride.model.faces)
    blocks = pyvista.read(written["glb"]).combine()
    low, high = ride.model.vertices.min(axis=0), ride.model.vertices.max(axis=0)
    assert blocks.bounds == pytest.approx((low[0], high[0], low[2], high[2], -high[1], -low[1]), abs=1e-4)


def test_another_programs_player_moves_the_camera_of_the_glb(written: dict[str, Path]) -> None:
    """VTK's importer plays the animation; it shares nothing with what wrote it."""
    window, scene = vtkRenderWindow(), vtkRenderer()
    window.AddRenderer(scene)
    player = vtkGLTFImporter()
    player.SetFileName(str(written["glb"]))
    player.SetRenderWindow(window)
    player.SetCamera(0)
    player.Update()
    assert (player.GetNumberOfCameras(), player.GetNumberOfAnimations()) == (1, 1)
    player.EnableAnimation(0)
    for t_s, eye, look in (
        (0.0, (1, 2, 1.6), (1, 0, 0)),
        (1.5, (3.5, 2, 1.6), (1, 0, 0)),
        (3.5, (6, 2, 1.6), (1, 0, 0)),
        (4.5, (6, 2, 1.6), (0, 1, 0)),
    ):
        player.UpdateAtTimeValue(t_s)
        camera = scene.GetActiveCamera()
        assert camera.GetPosition() == pytest.approx((eye[0], eye[2], -eye[1]), abs=1e-5)
        assert camera.GetDirectionOfProjection() == pytest.approx((look[0], look[2], -look[1]), abs=1e-5)
        assert camera.GetViewUp() == pytest.approx((0, 1, 0), abs=1e-5)
    assert np.deg2rad(camera.GetViewAngle()) == pytest.approx(CONFIG.field_of_view_rad, abs=1e-5)


def test_the_usd_camera_is_where_the_eye_is_and_looks_where_it_looks(written: dict[str, Path]) -> None:
    stage = Usd.Stage.Open(str(written["usd"]))
    assert UsdGeom.GetStageUpAxis(stage) == "Z" and UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode(), stage.GetTimeCodesPerSecond()) == (0, 45, FPS)
    camera = UsdGeom.Camera.Get(stage, "/Walk/Eye")
    for frame, eye, look in ((0, (1, 2, 1.6), (1, 0, 0)), (15, (3.5, 2, 1.6), (1, 0, 0)), (45, (6, 2, 1.6), (0, 1, 0))):
        matrix = camera.ComputeLocalToWorldTransform(frame)
        assert tuple(matrix.ExtractTranslation()) == pytest.approx(eye, abs=1e-6)
        assert tuple(matrix.TransformDir(Gf.Vec3d(0, 0, -1))) == pytest.approx(look, abs=1e-6)
        assert tuple(matrix.TransformDir(Gf.Vec3d(0, 1, 0))) == pytest.approx((0, 0, 1), abs=1e-6)
    lens = camera.GetCamera(0)
    assert np.deg2rad(lens.GetFieldOfView(Gf.Camera.FOVVertical)) == pytest.approx(CONFIG.field_of_view_rad, abs=1e-5)
    counts = [len(UsdGeom.Mesh(p).GetFaceVertexCountsAttr().Get()) for p in stage.Traverse() if p.IsA(UsdGeom.Mesh)]
    assert sum(counts) == len(rooms().faces)


def test_the_xml_path_is_in_the_files_coordinates_with_y_up(written: dict[str, Path]) -> None:
    root = ET.parse(written["enscape"]).getroot()
    frames = root.findall("Keyframes/Keyframe")
    assert root.tag == "VideoPath" and root.find("Keyframes").get("count") == str(len(frames))
    t_s = np.array([float(frame.get("timestampSeconds")) for frame in frames])
    assert t_s[0] == 0.0 and t_s[-1] == 4.5 and np.diff(t_s).max() <= 0.2 + 1e-6
    vectors = [[[float(frame.find(tag).get(a)) for a in "xyz"] for tag in ("Position", "LookAt")] for frame in frames]
    assert vectors[0] == pytest.approx(np.array([[501.0, 21.6, 298.0], [1, 0, 0]]), abs=1e-5)
    assert vectors[-1] == pytest.approx(np.array([[506.0, 21.6, 298.0], [0, 0, -1]]), abs=1e-5)


def test_the_blender_frames_look_along_the_cameras_minus_z(written: dict[str, Path]) -> None:
    document = json.loads(written["blender"].read_text())
    frames = document["frames"]
    assert [f["frame"] for f in frames] == list(range(1, 47)) and document["fps"] == FPS
    quat = np.array([f["rotation_quaternion"] for f in frames])[:, [1, 2, 3, 0]]
    looks = Rotation.from_quat(quat).apply([0, 0, -1])
    assert looks[[0, -1]] == pytest.approx(np.array([[1, 0, 0], [0, 1, 0]]), abs=1e-6)
    assert frames[15]["location"] == pytest.approx(np.array([3.5, 2, 1.6]) + OFFSET, abs=1e-5)


def test_the_yaml_is_the_message_with_its_speeds(written: dict[str, Path], ride: Ride) -> None:
    message = yaml.safe_load(written["ros"].read_text())
    assert message["header"]["frame_id"] == "map" and message["joint_names"] == ["eye"]
    assert len(message["points"]) == len(ride.t_s)
    last = message["points"][-1]
    assert last["time_from_start"] == {"sec": 4, "nanosec": 500_000_000}
    assert last["transforms"][0]["translation"] == {"x": 6.0, "y": 2.0, "z": 1.6}
    assert message["points"][0]["velocities"][0]["linear"]["x"] == pytest.approx(5 / 3)


def filled(message: Any, values: Any) -> Any:
    """Returns a message with the values of a YAML document, as `ros2 topic pub` fills it; unknown names are errors."""
    for name, value in values.items():
        field = getattr(message, name)
        if isinstance(value, dict):
            filled(field, value)
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            (kind,) = re.findall(r"<(\w+)/(\w+)>", message.get_fields_and_field_types()[name])
            made = getattr(importlib.import_module(f"{kind[0]}.msg"), kind[1])
            setattr(message, name, [filled(made(), item) for item in value])
        else:
            setattr(message, name, value)
    return message


def test_the_yaml_becomes_the_message_again(written: dict[str, Path], ride: Ride) -> None:
    msg = filled(MultiDOFJointTrajectory(), yaml.safe_load(written["ros"].read_text()))
    again = c.trajectory_from_msg(from_bytes(to_bytes(msg), "trajectory_msgs/msg/MultiDOFJointTrajectory"))
    np.testing.assert_allclose(again.t_s, ride.t_s, atol=1e-9)
    np.testing.assert_allclose(again.positions, ride.positions, atol=1e-6)
    np.testing.assert_allclose(again.quat_xyzw, ride.quat_xyzw, atol=1e-6)


def test_the_video_has_the_length_of_the_walk_and_shows_what_lies_ahead(written: dict[str, Path]) -> None:
    frames, seconds = imageio_ffmpeg.count_frames_and_secs(str(written["mp4"]))
    assert frames == 46 and seconds == pytest.approx(46 / FPS, abs=0.02)
    # Not through its reader, which leaves its pipes open.
    decode = [imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", "-i", str(written["mp4"])]
    raw = subprocess.run([*decode, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"], capture_output=True, check=True).stdout
    pictures = np.frombuffer(raw, np.uint8).reshape(46, 120, 160, 3).astype(float)
    # The box is the only brown thing: unseen from the west room but through the door, before the eye at the stop.
    brown = [float(((p[..., 0] - p[..., 2]) > 25).mean()) for p in pictures]
    assert brown[35] > 0.15 > brown[0] and brown[45] < 0.01
    assert all(picture.std() > 3 for picture in pictures), "nothing is drawn"


def test_a_video_is_made_without_a_word_of_the_coder(
    ride: Ride, tmp_path: Path, capfd: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    # Of pictures this large the coder would say that they are too few to tell how many come a second.
    export_ride(ride, "mp4", tmp_path / "a.mp4", ExportConfig(fps=1, width=1920, height=1080))
    # Nor what it thinks of a video that was not finished.
    with pytest.raises(ZeroDivisionError):
        export_ride(ride, "mp4", tmp_path / "b.mp4", CONFIG, lambda stage, fraction: 1 / 0)
    assert capfd.readouterr() == ("", "") and not caplog.records


def test_progress_of_a_video_rises_to_the_end(ride: Ride, tmp_path: Path) -> None:
    told: list[float] = []
    export_ride(ride, "mp4", tmp_path / "a.mp4", ExportConfig(fps=2, width=64, height=64),
                lambda stage, fraction: told.append(fraction))  # fmt: skip
    assert told == sorted(told) and told[-1] == 1.0 and len(told) == 10


def test_smooth_edges_are_drawn_where_they_are_asked_for(ride: Ride) -> None:
    found = {}
    for samples in (1, 4):
        with Renderer(ride.model, dataclasses.replace(CONFIG, samples=samples)) as renderer:
            (picture,) = renderer.pictures(ride.positions[:1], ride.quat_xyzw[:1])
        found[samples] = len(np.unique(picture.reshape(-1, 3), axis=0))
    assert found[4] > 1.2 * found[1]


def test_a_face_has_the_light_of_the_way_it_is_turned() -> None:
    part = Part(name="box", kind="IfcWall", first_face=0, n_faces=12)
    solid, glass = coloured(dataclasses.replace(model_of([box((0, 0, 0), (1, 1, 1))]), parts=(part,)))
    faces = solid.corners.reshape(-1, 3, 3)
    normals = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]).round(6)
    shades = {tuple(n): tuple(c) for n, c in zip(normals, solid.rgb[::3].tolist(), strict=True)}
    assert len(shades) == 6 == len(set(shades.values())) and len(glass.corners) == 0
    assert shades[0.0, 0.0, 1.0] > shades[0.0, 0.0, -1.0]


def test_the_renderer_leaves_the_librarys_messages_as_they_were(ride: Ride) -> None:
    before = vtkLogger.GetCurrentVerbosityCutoff()
    with Renderer(ride.model, CONFIG) as renderer:
        list(renderer.pictures(ride.positions[:1], ride.quat_xyzw[:1]))
    assert vtkLogger.GetCurrentVerbosityCutoff() == before


def test_a_ride_without_a_building_is_a_camera_alone(ride: Ride, tmp_path: Path) -> None:
    alone = dataclasses.replace(ride, model=None)
    for name in set(EXPORTERS) - {"mp4"}:
        export_ride(alone, name, tmp_path / f"{name}{EXPORTERS[name].suffix}", CONFIG)
    assert "Wall" not in trimesh.load(tmp_path / "glb.glb").graph.nodes_geometry
    with pytest.raises(ExportError, match="--building"):
        export_ride(alone, "mp4", tmp_path / "a.mp4", CONFIG)


@pytest.mark.parametrize("name", sorted(EXPORTERS))
def test_someone_who_stands_still_is_exported_too(ride: Ride, name: str, tmp_path: Path) -> None:
    still = dataclasses.replace(
        ride, t_s=ride.t_s[:1], positions=ride.positions[:1], quat_xyzw=ride.quat_xyzw[:1], stop=ride.stop[:1]
    )
    path = tmp_path / f"still{EXPORTERS[name].suffix}"
    export_ride(still, name, path, CONFIG)
    assert path.stat().st_size > 0


@pytest.mark.parametrize("name", sorted(EXPORTERS))
def test_a_file_that_cannot_be_written_is_said_in_a_sentence(ride: Ride, name: str, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(ExportError, match="cannot be written"):
        export_ride(ride, name, tmp_path / "file" / f"x{EXPORTERS[name].suffix}", CONFIG)


def test_what_no_video_can_be_is_refused(ride: Ride, tmp_path: Path) -> None:
    with pytest.raises(ExportError, match="even"):
        export_ride(ride, "mp4", tmp_path / "a.mp4", ExportConfig(width=101, height=100))
    with pytest.raises(ParameterError, match="fps"):
        ExportConfig(fps=0.0)
    with pytest.raises(ExportError, match="there are glb"):
        export_ride(ride, "avi", tmp_path / "a.avi")
    with pytest.raises(ExportError, match="holds none"):
        export_ride(dataclasses.replace(ride, keypoints=np.empty((0, 3))), "keypoints-csv", tmp_path / "k.csv")
    assert list(tmp_path.iterdir()) == []
