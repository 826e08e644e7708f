# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What trajopt shows where the sequencer was faster: its answer is there before the edit was worked on."""

import contextlib
import math
import time

import numpy as np
import pytest
import rclpy
from graph.domains import own_domain
from graph.processes import LIMIT_S
from rclpy.serialization import serialize_message

from walk_building.pipeline import load_building
from walk_ros import conversions as c
from walk_ros.conversions import EditKind, Outcome
from walk_ros.results import stand_messages
from walk_sequencer.config import SequencerConfig
from walk_sequencer.pipeline import plan_tour
from walk_trajopt.node import TrajoptNode

pytestmark = pytest.mark.ros

EYES = np.array([[1.0, 1.0, 1.6], [3.0, 3.2, 1.6], [6.0, 1.0, 1.6], [10.0, 2.0, 1.6]])
AHEAD = np.tile([0.0, 0.0, 0.0, 1.0], (len(EYES), 1))
MOVED = 2
PLACE = np.array([6.4, 2.4, 1.6])


def wait_for(condition, what):
    end = time.monotonic() + LIMIT_S
    while not condition():
        assert time.monotonic() < end, f"waited in vain for {what}"
        time.sleep(0.005)


class Trajopt:
    """The real node; messages are put where its subscriptions put them, and its worker is kept while they are."""

    def __init__(self, rooms):
        self.node, self.building = TrajoptNode(), load_building(rooms)
        self.steps = 0
        worker = self.node.worker
        step = worker._step

        def counted():
            step()
            self.steps += 1

        worker._step = counted
        wait_for(lambda: self.node.building is not None, "the node to load its building")

    @contextlib.contextmanager
    def busy(self):
        """The worker works on something else meanwhile; at the end it has worked on all that came and comes to rest."""
        worker = self.node.worker
        with worker._working:
            yield
        # A second step: the first may have put something off.
        for _ in range(2):
            done = self.steps
            worker.wake()
            wait_for(lambda done=done: self.steps > done and worker._due_s == math.inf, "the worker to come to rest")

    def revision(self, stamp_ns):
        tour = plan_tour(self.building, EYES, SequencerConfig(method="given"))
        for topic, msg in stand_messages(tour, EYES, AHEAD, range(len(EYES)), [""] * len(EYES), stamp_ns):
            self.node._store(topic, msg)

    def released(self, stamp_ns):
        edit = c.KeypointEdit(
            kind=EditKind.RELEASE,
            keypoint=MOVED,
            client_id="anna",
            stamp_ns=stamp_ns,
            position=PLACE,
            quat_xyzw=AHEAD[0],
        )
        self.node._store_edit(serialize_message(c.edit_to_msg(edit)))
        self.node._answer_edits()

    def answered(self, stamp_ns, outcome, revision_ns):
        result = c.EditResult(
            outcome=outcome,
            keypoint=str(MOVED),
            client_id="anna",
            reason="no room" if outcome is Outcome.REFUSED else "",
            revision_ns=revision_ns,
            edit_stamp_ns=stamp_ns,
        )
        self.node._store_result(serialize_message(c.edit_result_to_msg(result)))

    def place(self):
        return self.node._live.keypoints[MOVED]


@pytest.fixture(scope="module")
def trajopt(rooms, tmp_path_factory):
    folder = tmp_path_factory.mktemp("state")
    with own_domain() as domain:
        arguments = ["--ros-args", "-p", f"building:={rooms}", "-p", f"state_dir:={folder}"]
        rclpy.init(args=arguments, domain_id=domain)
        try:
            trajopt = Trajopt(rooms)
            with trajopt.busy():
                trajopt.revision(10)
            yield trajopt
            trajopt.node.destroy_node()
        finally:
            rclpy.try_shutdown()


def test_a_release_that_was_refused_before_it_was_worked_on_is_not_shown(trajopt):
    before = trajopt.node._live.path().points
    with trajopt.busy():
        trajopt.released(1)
        trajopt.answered(1, Outcome.REFUSED, 10)
    np.testing.assert_array_equal(trajopt.place(), EYES[MOVED])
    np.testing.assert_array_equal(trajopt.node._live.path().points, before)


@pytest.mark.parametrize("answer_first", [True, False])
@pytest.mark.parametrize("shown", [True, False])
def test_a_release_that_was_accepted_and_undone_meanwhile_is_not_shown(trajopt, shown, answer_first):
    before = trajopt.node._live.path().points
    stamp_ns = trajopt.node._solved_for[0] + 10
    if shown:
        with trajopt.busy():
            trajopt.released(stamp_ns)
        np.testing.assert_array_equal(trajopt.place(), PLACE)
    with trajopt.busy():
        if not shown:
            trajopt.released(stamp_ns)
        if answer_first:
            trajopt.answered(stamp_ns, Outcome.ACCEPTED, stamp_ns)
        trajopt.revision(stamp_ns + 1)
    if not answer_first:
        with trajopt.busy():
            trajopt.answered(stamp_ns, Outcome.ACCEPTED, stamp_ns)
    np.testing.assert_array_equal(trajopt.place(), EYES[MOVED])
    np.testing.assert_array_equal(trajopt.node._live.path().points, before)
