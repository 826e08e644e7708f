# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The height objective on a slope: the eye over the longest stair or ramp of the walk, with it and without."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from walk_building.building import Building
from walk_plan.along import every, walked_m
from walk_plan.compare.variants import ALL, Variant

NO_SLOPE = "The walk leads over no stair and no ramp, so there is no slope to compare the height objective on."
NO_HEIGHT = "The height objective has no weight, so there is nothing to compare on a slope."

_STEP_M = 0.05
_RUN_M = 0.5  # a floor that rises by less than _RISE_M over this length counts as flat
_RISE_M = 0.03
_LEAST_RISE_M = 0.3  # less is a door sill or a step
_BESIDE_M = 1.5  # flat floor shown before and behind


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class EyeOnSlope:
    """One walk over the slope, against the horizontal way of the walk with all objectives."""

    name: str
    eye_z: NDArray[np.float64]  # (n,) [m]
    height_m: NDArray[np.float64]  # (n,) above the floor, stairs evened out; nan where there is none
    mean_error_m: float  # of the height, on the slope itself
    largest_error_m: float


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class SlopeComparison:
    """The longest slope of the walk."""

    way_m: NDArray[np.float64]  # (n,) horizontal way, 0 where the slope begins
    floor_z: NDArray[np.float64]  # (n,) stairs evened out
    surface_z: NDArray[np.float64]  # (n,) of the exact geometry straight below
    eye_height_m: float  # the wished one
    rise_m: float
    run_m: float
    eyes: tuple[EyeOnSlope, ...]  # with the height objective, and without


def compare_on_slope(building: Building, variants: tuple[Variant, ...]) -> SlopeComparison | str:
    """Returns the comparison on the longest slope, or why there is none."""
    by_name = {variant.name: variant for variant in variants}
    if "height" not in by_name:
        return NO_HEIGHT
    eyes = every(by_name[ALL].points, _STEP_M)
    tall = building.walker.eye_height_m
    floor = building.surface.floor_z(eyes, tall)
    begin, end = _longest_slope(floor)
    if end <= begin or abs(floor[end] - floor[begin]) < _LEAST_RISE_M:
        return NO_SLOPE
    beside = round(_BESIDE_M / _STEP_M)
    shown = slice(max(begin - beside, 0), min(end + beside + 1, len(eyes)))
    flat = eyes[shown] * [1.0, 1.0, 0.0]
    way = walked_m(flat)
    way -= way[begin - shown.start]
    slope = (way >= 0.0) & (way <= way[end - shown.start])
    found = (_beside(eyes[shown], by_name[name].points) for name in (ALL, "height"))
    return SlopeComparison(
        way_m=way,
        floor_z=floor[shown],
        surface_z=eyes[shown, 2] - building.geometry.height_above_floor(eyes[shown]),
        eye_height_m=tall,
        rise_m=float(floor[end] - floor[begin]),
        run_m=float(way[slope].max()),
        eyes=tuple(
            _eye(name, other[:, 2], floor[shown], tall, slope)
            for name, other in zip(("with", "without"), found, strict=True)
        ),
    )


def _longest_slope(floor: NDArray[np.float64]) -> tuple[int, int]:
    """Returns the first and the last index of the run over which the floor keeps rising, or falling, the most."""
    reach = round(_RUN_M / _STEP_M)
    ahead = np.concatenate([floor[reach:], np.full(min(reach, len(floor)), floor[-1])])[: len(floor)]
    best = (0, 0)
    for sign in (1.0, -1.0):
        rising = sign * (ahead - floor) > _RISE_M
        edges = np.flatnonzero(np.diff(np.concatenate([[False], rising, [False]]).astype(np.int8)))
        for a, b in edges.reshape(-1, 2).tolist():
            run = (a, min(b + reach - 1, len(floor) - 1))
            if abs(floor[run[1]] - floor[run[0]]) > abs(floor[best[1]] - floor[best[0]]):
                best = run
    return best


def _beside(eyes: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the points of a path that are nearest to the eyes (n, 3)."""
    fine = every(points, 0.01)
    return np.asarray(fine[cKDTree(fine).query(eyes)[1]])


def _eye(
    name: str, eye_z: NDArray[np.float64], floor: NDArray[np.float64], tall: float, slope: NDArray[np.bool_]
) -> EyeOnSlope:
    # The floor is that below the walk with all objectives: beside an eye that is far too high there may be another.
    height = eye_z - floor
    error = np.abs(height - tall)[slope]
    error = error[np.isfinite(error)]
    return EyeOnSlope(
        name=name,
        eye_z=eye_z,
        height_m=height,
        mean_error_m=float(error.mean()) if len(error) else float("nan"),
        largest_error_m=float(error.max()) if len(error) else float("nan"),
    )
