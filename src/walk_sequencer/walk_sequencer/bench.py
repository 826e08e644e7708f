# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What planning a tour costs, stage by stage, and what it gains over the source's order."""

from __future__ import annotations

import dataclasses
import time

import numpy as np
from numpy.typing import ArrayLike

from walk_building.building import Building
from walk_sequencer.config import SequencerConfig
from walk_sequencer.pipeline import plan_tour


def bench(building: Building, keypoints: ArrayLike, config: SequencerConfig | None = None) -> dict[str, float]:
    """Returns times [s], lengths [m] and their ratios for planning a tour of the keypoints.

    The compiled code is loaded by a first run that is not counted. `replan_s` is the time for a tour in which the
    first keypoint has moved a little and the previous tour is at hand. At least one keypoint is needed.
    """
    config = config or SequencerConfig()
    began: dict[str, float] = {}
    ended: dict[str, float] = {}

    def clock(stage: str, _: float) -> None:
        ended[stage] = time.perf_counter()
        began.setdefault(stage, ended[stage])

    plan_tour(building, keypoints, config)
    start = time.perf_counter()
    tour = plan_tour(building, keypoints, config, clock)
    planned = time.perf_counter()
    moved = np.array(keypoints, dtype=np.float64)
    moved[0, 0] += 0.05
    replan_start = time.perf_counter()
    plan_tour(building, moved, config, previous=tour)
    replanned = time.perf_counter()
    source = plan_tour(building, keypoints, dataclasses.replace(config, method="mst_dfs"), previous=tour)
    return {
        "keypoints": float(len(tour.order)),
        "pairs": float(len(tour.pairs)),
        "roadmap_s": ended["roadmap"] - began["roadmap"],
        "legs_s": began["order"] - ended["roadmap"],
        "order_s": ended["order"] - began["order"],
        "plan_s": planned - start,
        "replan_s": replanned - replan_start,
        "tour_m": tour.length_m,
        "mst_dfs_m": source.length_m,
        "mst_dfs_ratio": source.length_m / tour.length_m if tour.length_m > 0 else 1.0,
    }
