# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The graph on the sample building, which is what the nodes take when no building is given."""

import pytest
from graph.processes import NODES, Graph, Observer

from walk_bringup.sample.location import sample_path
from walk_building.pipeline import load_building
from walk_building.sweep import BodySweep
from walk_ros import conversions as c

pytestmark = [pytest.mark.ros, pytest.mark.slow]


def test_the_sample_building_is_walked_without_touching_it(other_domain, tmp_path):
    graph, observer = Graph(other_domain, tmp_path, ""), Observer(other_domain)
    try:
        for name in NODES:
            graph.run(name, NODES[name])
        observer.wait_for_all(limit_s=120.0)
        building = load_building(sample_path())
        path = c.path_from_msg(observer.last("path"))
        assert BodySweep(building.geometry, building.walker).segments_free(path.positions).all()
        assert len(building.storeys) >= 2
        observer.wait(
            lambda: (
                len({m.info.origin.position.z for m in observer.heard["importance_map/storeys"]})
                == len(building.storeys)
            ),
            "a grid of every storey",
        )
        # Both storeys are visited: the eye's height changes by more than half a storey.
        assert path.positions[:, 2].max() - path.positions[:, 2].min() > 1.5
        assert [graph.interrupt(name) for name in NODES] == [0, 0, 0]
    finally:
        observer.close()
        graph.close()
