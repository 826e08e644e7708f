# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Graphs of real nodes on real DDS, on a small made building."""

import os

import pytest
from graph.processes import Graph, Observer
from graph.rooms import make_rooms

_DOMAINS = iter(range(102 + 6 * (os.getpid() % 20), 233))
"""Every graph has a domain of its own, other test runs on this machine most likely others."""


@pytest.fixture(scope="session")
def rooms(tmp_path_factory):
    return make_rooms(tmp_path_factory.mktemp("building") / "rooms.ply")


@pytest.fixture(scope="module")
def graph(rooms, tmp_path_factory):
    graph = Graph(next(_DOMAINS), tmp_path_factory.mktemp("graph"), rooms)
    yield graph
    graph.close()


@pytest.fixture(scope="module")
def observer(graph):
    observer = Observer(graph.domain)
    yield observer
    observer.close()


@pytest.fixture
def other_domain():
    return next(_DOMAINS)
