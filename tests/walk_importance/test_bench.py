# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import json

from scenes import building_of, two_rooms

from walk_importance.bench import bench, bench_building, growth


def test_the_bench_holds_the_bars_on_a_small_building() -> None:
    found = bench(free_voxels=8000, ray_sources=100, memory_voxels=400_000)
    json.dumps(found)
    assert found["exact"]["correlation_with_rays"] >= 0.995
    assert abs(found["exact"]["bias_share_of_free_space"]) <= 0.005
    assert found["ratio"]["exact_over_rays"] > 10
    assert found["memory"]["peak_bytes_a_voxel"] <= 64
    assert found["progressive"]["steps"][-1]["correlation"] >= 0.999


def test_the_bench_of_a_building_asks_its_triangles() -> None:
    found = bench_building(building_of(two_rooms(door_m=2.0)), voxel_size_m=0.3, ray_sources=60)
    json.dumps(found)
    assert found["exact"]["correlation_with_triangle_rays"] > 0.9
    assert found["exact"]["bias_share_of_free_space"] <= 1e-6


def test_the_exact_time_is_measured_where_it_is_short() -> None:
    (small,) = growth((3000,))
    assert small["exact_measured"]
    assert small["free"] < small["voxels"] < 4000
