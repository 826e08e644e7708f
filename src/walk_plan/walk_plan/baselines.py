# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The walks that ours is compared with, each through the same building and measured by the same report."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_importance.keypoints import Suggestion
from walk_plan.options import PlanConfig
from walk_plan.rooms_and_doors import rooms_and_doors
from walk_sequencer.pipeline import plan_tour
from walk_sequencer.tour import Tour
from walk_trajopt.pipeline import optimise_path
from walk_trajopt.spline import spline_path
from walk_trajopt.timing import time_path
from walk_trajopt.trajectory import Trajectory

LOOK_DISTANCE_M = 3.0
"""How far off in the direction of the best view a keypoint's look-at point is put."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Walk:
    """A walk to be measured."""

    name: str
    path: NDArray[np.float64]  # (n, 3) eye positions [m]
    trajectory: Trajectory


def baselines(building: Building, suggestion: Suggestion, tour: Tour, config: PlanConfig) -> tuple[Walk, ...]:
    """Returns the walks to compare with, as far as the building allows them.

    - `spline`: a curve through the keypoints in our order, not optimised (the source's manual mode);
    - `mst_dfs`: the source's order by spanning tree and depth first search, optimised as ours is;
    - `rooms_and_doors`: what viewers of building models do; see `rooms_and_doors`.
    """
    walks = []
    if len(tour.order) >= 2:
        walks.append(_spline(building, suggestion, tour, config))
        walks.append(_mst_dfs(building, suggestion, tour, config))
    straight = rooms_and_doors(building)
    if straight is not None:
        walks.append(Walk(name="rooms_and_doors", path=straight.positions, trajectory=straight))
    return tuple(walks)


def look_targets(suggestion: Suggestion, stands: NDArray[np.float64], order: NDArray[np.int64]) -> NDArray[np.float64]:
    """Returns what to look at near each keypoint of the order: a point where most is seen, (M, 3) [m]."""
    x, y, z, w = suggestion.quat_xyzw[order].T
    ahead = np.column_stack([1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)])
    return np.asarray(stands[order] + LOOK_DISTANCE_M * ahead)


def _spline(building: Building, suggestion: Suggestion, tour: Tour, config: PlanConfig) -> Walk:
    path = spline_path(building, tour.stands[tour.order], config.trajectory)
    trajectory = time_path(path, config.timing, look_targets(suggestion, tour.stands, tour.order))
    return Walk(name="spline", path=path.points, trajectory=trajectory)


def _mst_dfs(building: Building, suggestion: Suggestion, tour: Tour, config: PlanConfig) -> Walk:
    # The roadmap and all legs are those of our tour; only the order is another.
    tree = plan_tour(building, suggestion.positions, dataclasses.replace(config.tour, method="mst_dfs"), previous=tour)
    path = optimise_path(building, tree.polyline, tree.stands[tree.order], config.trajectory)
    trajectory = time_path(path, config.timing, look_targets(suggestion, tree.stands, tree.order))
    return Walk(name="mst_dfs", path=path.points, trajectory=trajectory)
