# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The measurement of the importance node's answers runs from start to end and counts what it says it counts."""

import json
import subprocess
import sys

import pytest
from graph.processes import LIMIT_S

pytestmark = pytest.mark.ros


def bench(graph, *arguments):
    return subprocess.run(
        [sys.executable, "-m", "walk_ros.live_bench.maps", *arguments],
        env=graph.environment(),
        capture_output=True,
        text=True,
        timeout=3 * LIMIT_S,
    )


def test_it_measures_starts_and_cones_and_a_cone_publishes_no_map(graph, rooms):
    done = bench(graph, str(rooms), "--starts", "1", "--cones", "2")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)[rooms.name]
    assert found["another_cone_ms"]["count"] == 2
    assert found["maps_published_again"] == 0
    assert found["later_start_to_importance_map_ms"]["count"] == 1
    assert found["later_start_to_importance_map_ms"]["max"] > 0


def test_a_building_that_is_not_there_is_said(graph):
    done = bench(graph, "nowhere.ifc")
    assert done.returncode == 2
    assert "nowhere.ifc: there is no such building" in done.stderr
