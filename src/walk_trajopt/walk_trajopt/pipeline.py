# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From a planned tour to a smooth path that the walker's body was swept along."""

from __future__ import annotations

from numpy.typing import ArrayLike

from walk_building.building import Building
from walk_building.progress import Progress, no_progress
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.optimiser import Optimiser
from walk_trajopt.path import OptimisedPath
from walk_trajopt.spline import spline_path

_STAGE = "trajectory"


def optimise_path(
    building: Building,
    polyline: ArrayLike,
    keypoints: ArrayLike,
    config: TrajoptConfig | None = None,
    progress: Progress = no_progress,
    locked: ArrayLike | None = None,
) -> OptimisedPath:
    """Returns the optimised, checked and, where necessary, repaired path; in another mode, a spline.

    Args:
        building: Where the walker walks.
        polyline: (L, 3) the planned tour's eye positions [m].
        keypoints: (M, 3) eye positions in the order of the tour, which passes them [m].
        config: Points, weights, solver.
        progress: Told how far the work is.
        locked: (M,) keypoints that the path passes exactly; None for none.

    Raises:
        ParameterError: A polyline of fewer than two different points, numbers that are not finite, or fewer points
            than keypoints.
    """
    progress(_STAGE, 0.0)
    config = config or TrajoptConfig()
    if config.mode != "optimised":
        return spline_path(building, keypoints, config, config.mode)
    optimiser = Optimiser(building, polyline, keypoints, config, locked)
    optimiser.solve()
    progress(_STAGE, 0.6)
    path = optimiser.check()
    progress(_STAGE, 1.0)
    return path
