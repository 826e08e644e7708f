# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Publishes made-up maps of a million voxels; prints when each was begun and when the middleware had it, as JSON."""

from __future__ import annotations

import json
import sys
import time

import numpy as np
import rclpy
from rclpy.duration import Duration

from walk_ros.conversions.importance import ReceivedGrid, ReceivedImportanceMap, importance_map_to_bytes
from walk_ros.live_bench.map_listener import LATER_S, MAP
from walk_ros.runner import use_profiles
from walk_ros.topics import NAMESPACE, TOPICS

SHAPE = (200, 100, 50)


def main(count: int = 20) -> int:
    """Publishes once somebody listens; returns the exit code, 1 where nobody does."""
    use_profiles()
    rclpy.init()
    node = rclpy.create_node("maps", namespace=NAMESPACE)
    publisher = node.create_publisher(TOPICS[MAP].type, MAP, TOPICS[MAP].qos)
    until = time.perf_counter() + LATER_S
    while not publisher.get_subscription_count() and time.perf_counter() < until:
        time.sleep(0.05)
    rng = np.random.default_rng(0)
    maps = {name: rng.random(SHAPE, np.float32) for name in ("obstacle", "distance", "visibility", "importance")}
    grid = ReceivedGrid(origin=np.zeros(3), voxel_size_m=0.1, shape=SHAPE)
    times = []
    for stamp_ns in range(1, count + 1):
        began = time.perf_counter()
        publisher.publish(
            importance_map_to_bytes(ReceivedImportanceMap(stamp_ns=stamp_ns, grid=grid, **maps), stamp_ns)
        )
        times.append((began, time.perf_counter()))
        # One at a time, as maps are.
        publisher.wait_for_all_acked(Duration(seconds=LATER_S))
        time.sleep(0.1)
    heard = bool(publisher.get_subscription_count())
    node.destroy_node()
    rclpy.try_shutdown()
    sys.stdout.write(json.dumps(times) + "\n")
    return 0 if heard else 1


if __name__ == "__main__":
    sys.exit(main())
