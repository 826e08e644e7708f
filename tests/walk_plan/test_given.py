# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Keypoints that the user brings: out and in again gives the same walk, and what does not fit is said."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from walk_bag.keypoint_files import read_keypoints
from walk_bringup.cli.main import main
from walk_building.walker import Walker
from walk_plan.given import given_suggestion
from walk_plan.options import PlanConfig
from walk_plan.pipeline import make_walkthrough
from walk_plan.stages import StageClock
from walk_plan.walkthrough import Walkthrough

EYE = Walker().eye_height_m


@pytest.fixture(scope="module")
def planned(rooms_file: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A plan of the two rooms on disk."""
    out = tmp_path_factory.mktemp("plan") / "suggested"
    assert main(["plan", str(rooms_file), "--out", str(out), "--quiet"]) == 0
    return out


def camera(folder: Path) -> NDArray[np.float64]:
    return np.loadtxt(folder / "trajectory.csv", delimiter=",", skiprows=1)


@pytest.mark.parametrize("kind", ["keypoints-csv", "keypoints-json", "bag"])
def test_exported_keypoints_give_the_same_walk(planned: Path, rooms_file: Path, tmp_path: Path, kind: str) -> None:
    bag = planned / "tour.mcap"
    file = bag
    if kind != "bag":
        file = tmp_path / f"k.{kind.rpartition('-')[2]}"
        assert main(["export", str(bag), "--to", kind, "--out", str(file), "--quiet"]) == 0
    out = tmp_path / "again"
    arguments = ["--keypoints-file", str(file), "--order", "given", "--quiet"]
    assert main(["plan", str(rooms_file), "--out", str(out), *arguments]) == 0
    ours, theirs = camera(out), camera(planned)
    assert len(ours) == len(theirs)
    np.testing.assert_allclose(ours, theirs, atol=1e-4)


def test_a_recorded_camera_path_is_walked_again(planned: Path, rooms_file: Path, tmp_path: Path) -> None:
    out = tmp_path / "again"
    arguments = ["--camera-path", str(planned / "tour.mcap"), "--quiet"]
    assert main(["plan", str(rooms_file), "--out", str(out), *arguments]) == 0
    ours, theirs = camera(out)[:, 1:4], camera(planned)[:, 1:4]
    assert np.linalg.norm(ours[0] - theirs[0]) < 0.3
    assert np.linalg.norm(ours[-1] - theirs[-1]) < 0.3
    gap = np.linalg.norm(ours[:, None] - theirs[None], axis=2)
    assert max(gap.min(axis=0).max(), gap.min(axis=1).max()) < 0.6
    assert json.loads((out / "report.json").read_text())["config"]["tour"]["method"] == "given"


def test_a_keypoint_without_a_look_gets_the_best_view_and_others_keep_theirs(
    walkthrough: Walkthrough, tmp_path: Path
) -> None:
    file = tmp_path / "k.json"
    backwards = [0.0, 0.0, 1.0, 0.0]
    rows = [{"position": [1.0, 2.0, EYE], "quat_xyzw": backwards}, {"position": [7.0, 2.0, EYE]}]
    file.write_text(json.dumps(rows))
    found = given_suggestion(walkthrough.building, walkthrough.importance_map, read_keypoints(file))
    np.testing.assert_allclose(found.quat_xyzw[0], backwards, atol=1e-9)
    # In the far room the door and the room before it are behind, to -x.
    _, y, z, _ = found.quat_xyzw[1]
    assert 1 - 2 * (y * y + z * z) < 0
    assert found.room[0] != found.room[1] and not found.skipped


def test_what_cannot_be_reached_is_left_out_with_its_name(rooms_file: Path, tmp_path: Path) -> None:
    file = tmp_path / "mine.csv"
    file.write_text(f"x,y,z,label\n1,2,{EYE},sofa\n7,2,{EYE},\n30,2,{EYE},garden\n")
    walk = make_walkthrough(rooms_file, PlanConfig(), StageClock(lambda stage, fraction: None), read_keypoints(file))
    assert len(walk.keypoints) == 2
    (note,) = (warning for warning in walk.warnings if "mine.csv" in warning)
    assert note.startswith("keypoint 3 (garden) of mine.csv at (30.00, 2.00, 1.60) is left out: no floor")


def test_what_is_in_a_wall_is_said_to_be_moved(rooms_file: Path, tmp_path: Path) -> None:
    file = tmp_path / "mine.csv"
    file.write_text(f"x,y,z\n1,2,{EYE}\n7,2,{EYE}\n7,0.02,{EYE}\n7,0.2,{EYE}\n")
    walk = make_walkthrough(rooms_file, PlanConfig(), StageClock(lambda stage, fraction: None), read_keypoints(file))
    (note,) = (warning for warning in walk.warnings if "mine.csv" in warning)
    assert note.startswith("keypoint 3 of mine.csv at (7.00, 0.02, 1.60) is moved by 0."), note


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--keypoints-file", "k.csv", "--keypoints", "3"], "--keypoints-file and --keypoints exclude each other"),
        (["--keypoints-file", "k.csv", "--camera-path", "b"], "--keypoints-file and --camera-path exclude"),
        (["--keypoints-file", "none.csv"], "none.csv: cannot be read: No such file"),
        (["--keypoints-file", "k.csv"], "k.csv: line 2: z is 'high'; expected a finite number"),
        (["--keypoints-file", "k.txt"], "keypoints are read from .csv and .json files and from bags"),
        (["--camera-path", "none.mcap"], "none.mcap: there is no such file"),
        (["--keypoints-file", "one.json"], "walk: one.json: a walk needs at least two keypoints, and there is one"),
        (["--keypoints-file", "far.csv"], "far.csv: a walk needs at least two keypoints that can be reached"),
        (["--radius", "5"], "--radius is 5.0; expected a finite number from 0.05 to 1 m"),
        (["--height", "1.5"], "--eye-height is 1.6; expected at most --height, 1.5 m"),
        (["--start", "99"], "--start is 99; expected the index of one of"),
    ],
)
def test_what_cannot_be_used_is_one_sentence(
    arguments: list[str],
    said: str,
    rooms_file: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("k.csv").write_text("x,y,z\n1,2,high\n")
    Path("k.txt").write_text("1 2 3")
    Path("far.csv").write_text(f"x,y,z\n1,2,{EYE}\n30,2,{EYE}\n")
    Path("one.json").write_text(f"[[1, 2, {EYE}]]")
    assert main(["plan", str(rooms_file), "--out", "o", "--quiet", *arguments]) == 2
    error = capsys.readouterr().err
    assert said in error and error.count("\n") == 1
    assert not Path("o").exists()
