# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Graphs of real nodes on real DDS, on a small made building."""

import pytest
from graph.domains import own_domain
from graph.processes import Graph, Observer, settled
from graph.rooms import make_rooms


@pytest.fixture(scope="session")
def rooms(tmp_path_factory):
    return make_rooms(tmp_path_factory.mktemp("building") / "rooms.ply")


@pytest.fixture(scope="module")
def graph(rooms, tmp_path_factory):
    with own_domain() as domain:
        graph = Graph(domain, tmp_path_factory.mktemp("graph"), rooms)
        yield graph
        graph.close()


@pytest.fixture(scope="module")
def observer(graph):
    observer = Observer(graph.domain)
    yield observer
    observer.close()


@pytest.fixture(scope="module")
def running(graph, observer):
    """The graph at rest, started from its end, so that every node has to wait for its input."""
    for name in ("trajopt", "sequencer", "importance"):
        graph.start(name)
    observer.wait_for_all()
    settled(observer)
    return graph


@pytest.fixture
def other_domain():
    with own_domain() as domain:
        yield domain
