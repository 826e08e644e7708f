# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The importance map as bytes is the importance map as a message."""

import numpy as np
import pytest
from sensor_msgs.msg import PointCloud2

from walk_importance.grid import VoxelGrid
from walk_importance.importance_map import ImportanceMap
from walk_ros.conversions.importance import importance_map_to_bytes, importance_map_to_msg
from walk_ros.raw import from_bytes


@pytest.mark.parametrize("shape", [(3, 4, 5), (1, 1, 1), (7, 1, 2)])
def test_bytes_decode_to_the_message(shape):
    rng = np.random.default_rng(3)
    maps = {n: rng.random(shape, np.float32) for n in ("obstacle", "distance", "visibility", "importance")}
    grid = VoxelGrid(origin=np.array([-1.0, 2.0, 0.5]), voxel_size_m=0.25, shape=shape)
    importance_map = ImportanceMap(grid=grid, visibility_stderr=0.0, notes=(), **maps)
    stamp_ns = 1_700_000_000_123_456_789
    decoded = from_bytes(importance_map_to_bytes(importance_map, stamp_ns), "sensor_msgs/msg/PointCloud2")
    assert isinstance(decoded, PointCloud2)
    assert decoded == importance_map_to_msg(importance_map, stamp_ns)
