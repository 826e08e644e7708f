# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What the path keeps and what it changes while the graph runs: confirmed drags, locks, dwell, modes, weights."""

import numpy as np
import pytest
from graph.processes import EditKind

from walk_building.pipeline import load_building
from walk_building.sweep import BodySweep
from walk_ros import conversions as c
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.objectives import OBJECTIVES

pytestmark = pytest.mark.ros


@pytest.fixture(scope="module")
def building(rooms):
    return load_building(rooms)


def keypoints_of(observer):
    return c.keypoint_markers_from_msg(observer.last("keypoint_markers"))


def walked(observer, revision_ns=None):
    """Waits for the path through the tour of a revision, or of the newest one; returns its places."""

    def condition():
        newest = c.tour_from_msg(observer.last("tour")).stamp_ns
        state = observer.state("trajopt")
        own = c.path_from_msg(observer.last("path")).stamp_ns
        return (
            newest == (revision_ns or newest)
            and state.get("tour_revision_ns") == str(newest)
            and state.get("revision_ns") == str(own)
        )

    observer.wait(condition, "a path through the newest tour")
    return c.path_from_msg(observer.last("path")).positions


def changed(observer, what, keypoint, argument=""):
    """Publishes a change; returns the path after it."""
    observer.sent += 1
    edit = c.KeypointEdit(
        kind=c.EditKind.CHANGE,
        keypoint=keypoint,
        client_id="anna",
        stamp_ns=10**18 + observer.sent,
        position=np.zeros(3),
        quat_xyzw=np.array([0.0, 0.0, 0.0, 1.0]),
        change=what,
        argument=argument,
    )
    heard = len(observer.heard["edit_results"])
    observer.edits.publish(c.edit_to_msg(edit))

    def find():
        results = map(c.edit_result_from_msg, observer.heard["edit_results"][heard:])
        return next((r for r in results if r.edit_stamp_ns == edit.stamp_ns), None)

    result = observer.wait(find, f"the answer to {what}")
    assert result.outcome is c.Outcome.ACCEPTED, result.reason
    return walked(observer, result.revision_ns)


def set_and_walked(observer, name, value):
    heard = len(observer.heard["path"])
    result = observer.set_parameter("trajopt", name, value)
    assert result.successful, result.reason
    observer.after("path", heard, f"a path with {name} = {value}")
    return walked(observer)


def nearest(positions, place):
    return np.linalg.norm(positions - place, axis=1).min()


def beside(positions, line):
    """Returns how far the farthest of some places is from a polyline [m]."""
    side = np.diff(line, axis=0)
    share = ((positions[:, None] - line[:-1]) * side).sum(axis=2) / np.maximum((side**2).sum(axis=1), 1e-18)
    feet = line[:-1] + np.clip(share, 0.0, 1.0)[..., None] * side
    return np.linalg.norm(positions[:, None] - feet, axis=2).min(axis=1).max()


def places(positions):
    return {tuple(p) for p in np.round(positions, 9)}


def test_the_path_shown_at_a_drag_is_the_path_when_it_is_confirmed(running, observer):
    walked(observer)
    keypoints = keypoints_of(observer)
    inner = keypoints.ids[1]
    there = keypoints.poses.positions[1] + [0.15, 0.1, 0.0]
    heard = len(observer.heard["path"])
    observer.edit(EditKind.GRAB, inner, keypoints.poses.positions[1])()
    observer.edit(EditKind.DRAG, inner, there)()
    observer.after("path", heard, "the drag's path")
    dragged = c.path_from_msg(observer.last("path")).positions
    result = observer.edit(EditKind.RELEASE, inner, there)()
    assert result.outcome is c.Outcome.ACCEPTED, result.reason
    confirmed = walked(observer, result.revision_ns)
    stand = keypoints_of(observer).poses.positions[1]
    assert np.linalg.norm(stand - there) < 0.01, "the authority moved the keypoint, so the path may move, too"
    # Each is sampled by its own clock: every place of one is beside a place on a line of the other.
    assert max(beside(confirmed, dragged), beside(dragged, confirmed)) < 0.02


def test_a_dwell_changes_the_clock_and_not_the_path(running, observer):
    before = walked(observer)
    identity = keypoints_of(observer).ids[1]
    t_s = c.path_from_msg(observer.last("path")).t_s[-1]
    after = changed(observer, c.Change.DWELL, identity, argument="4")
    assert c.path_from_msg(observer.last("path")).t_s[-1] > t_s + 3.0
    # Rows between the points of the path lie elsewhere on the same lines; the path's own points are rows of both.
    assert len(places(before) & places(after)) > 50
    assert changed(observer, c.Change.DWELL, identity, argument="0") is not None


def test_a_locked_keypoint_is_passed_exactly(running, observer, building):
    walked(observer)
    keypoints = keypoints_of(observer)
    k = len(keypoints.ids) // 2
    place = keypoints.poses.positions[k]
    path = changed(observer, c.Change.LOCK, keypoints.ids[k])
    assert nearest(path, place) < 1e-6
    assert BodySweep(building.geometry, building.walker).segments_free(path).all()
    changed(observer, c.Change.UNLOCK, keypoints.ids[k])


def test_the_optimiser_is_switched_off_and_on_while_the_node_runs(running, observer, building):
    walked(observer)
    stands = keypoints_of(observer).poses.positions
    spline = set_and_walked(observer, "trajopt.mode", "catmull_rom")
    assert max(nearest(spline, place) for place in stands) < 1e-6
    free = BodySweep(building.geometry, building.walker).segments_free(spline).all()
    state = observer.state("trajopt")
    assert "catmull_rom" in state["solver_status"]
    assert (state["error_code"] == "colliding") != free
    optimised = set_and_walked(observer, "trajopt.mode", "optimised")
    assert BodySweep(building.geometry, building.walker).segments_free(optimised).all()
    assert observer.state("trajopt")["error_code"] == ""
    refused = observer.set_parameter("trajopt", "trajopt.mode", "bezier")
    assert not refused.successful and "catmull_rom" in refused.reason


@pytest.mark.parametrize("name", OBJECTIVES)
def test_each_objective_is_switched_off_and_on_while_the_node_runs(running, observer, building, name):
    # So near to the keypoints that their objective has something to say.
    as_usual = set_and_walked(observer, "trajopt.keypoint_radius_m", 0.0)
    usual = TrajoptConfig().weight(name)
    other = 0.0 if usual else 1.0  # one that is off by default is switched on first
    changed = set_and_walked(observer, f"trajopt.weight_{name}", other)
    if name == "height":  # on a level floor nothing draws the eye up or down
        np.testing.assert_allclose(changed[:, 2], as_usual[:, 2].mean(), atol=1e-6)
    elif usual:  # what one that is off by default is for may not be in this building
        assert places(as_usual) != places(changed), f"{name} says nothing here"
    assert BodySweep(building.geometry, building.walker).segments_free(changed).all()
    assert places(set_and_walked(observer, f"trajopt.weight_{name}", usual)) == places(as_usual)
    set_and_walked(observer, "trajopt.keypoint_radius_m", TrajoptConfig().keypoint_radius_m)


def test_the_order_is_found_another_way_while_the_nodes_run(running, observer, building):
    def set_method(name):
        result = observer.set_parameter("sequencer", "sequencer.method", name)
        assert result.successful, result.reason

        def by_it():
            status = observer.state("sequencer")["solver_status"]
            return status == {"auto": "exact"}.get(name, name) and keypoints_of(observer)

        ids = observer.wait(by_it, f"a tour by {name}").ids
        path = walked(observer)
        assert BodySweep(building.geometry, building.walker).segments_free(path).all()
        return ids

    before = keypoints_of(observer).ids
    for method in ("mst_dfs", "auto", "local_search", "given"):
        assert sorted(set_method(method)) == sorted(before)
    set_method("auto")
    refused = observer.set_parameter("sequencer", "sequencer.method", "fastest")
    assert not refused.successful and "mst_dfs" in refused.reason
