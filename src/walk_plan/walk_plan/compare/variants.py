# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The walk optimised with all objectives, and without each of them in turn (figure 6 of `schmidiger`)."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from walk_plan.along import every
from walk_plan.baselines import look_targets
from walk_plan.quality import Measure, PathQuality
from walk_plan.walkthrough import Walkthrough
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.curve import refine
from walk_trajopt.objectives import OBJECTIVES
from walk_trajopt.optimiser import Optimiser
from walk_trajopt.timing import time_path

ALL = "all"
"""The name of the walk with every objective."""

_FINE_M = 0.02  # spacing of points that stand for a line when distances to it are taken
_TURN_STEP_M, _TURN_STEPS = 0.1, 3
_SHARP_COS = float(np.cos(np.radians(30.0)))


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Variant:
    """What the optimiser makes of the planned tour, before the check mends what collides."""

    name: str  # ALL, or the objective that is left out
    points: NDArray[np.float64]  # (n, 3) [m]
    quality: PathQuality
    deviation_m: float  # mean distance from the planned tour
    sharp_turns: int  # places where the path turns by more than 30° within 0.3 m
    keypoint_miss_m: float  # largest distance at which a keypoint is passed
    repaired: int  # stretches that the check mends afterwards
    colliding: int  # stretches that it cannot mend


def objective_variants(walkthrough: Walkthrough, measure: Measure) -> tuple[Variant, ...]:
    """Returns the walk with all objectives, then without each that has a weight.

    Args:
        walkthrough: The plan; its tour, settings and building are those of every variant.
        measure: Takes the figures, of all walks alike.
    """
    config = walkthrough.config.trajectory
    weighted = [name for name in OBJECTIVES if config.weight(name) > 0.0]
    variants = [_variant(ALL, walkthrough, config, measure)]
    if len(weighted) > 1:
        for name in weighted:
            nothing: dict[str, Any] = {f"weight_{name}": 0.0}
            variants.append(_variant(name, walkthrough, dataclasses.replace(config, **nothing), measure))
    return tuple(variants)


def _variant(name: str, walkthrough: Walkthrough, config: TrajoptConfig, measure: Measure) -> Variant:
    tour = walkthrough.tour
    config = dataclasses.replace(config, mode="optimised")
    optimiser = Optimiser(walkthrough.building, tour.polyline, walkthrough.keypoints, config)
    optimiser.solve()
    points, place = refine(optimiser.state.x, config.chord_error_m)
    index = np.abs(place[None, :] - optimiser.state.keypoint_index[:, None]).argmin(axis=1)
    checked = optimiser.check()
    raw = dataclasses.replace(checked, points=points, keypoint_index=index, repaired=(), colliding=())
    targets = look_targets(walkthrough.suggestion, tour.stands, tour.order)
    fine = every(points, _FINE_M)
    return Variant(
        name=name,
        points=points,
        quality=measure(name, points, time_path(raw, walkthrough.config.timing, targets)),
        deviation_m=float(cKDTree(every(tour.polyline, _FINE_M)).query(every(points, _TURN_STEP_M))[0].mean()),
        sharp_turns=sharp_turns(points),
        keypoint_miss_m=float(cKDTree(fine).query(walkthrough.keypoints)[0].max()),
        repaired=len(checked.repaired),
        colliding=len(checked.colliding),
    )


def sharp_turns(points: NDArray[np.float64]) -> int:
    """Returns at how many places a polyline's direction changes by more than 30° over a step of 0.3 m."""
    steps = np.diff(every(points, _TURN_STEP_M), axis=0)
    steps = steps[np.linalg.norm(steps, axis=1) > 1e-9]
    unit = steps / np.linalg.norm(steps, axis=1)[:, None]
    sharp = (unit[_TURN_STEPS:] * unit[:-_TURN_STEPS]).sum(axis=1) < _SHARP_COS
    return int((np.diff(np.concatenate([[False], sharp]).astype(np.int8)) > 0).sum())
