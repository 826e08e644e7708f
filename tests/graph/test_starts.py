# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Each node alone: other orders, bad arguments, an end in the middle of work."""

import itertools
import subprocess
import sys
import time

import pytest
from graph.processes import LIMIT_S, NODES, Graph, Observer

from walk_ros import conversions as c

pytestmark = pytest.mark.ros


def test_started_one_after_the_other_is_heard_has_input(graph, observer):
    """The other order: each node is done before the next one starts, and must get what was said before it was there."""
    graph.start("importance")
    observer.wait(lambda: observer.last("suggested_keypoints"), "suggestions")
    graph.start("sequencer")
    observer.wait(lambda: observer.last("tour"), "a tour")
    graph.start("trajopt")
    observer.wait(lambda: observer.last("trajectory") and observer.last("path"), "a trajectory and its path")
    assert len(c.path_from_msg(observer.last("path")).positions) > 10


def test_a_misspelt_parameter_is_said_and_the_node_goes_on(graph, observer):
    began_ns = time.time_ns()
    if "trajopt" in graph.processes:
        graph.kill("trajopt")
    graph.start("trajopt", "trajopt.weight_lenght:=1.0", "misspelt:=1")
    heard = observer.heard["/diagnostics"]
    observer.wait(
        lambda: any(
            c.stamp_from_msg(m.header.stamp) > began_ns and s.name == "walk/trajopt" for m in heard for s in m.status
        ),
        "the node to go on",
    )
    log = graph.log("trajopt")
    assert "no parameter trajopt.weight_lenght, so it changes nothing; did you mean trajopt.weight_length?" in log
    assert "no parameter misspelt, so it changes nothing" in log


@pytest.mark.parametrize("order", list(itertools.permutations(NODES)), ids="-".join)
def test_every_order_of_starts_ends_in_the_same_walk(rooms, tmp_path, other_domain, order):
    graph, watching = Graph(other_domain, tmp_path, rooms), Observer(other_domain)
    try:
        for name in order:
            graph.start(name)
            watching.wait(lambda name=name: watching.state(name), f"{name} to be there")
        path = watching.wait(lambda: (p := watching.last("path")) and len(p.poses) > 10 and p, "a path")
        assert len(c.path_from_msg(path).positions) > 10
        assert len(c.keypoints_from_msg(watching.last("keypoints")).positions) >= 3
    finally:
        # First who listens: the middleware has crashed once where its node ended among those just killed.
        watching.close()
        graph.close()


@pytest.mark.parametrize("name", list(NODES))
def test_a_node_told_to_end_while_it_works_ends_cleanly(graph, observer, name):
    if name in graph.processes:
        graph.kill(name)
    began_ns = time.time_ns()
    graph.start(name)

    def says_something():
        # By its stamp: what the killed one said may still be on its way.
        new = (m for m in observer.heard["/diagnostics"] if c.stamp_from_msg(m.header.stamp) > began_ns)
        return any(status.name == f"walk/{name}" for m in new for status in m.status)

    observer.wait(says_something, f"{name} to say something")
    assert graph.interrupt(name) == 0, graph.log(name)
    assert "Traceback" not in graph.log(name)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--ros-args", "-p", "walker.radius_m:=9.0"], "walker.radius_m"),
        (["--ros-args", "-p", "walker.height_m:=0.6"], "height_m"),
        (["--ros-args", "-r", "nonsense"], "nonsense"),
    ],
)
def test_bad_arguments_end_with_one_sentence_and_code_2(graph, arguments, said):
    done = subprocess.run(
        [sys.executable, "-m", NODES["trajopt"], *arguments],
        env=graph.environment(),
        capture_output=True,
        text=True,
        timeout=LIMIT_S,
    )
    assert done.returncode == 2
    assert said in done.stderr
    assert "Traceback" not in done.stderr


def test_what_a_file_leaves_open_is_said_once(graph, observer):
    """A mesh says no unit: who starts a graph on it must hear that metres are assumed, and not from every node."""
    graph.start("importance")
    graph.start("sequencer")
    observer.wait(lambda: observer.last("tour"), "a tour")
    log = graph.log("importance")
    assert log.count("metres are assumed") == log.count("]: loaded ") > 0
    assert "metres are assumed" not in graph.log("sequencer")
