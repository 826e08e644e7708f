# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk bench [STAGE]`: what the stages cost, side by side with the plain way, as JSON.

Each of a stage's times is the median over the repeats, after one run that loads compiled code and is reported as
`first_run_s`. The plain ways run in the same process right after: what they cost is measured, or measured on a
sample and extrapolated, and then said to be so.
"""

from __future__ import annotations

import argparse
import json
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

from walk_building.building import Building
from walk_building.errors import WalkError
from walk_building.pipeline import load_building
from walk_building.progress import no_progress
from walk_importance.bench import bench as bench_importance
from walk_importance.bench import growth
from walk_importance.visibility import Scene
from walk_importance.visibility.rays import count_voxel_rays
from walk_plan.along import every
from walk_plan.options import PlanConfig
from walk_plan.pipeline import make_walkthrough
from walk_plan.stages import StageClock, peak_memory_mib
from walk_plan.summary import as_plain, versions
from walk_plan.walkthrough import Walkthrough
from walk_sequencer.bench import bench as bench_tour
from walk_sequencer.bench_order import fifty, order_gaps
from walk_trajopt.bench import bench_trajectory

RAY_SOURCES = 64
"""Free voxels whose rays are cast one by one; the time for all is extrapolated."""

CLOSEST_POINTS = 300
"""Points along the path whose closest points are asked for; the same ones of both ways."""

ORDER_SEED = 5000
"""Where the instances of the order's gaps begin; no setting of the search was chosen by one of them."""


def bench_plan(path: Path, repeats: int) -> dict[str, Any]:
    """Returns the time of each stage of a plan, and the plain ways beside them."""
    runs = [_stages(path) for _ in range(repeats + 1)]
    walkthrough = runs[-1][0]
    stages = {stage: statistics.median(seconds[stage] for _, seconds in runs[1:]) for stage in runs[0][1]}
    return {
        "building": {"file": path.name, "triangles": len(walkthrough.building.model.faces)},
        "repeats": repeats,
        "first_run_s": runs[0][1],
        "stages_s": stages,
        "total_s": sum(stages.values()),
        "peak_memory_mib": peak_memory_mib(),
        "plain": {
            "rays_one_by_one": _rays(walkthrough, stages["importance"]),
            "closest_points": _closest_points(walkthrough, repeats),
            **_other_walks(walkthrough),
        },
    }


def _stages(path: Path) -> tuple[Walkthrough, dict[str, float]]:
    clock = StageClock(no_progress)
    walkthrough = make_walkthrough(path, PlanConfig(), clock)
    return walkthrough, dict(clock.seconds)


def _rays(walkthrough: Walkthrough, importance_s: float) -> dict[str, Any]:
    """The source's way to the visibility map: a compiled scalar ray for each pair of free voxels."""
    importance_map = walkthrough.importance_map
    free = importance_map.obstacle == 0.0
    sources = np.random.default_rng(0).permutation(np.argwhere(free))
    scene = Scene.of(importance_map.grid, free)
    count_voxel_rays(scene, sources[:2])
    asked = sources[:RAY_SOURCES]
    started = time.perf_counter()
    count_voxel_rays(scene, asked)
    seconds = (time.perf_counter() - started) * len(sources) / len(asked)
    return {
        "free_voxels": len(sources),
        "extrapolated_from_sources": len(asked),
        "plain_s": seconds,
        "ours_s": importance_s,
        "ratio": seconds / importance_s,
    }


def _closest_points(walkthrough: Walkthrough, repeats: int) -> dict[str, Any]:
    geometry = walkthrough.building.geometry
    path = walkthrough.path.points
    points = every(path, walkthrough.quality.length_m / CLOSEST_POINTS)
    mesh = trimesh.Trimesh(geometry.vertices, geometry.faces, process=False)
    plain = _median_s(lambda: trimesh.proximity.closest_point(mesh, points), repeats)
    ours = _median_s(lambda: geometry.closest(points), repeats)
    difference = trimesh.proximity.closest_point(mesh, points)[1] - geometry.closest(points).distance_m
    return {
        "points": len(points),
        "plain_s": plain,
        "ours_s": ours,
        "ratio": plain / ours,
        "largest_difference_m": float(np.abs(difference).max()),
    }


def _other_walks(walkthrough: Walkthrough) -> dict[str, Any]:
    """The walks that ours is compared with, as ratios to ours."""
    ours = walkthrough.quality
    return {
        other.name: {
            "length_m": other.length_m,
            "length_ratio": other.length_m / ours.length_m,
            "colliding_segments": other.colliding_segments,
            "segments": other.segments,
            "ours_length_m": ours.length_m,
            "ours_colliding_segments": ours.colliding_segments,
        }
        for other in walkthrough.qualities[1:]
    }


def _median_s(run: Callable[[], object], repeats: int) -> float:
    run()
    seconds = []
    for _ in range(repeats):
        started = time.perf_counter()
        run()
        seconds.append(time.perf_counter() - started)
    return statistics.median(seconds)


def _bench_load(path: Path, repeats: int) -> dict[str, Any]:
    found: list[Building] = []
    seconds = _median_s(lambda: found.append(load_building(path)), repeats)
    building = found[-1]
    return {"file": path.name, "load_s": seconds, "places": len(building.surface.places), "rooms": len(building.rooms)}


def _bench_tour(path: Path, repeats: int) -> dict[str, Any]:
    walkthrough = _stages(path)[0]
    figures = bench_tour(walkthrough.building, walkthrough.suggestion.positions)
    made_up = {"order": order_gaps(ORDER_SEED)}
    return {**figures, "fifty": fifty(walkthrough.building, ORDER_SEED, repeats), **made_up}


def _bench_trajectory(path: Path, repeats: int) -> dict[str, Any]:
    walkthrough = _stages(path)[0]
    edits = 10 * repeats
    return dict(bench_trajectory(walkthrough.building, walkthrough.tour.polyline, walkthrough.keypoints, edits=edits))


def _bench_importance(path: Path, repeats: int) -> dict[str, Any]:
    del path, repeats  # its scene is made up, so that its figures do not depend on a file
    return bench_importance()


def _bench_growth(path: Path, repeats: int) -> dict[str, Any]:
    del path, repeats
    return {"visibility": growth()}


BENCHES: dict[str, Callable[[Path, int], dict[str, Any]]] = {
    "plan": bench_plan,
    "load": _bench_load,
    "importance": _bench_importance,
    "growth": _bench_growth,
    "tour": _bench_tour,
    "trajectory": _bench_trajectory,
}
"""The measurements by name; `plan` has all stages."""


def main(arguments: list[str] | None = None) -> int:
    """Runs a measurement and prints it as JSON; returns the exit code."""
    parser = argparse.ArgumentParser(prog="./walk bench", description="Measure the stages; prints JSON.")
    parser.add_argument("stage", nargs="?", default="plan", choices=list(BENCHES), help="what to measure")
    parser.add_argument("building", nargs="?", type=Path, metavar="BUILDING", help="its file (default: the sample)")
    parser.add_argument("--building", dest="named", type=Path, metavar="BUILDING", help="the same")
    parser.add_argument("--repeats", type=int, default=3, help="runs whose median counts, at least 1")
    options = parser.parse_intermixed_args(arguments)
    try:
        figures = BENCHES[options.stage](options.named or options.building or _sample(), max(options.repeats, 1))
    except WalkError as error:
        sys.stderr.write(f"walk: {error}\n")
        return 2
    report = {"bench": options.stage, "versions": versions(), **figures}
    sys.stdout.write(json.dumps(as_plain(report), indent=1) + "\n")
    return 0


def _sample() -> Path:
    # Imported late: walk_bringup is built on this package, and only this default needs it.
    from walk_bringup.sample.location import sample_path

    return sample_path()


if __name__ == "__main__":
    sys.exit(main())
