# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Every example runs on a building that is not the sample, and says what it promises."""

import csv
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from graph.rooms import make_rooms

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


@pytest.fixture(scope="module")
def rooms(tmp_path_factory):
    return make_rooms(tmp_path_factory.mktemp("examples") / "rooms.ply")


def run(name, *arguments, folder):
    env = dict(os.environ, PYTHONPATH=os.pathsep.join(p for p in sys.path if p), MPLBACKEND="agg")
    command = [sys.executable, str(EXAMPLES / name), *map(str, arguments)]
    return subprocess.run(command, cwd=folder, env=env, capture_output=True, text=True, timeout=120)


def said(name, *arguments, folder):
    done = run(name, *arguments, folder=folder)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_stage_1_lists_rooms(rooms, tmp_path):
    text = said("1_building.py", rooms, folder=tmp_path)
    assert text.startswith("rooms.ply: ")
    assert len(re.findall(r"m²  reachable", text)) >= 3


def test_stage_2_draws_the_map(rooms, tmp_path):
    text = said("2_importance.py", rooms, folder=tmp_path)
    errors = [float(e) for e in re.findall(r"visibility: ([\d.]+)", text)]
    assert len(errors) > 1
    assert errors[-1] == min(errors)
    assert (tmp_path / "out" / "importance.png").stat().st_size > 5000


def test_stage_3_lists_keypoints(rooms, tmp_path):
    assert len(re.findall(r"importance [\d.]+", said("3_keypoints.py", rooms, folder=tmp_path))) >= 3


def test_stage_4_compares_orders(rooms, tmp_path):
    text = said("4_tour.py", rooms, folder=tmp_path)
    lengths = [float(x) for x in re.findall(r"^\w+: ([\d.]+) m$", text, re.MULTILINE)]
    assert len(lengths) == 2
    assert lengths[0] <= lengths[1]


def test_stage_5_touches_nothing_and_follows_a_hand(rooms, tmp_path):
    text = said("5_trajectory.py", rooms, folder=tmp_path)
    assert re.search(r"^0 of \d+ segments touch", text, re.MULTILINE)
    assert re.search(r"keypoint 1 moved in [\d.]+ ms", text)


def test_a_folder_of_buildings_becomes_a_table(rooms, tmp_path):
    folder = tmp_path / "buildings"
    folder.mkdir()
    (folder / "good.ply").write_bytes(rooms.read_bytes())
    (folder / "bad.stl").write_text("not a mesh")
    (folder / "notes.txt").write_text("no building")
    said("batch.py", folder, tmp_path / "out", folder=tmp_path)
    with (tmp_path / "out" / "table.csv").open(encoding="utf-8") as table:
        rows = {row["building"]: row for row in csv.DictReader(table)}
    assert set(rows) == {"good.ply", "bad.stl"}
    assert rows["good.ply"]["colliding"] == "0"
    assert int(rows["good.ply"]["entered"]) >= 3
    assert "bad.stl" in rows["bad.stl"]["problem"]
    assert (tmp_path / "out" / "good" / "report.html").exists()


@pytest.mark.parametrize("arguments", [[], ["{folder}"]])
def test_a_batch_of_nothing_says_so(arguments, tmp_path):
    done = run("batch.py", *(a.format(folder=tmp_path) for a in arguments), folder=tmp_path)
    assert done.returncode == 1
    assert "Traceback" not in done.stderr
    assert "folder" in done.stderr or "no building" in done.stderr
