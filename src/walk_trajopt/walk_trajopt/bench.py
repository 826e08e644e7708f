# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What the trajectory costs, beside the plain way: SciPy's L-BFGS-B with closest points by trimesh."""

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
from walk_trajopt.solvers import SOLVERS
from walk_trajopt.timing import time_path


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
) -> dict[str, float]:
    """Returns times in milliseconds, iterations and costs, by name.

    Args:
        building: Where to walk.
        polyline: (L, 3) the planned tour [m].
        keypoints: (M, 3) in its order [m].
        config: The problem; its solver is the one that is measured.
        edits: How many random moves of up to 0.1 m the warm edit is measured over; their median counts.
        plain: Measure the plain way, too; it takes minutes on a large building.
    """
    config = config or TrajoptConfig()
    optimiser = Optimiser(building, polyline, keypoints, config)
    _solved(optimiser)  # compiles
    out: dict[str, float] = {"points": float(len(optimiser.state.x))}
    out["solve_ms"] = _milliseconds(optimiser.solve)
    out["check_ms"] = _milliseconds(optimiser.check)
    path = optimiser.path()
    time_path(path)
    out["timing_ms"] = _milliseconds(lambda: time_path(path))
    out.update(cost=path.total_cost, iterations=float(path.iterations), evaluations=float(path.evaluations))
    for name in SOLVERS:
        other = Optimiser(building, polyline, keypoints, dataclasses.replace(config, solver=name))
        out[f"solve_{name}_ms"] = _milliseconds(other.solve)
        out[f"cost_{name}"] = other.check().total_cost
    times, accepted = _edits(optimiser, as_polyline_points("keypoints", keypoints, 0), edits)
    out.update(edit_p50_ms=float(np.median(times)), edit_p99_ms=float(np.percentile(times, 99)))
    out["edits_accepted"] = accepted
    if plain:
        slow = dataclasses.replace(building, geometry=_PlainGeometry(building.geometry))
        reference = Optimiser(slow, polyline, keypoints, dataclasses.replace(config, solver="lbfgs"))
        out["plain_solve_ms"] = _milliseconds(reference.solve)
        out["plain_over_solve"] = out["plain_solve_ms"] / out["solve_ms"]
        out["plain_over_edit"] = out["plain_solve_ms"] / out["edit_p50_ms"]
    return out


def _solved(optimiser: Optimiser) -> None:
    optimiser.solve()
    optimiser.check()


def _milliseconds(run: Callable[[], object]) -> float:
    started = time.perf_counter()
    run()
    return 1e3 * (time.perf_counter() - started)


def _edits(optimiser: Optimiser, keypoints: NDArray[np.float64], edits: int) -> tuple[NDArray[np.float64], float]:
    random = np.random.default_rng(0)
    times, accepted = np.zeros(edits), 0
    for i in range(edits):
        k = int(random.integers(len(keypoints)))
        place = keypoints[k] + [*random.uniform(-0.1, 0.1, 2), 0.0]
        started = time.perf_counter()
        accepted += optimiser.move_keypoint(k, place).accepted
        times[i] = 1e3 * (time.perf_counter() - started)
    return times, accepted / max(edits, 1)
