# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What the trajectory costs, beside the plain way: SciPy's L-BFGS-B, with closest points by trimesh or by our tree."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable

import numpy as np
import trimesh
from numpy.typing import ArrayLike, NDArray

from walk_building.building import Building
from walk_building.geometry import Closest, Geometry
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.optimiser import Optimiser
from walk_trajopt.polyline import as_polyline_points
from walk_trajopt.problem import Problem
from walk_trajopt.solvers import SOLVERS
from walk_trajopt.timing import time_path

_REACH_M = 0.1  # by which a measured edit moves its keypoint, at most, along x and along y
_LONG = 20_000  # iterations: the reference runs until it converges


class _PlainGeometry(Geometry):
    """The same geometry, its closest points by trimesh and rtree."""

    def __init__(self, geometry: Geometry) -> None:
        self.vertices, self.faces, self.bvh = geometry.vertices, geometry.faces, geometry.bvh
        self._mesh = trimesh.Trimesh(geometry.vertices, geometry.faces, process=False)

    def closest(self, points: ArrayLike, max_distance_m: float = np.inf) -> Closest:
        found, distance, face = trimesh.proximity.closest_point(self._mesh, np.asarray(points))
        beyond = distance > max_distance_m
        return Closest(
            points=np.where(beyond[:, None], np.nan, found),
            distance_m=np.where(beyond, np.inf, distance),
            face=np.where(beyond, -1, face).astype(np.int32),
        )


def bench_trajectory(
    building: Building,
    polyline: ArrayLike,
    keypoints: ArrayLike,
    config: TrajoptConfig | None = None,
    edits: int = 50,
    plain: bool = True,
    compared: int = 30,
) -> dict[str, float]:
    """Returns times in milliseconds, iterations, costs and ratios, by name.

    A warm edit is timed as a whole: bent, solved, swept, repaired. What it is compared with solves the very same
    problem from the same start, with the same cost, by SciPy's L-BFGS-B and does nothing else.

    Args:
        building: Where to walk.
        polyline: (L, 3) the planned tour [m].
        keypoints: (M, 3) in its order [m].
        config: The problem; its solver is the one that is measured.
        edits: How many random moves of up to 0.1 m the warm edit is measured over; their median counts.
        plain: Measure closest points by trimesh, too; it takes minutes on a large building.
        compared: How many of the edits the references solve, too: the medians of the ratios of time, the largest ratio
            of cost and how many of these are above 1.01 are told.
    """
    config = config or TrajoptConfig()
    optimiser = Optimiser(building, polyline, keypoints, config)
    _solved(optimiser)  # compiles
    out: dict[str, float] = {"points": float(len(optimiser.state.x))}
    out["solve_ms"] = _median(optimiser.solve)
    out["cost"] = optimiser.path().total_cost
    out["check_ms"] = _median(optimiser.check)
    path = optimiser.path()
    time_path(path)
    out["timing_ms"] = _median(lambda: time_path(path))
    for name in SOLVERS:
        other = Optimiser(building, polyline, keypoints, dataclasses.replace(config, solver=name))
        out[f"solve_{name}_ms"] = _median(other.solve, 1)
        solved = other.path()
        out[f"cost_{name}"], out[f"iterations_{name}"] = solved.total_cost, float(solved.iterations)
    stops = as_polyline_points("keypoints", keypoints, 0)
    times, accepted = _edits(optimiser, stops, edits)
    out.update(edit_p50_ms=float(np.median(times)), edit_p99_ms=float(np.percentile(times, 99)))
    out["edit_and_timing_p50_ms"] = out["edit_p50_ms"] + out["timing_ms"]
    out["edits_accepted"] = accepted
    ways = {"bvh": building} | (
        {"trimesh": dataclasses.replace(building, geometry=_PlainGeometry(building.geometry))} if plain else {}
    )
    for name, place in ways.items():
        out.update(_against(name, optimiser, place, config, polyline, stops, compared, out))
    return out


def _against(
    name: str,
    optimiser: Optimiser,
    place: Building,
    config: TrajoptConfig,
    polyline: ArrayLike,
    stops: NDArray[np.float64],
    compared: int,
    own: dict[str, float],
) -> dict[str, float]:
    """Returns what the reference needs on a building whose closest points are found its way."""
    lbfgs = dataclasses.replace(config, solver="lbfgs", max_iterations=_LONG)
    out: dict[str, float] = {}
    whole = Optimiser(place, polyline, stops, lbfgs)
    out[f"{name}_solve_ms"] = _median(whole.solve, 1)
    out[f"{name}_over_solve"] = out[f"{name}_solve_ms"] / max(own["solve_ms"], 1e-9)
    out[f"solve_cost_over_{name}"] = own["cost"] / max(whole.path().total_cost, 1e-9)
    random = np.random.default_rng(1)
    ours, theirs, costs = [], [], []
    for _ in range(compared):
        k, there = _move(random, stops)
        seen: list[tuple[Problem, NDArray[np.float64], float]] = []
        optimiser.pieces.watch = lambda problem, start, cost, seen=seen: seen.append((problem, start, cost))
        started = time.perf_counter()
        optimiser.move_keypoint(k, there)
        ours.append(time.perf_counter() - started)
        optimiser.pieces.watch = None
        problem, start, cost = seen[0]
        setting = dataclasses.replace(problem.setting, geometry=place.geometry)
        plain = Problem(setting, config, problem.fixed)
        started = time.perf_counter()
        solution = SOLVERS["lbfgs"](plain, start, lbfgs)
        theirs.append(time.perf_counter() - started)
        costs.append(cost / max(solution.cost, 1e-9))
    out[f"{name}_edit_ms"] = 1e3 * float(np.median(theirs))
    out[f"{name}_over_edit"] = float(np.median(np.array(theirs) / np.array(ours)))
    out[f"edit_cost_over_{name}_median"] = float(np.median(costs))
    out[f"edit_cost_over_{name}_max"] = float(np.max(costs))
    out[f"edits_1_percent_worse_than_{name}"] = float(np.count_nonzero(np.array(costs) > 1.01))
    return out


def _solved(optimiser: Optimiser) -> None:
    optimiser.solve()
    optimiser.check()


def _median(run: Callable[[], object], repeats: int = 5) -> float:
    """Returns the median time of some runs [ms]."""
    times = []
    for _ in range(repeats):
        started = time.perf_counter()
        run()
        times.append(1e3 * (time.perf_counter() - started))
    return float(np.median(times))


def _move(random: np.random.Generator, stops: NDArray[np.float64]) -> tuple[int, NDArray[np.float64]]:
    k = int(random.integers(len(stops)))
    return k, stops[k] + [*random.uniform(-_REACH_M, _REACH_M, 2), 0.0]


def _edits(optimiser: Optimiser, stops: NDArray[np.float64], edits: int) -> tuple[NDArray[np.float64], float]:
    random = np.random.default_rng(0)
    times, accepted = np.zeros(edits), 0
    for i in range(edits):
        k, there = _move(random, stops)
        started = time.perf_counter()
        accepted += optimiser.move_keypoint(k, there).accepted
        times[i] = 1e3 * (time.perf_counter() - started)
    return times, accepted / max(edits, 1)
