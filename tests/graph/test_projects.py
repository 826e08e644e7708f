# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A graph saved with `./walk save` and opened with `./walk open`, as a user does it, over real DDS."""

import os
import signal
import subprocess
import sys

import numpy as np
import pytest
import yaml
from graph.processes import LIMIT_S, EditKind, Graph, Observer, settled
from graph.test_edits import change, keypoints_of, walked

from walk_bringup.cli.executables import executables
from walk_ros import conversions as c

SET_UP = "importance" in executables("walk_importance")
pytestmark = [pytest.mark.ros, pytest.mark.skipif(not SET_UP, reason="this checkout was not set up by ./walk")]


def walk(graph, *arguments, domain=None):
    """Runs a command of `./walk` to its end; returns code and output."""
    command = [sys.executable, "-m", "walk_bringup.cli", *map(str, arguments)]
    done = subprocess.run(command, env=graph.environment(domain), capture_output=True, text=True, timeout=120)
    return done.returncode, done.stdout + done.stderr


@pytest.fixture(scope="module")
def saved(graph, observer, tmp_path_factory):
    """A project of an edited tour, with what the graph showed when it was saved; the graph has ended."""
    folder = tmp_path_factory.mktemp("projects") / "rooms"
    for name in ("trajopt", "sequencer", "importance"):
        graph.start(name)
    observer.wait_for_all()
    ids = keypoints_of(observer).ids
    assert observer.set_parameter("trajopt", "timing.speed_mps", 0.9).successful
    place = keypoints_of(observer).poses.positions[1] + [0.3, -0.2, 0.0]
    assert observer.edit(EditKind.RELEASE, ids[1], place)().outcome is c.Outcome.ACCEPTED
    for what, keypoint, fields in (
        (c.Change.INSERT, -1, {"position": (10.5, 0.8, 1.6)}),
        (c.Change.DWELL, ids[1], {"argument": "2.5"}),
        (c.Change.LOOK_AT, ids[1], {"target": np.array([2.0, 2.0, 1.0])}),
        (c.Change.END, ids[0], {}),
        (c.Change.LOCK, ids[1], {}),
    ):
        result = change(observer, what, keypoint, **fields)
        assert result.outcome is c.Outcome.ACCEPTED, result.reason
    path = walked(observer, result.revision_ns)
    code, said = walk(graph, "save", folder)
    assert code == 0, said
    assert f"saved {len(ids) + 1} keypoints as the tour 'main'" in said
    for name in ("importance", "sequencer", "trajopt"):
        graph.interrupt(name)
    return folder, keypoints_of(observer), c.keypoint_marks_from_msg(observer.last("keypoint_markers")), path


@pytest.fixture
def opening(other_domain, tmp_path):
    """Opens a project in a graph of its own, as if on another machine: nothing is in its state folder."""
    graph, listener = Graph(other_domain, tmp_path, ""), Observer(other_domain, "listener")

    def start(*arguments):
        graph.run("open", "walk_bringup.cli", "open", *map(str, arguments), "--port", "0")
        listener.wait_for_all(2 * LIMIT_S)
        return graph, listener

    yield start
    if "open" in graph.processes:
        graph.interrupt("open", signal.SIGINT)
    listener.close()
    graph.close()


def test_an_opened_project_has_the_same_keypoints_marks_and_path(saved, opening):
    folder, keypoints, marks, path = saved
    graph, listener = opening(folder)
    settled(listener)
    listener.wait(lambda: keypoints_of(listener).ids == keypoints.ids, "the saved keypoints")
    again = settled(listener)
    now = c.keypoint_marks_from_msg(listener.last("keypoint_markers"))
    np.testing.assert_array_equal(keypoints_of(listener).poses.positions, keypoints.poses.positions)
    np.testing.assert_array_equal(keypoints_of(listener).poses.quat_xyzw, keypoints.poses.quat_xyzw)
    assert (now.locked, now.dwell_s, now.start, now.end) == (marks.locked, marks.dwell_s, marks.start, marks.end)
    assert list(now.look_at) == list(marks.look_at)
    np.testing.assert_array_equal(list(now.look_at.values()), list(marks.look_at.values()))
    assert len(again.positions) == len(path.positions)
    np.testing.assert_allclose(again.positions, path.positions, atol=1e-3)
    # The past came along, and so did the parameters.
    assert change(listener, c.Change.UNDO).outcome is c.Outcome.ACCEPTED
    listener.wait(lambda: not c.keypoint_marks_from_msg(listener.last("keypoint_markers")).locked, "the lock undone")
    code, said = walk(graph, "save", folder, "--tour", "free")
    assert code == 0, said
    assert yaml.safe_load((folder / "parameters.yaml").read_text())["/**/trajopt"]["ros__parameters"]["timing"][
        "speed_mps"
    ] == pytest.approx(0.9)
    tours = {name: yaml.safe_load((folder / "tours" / f"{name}.yaml").read_text()) for name in ("main", "free")}
    locked = {name: sum(k["locked"] for k in tour["keypoints"]) for name, tour in tours.items()}
    assert locked == {"main": 1, "free": 0}
    assert walk(graph, "open", folder)[1].strip().endswith("is open in another graph already")


def test_a_graph_that_does_not_run_is_one_sentence(graph, other_domain, tmp_path):
    code, said = walk(graph, "save", tmp_path / "none", domain=other_domain)
    assert code == 2
    assert said.startswith("walk: no graph with keypoints runs in the namespace 'walk'")
    assert said.count("\n") == 1
    assert not os.path.exists(tmp_path / "none")
