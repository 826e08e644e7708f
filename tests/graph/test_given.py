# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A graph that begins with the user's keypoints: what `./walk up --keypoints-file` starts."""

import time

import numpy as np
import pytest
from graph.processes import EditKind, settled

from walk_bringup.cli.up import keypoint_params
from walk_building.walker import Walker
from walk_ros import conversions as c

pytestmark = pytest.mark.ros

EYE_M = Walker().eye_height_m
MINE = np.array([[10.0, 2.0, EYE_M], [2.0, 1.5, EYE_M], [6.0, 3.0, EYE_M], [6.0, 1.0, EYE_M]])


@pytest.fixture(scope="module")
def parameters(tmp_path_factory):
    """By node, what stands for the file."""
    file = tmp_path_factory.mktemp("mine") / "mine.csv"
    rows = [f"{x},{y},{z},{'180' if k == 0 else ''}" for k, (x, y, z) in enumerate(MINE)]
    file.write_text("x,y,z,yaw_deg\n" + "\n".join(rows) + "\n30,2,1.6,\n6,3.98,1.6,\n")
    split = (given.partition(".") for given in keypoint_params(file))
    return {node: parameter.replace("=", ":=", 1) for node, _, parameter in split}


@pytest.fixture(scope="module")
def parameter(parameters):
    """What stands for it at the importance node."""
    return parameters["importance"]


def test_the_users_keypoints_stand_in_place_of_suggested_ones(graph, observer, parameter):
    graph.start("importance", parameter)
    graph.start("sequencer")
    graph.start("trajopt")
    observer.wait_for_all()
    path = settled(observer).positions
    shown = c.keypoints_from_msg(observer.last("keypoints"))
    near = np.linalg.norm(MINE[:, None] - shown.positions[None], axis=2)
    assert near.min(axis=1).max() < 1e-3
    assert all(len(c.keypoints_from_msg(msg).positions) == 6 for msg in observer.heard["suggested_keypoints"])
    # The first says where it looks; the next, with walls behind it on three sides, looks where most is seen.
    asked = c.keypoints_from_msg(observer.last("suggested_keypoints"))
    np.testing.assert_allclose(np.abs(asked.quat_xyzw[0]), [0.0, 0.0, 1.0, 0.0], atol=1e-6)
    assert not np.allclose(np.abs(asked.quat_xyzw[0]), np.abs(asked.quat_xyzw[1]), atol=1e-3)
    assert np.linalg.norm(MINE[:, None] - path[None], axis=2).min(axis=1).max() < 0.6
    assert "suggested keypoints 1 to 6 are those of mine.csv" in graph.log("importance")
    told = [line for line in graph.log("sequencer").splitlines() if "suggested keypoint" in line]
    assert len(told) == 2
    assert "suggested keypoint 5 at (30.00, 2.00, 1.60) is left out: no floor to stand on within" in told[0]
    assert "suggested keypoint 6 at (6.00, 3.98, 1.60) is moved by 0." in told[1]


def test_the_file_begins_a_session_also_where_an_earlier_one_has_edited(graph, observer, parameters):
    keypoints = c.keypoint_markers_from_msg(observer.last("keypoint_markers"))
    second = 1  # identity of the file's second keypoint, wherever the tour has it
    moved = keypoints.poses.positions[keypoints.ids.index(second)] + [0.2, 0.1, 0.0]
    for kind in (EditKind.GRAB, EditKind.DRAG, EditKind.RELEASE):
        answer = observer.edit(kind, second, moved)()
    assert answer.outcome is c.Outcome.ACCEPTED, answer.reason

    def again(*arguments):
        """Starts the sequencer again; returns how far the nearest keypoint is from each of the file's [m]."""
        graph.kill("sequencer")
        heard = len(observer.heard["keypoints"])
        graph.start("sequencer", *arguments)
        observer.after("keypoints", heard, "the keypoints")
        settled(observer)
        shown = c.keypoints_from_msg(observer.last("keypoints")).positions
        return np.linalg.norm(MINE[:, None] - shown[None], axis=2).min(axis=1)

    assert again().max() > 0.1
    assert "edited in an earlier session are back" in graph.log("sequencer")
    assert again(parameters["sequencer"]).max() < 1e-3
    assert "put aside" in graph.log("sequencer")


def test_a_sequencer_started_again_within_the_session_keeps_its_edits(graph, observer, parameters):
    begun = time.time()
    keypoints = c.keypoint_markers_from_msg(observer.last("keypoint_markers"))
    second = 1
    moved = keypoints.poses.positions[keypoints.ids.index(second)] + [0.2, 0.1, 0.0]
    for kind in (EditKind.GRAB, EditKind.DRAG, EditKind.RELEASE):
        answer = observer.edit(kind, second, moved)()
    assert answer.outcome is c.Outcome.ACCEPTED, answer.reason
    graph.kill("sequencer")
    heard = len(observer.heard["keypoints"])
    graph.start("sequencer", parameters["sequencer"], f"editing.session_start_s:={begun}")
    observer.after("keypoints", heard, "the keypoints")
    shown = c.keypoints_from_msg(observer.last("keypoints")).positions
    assert np.linalg.norm(shown - moved, axis=1).min() < 0.01


def test_the_next_start_without_the_file_has_suggested_ones_again(graph, observer, parameter):
    graph.kill("importance")
    before = len(observer.heard["suggested_keypoints"])
    graph.start("importance")
    found = c.keypoints_from_msg(observer.after("suggested_keypoints", before, "suggestions"))
    assert not np.isclose(found.positions[:, None], MINE[None], atol=1e-3).all(axis=2).any()


def test_another_file_is_numbered_by_its_own_rows(graph, observer, tmp_path):
    (tmp_path / "other.csv").write_text("x,y,z\n2,1.5,1.6\n6,3,1.6\n-30,2,1.6\n")
    graph.kill("importance")
    graph.kill("sequencer")
    graph.start("sequencer", "editing.restore:=false")
    graph.start("importance")
    observer.wait(lambda: len(observer.state("sequencer").get("revision_ns", "")) > 1, "the suggested ones")
    settled(observer)
    graph.kill("importance")
    graph.start("importance", f"keypoints_file:={tmp_path / 'other.csv'}")
    observer.wait(lambda: "(-30.00, 2.00, 1.60) is left out" in graph.log("sequencer"), "the warning")
    assert "suggested keypoint 3 at (-30.00, 2.00, 1.60) is left out" in graph.log("sequencer")


def test_a_file_that_is_gone_is_said_by_the_node(graph, observer, parameter):
    graph.kill("importance")
    graph.start("importance", "keypoints_file:=/nowhere/mine.csv")
    observer.wait(lambda: observer.state("importance").get("state") == "failed", "the node to say what is wrong")
    assert "/nowhere/mine.csv: cannot be read" in graph.log("importance")
