# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What the measurement of the bridge starts, with and without a building."""

import pytest
import rclpy

from walk_vr_bridge.bench.graph import bridge_parameters


@pytest.mark.parametrize("building", ["", "/tmp/a building.ply"])
def test_the_bridge_can_read_its_parameters(building):
    given = [part for parameter in bridge_parameters(building, 8765) for part in ("-p", parameter)]
    context = rclpy.Context()
    rclpy.init(args=["--ros-args", *given], context=context)
    context.try_shutdown()
