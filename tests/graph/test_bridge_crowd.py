# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A small crowd at a real bridge over real DDS: the full figures are those of ./walk bench bridge --clients 50."""

import asyncio

import pytest

from walk_vr_bridge.bench.crowd import measure_crowd
from walk_vr_bridge.bench.graph import BenchGraph

pytestmark = pytest.mark.ros


def test_ill_behaved_clients_do_not_disturb_the_others(rooms, tmp_path, monkeypatch):
    for name in ("ROS_DOMAIN_ID", "ROS_AUTOMATIC_DISCOVERY_RANGE"):
        monkeypatch.setenv(name, "")  # what the measurement sets is taken back
    graph = BenchGraph(tmp_path, str(rooms))
    try:
        graph.wait()
        report = asyncio.run(measure_crowd(graph, 15, 6.0))
    finally:
        codes = graph.close()
    assert report["failed_clients"] == []
    assert report["bridge_runs"]
    # Four editors, five edits a second each: all but those under way at the end were answered.
    assert report["editors_in_the_crowd"]["count"] >= 60
    assert report["watchers_heard"] > 8 * 60
    assert codes == [0, 0]
    assert "Traceback" not in graph.log()
    assert "ERROR" not in graph.log()
