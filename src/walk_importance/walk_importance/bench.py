# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Measures visibility against the source's way, one ray after the other, in the same run on the same machine."""

from __future__ import annotations

import os
import time
import tracemalloc
from typing import Any

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_importance.config import ImportanceConfig
from walk_importance.distance import distance_map
from walk_importance.grid import VoxelGrid
from walk_importance.pipeline import visibility_scene
from walk_importance.visibility import MODES, Scene
from walk_importance.visibility.counter import PairCounter
from walk_importance.visibility.exact import half_space, nth_displacements
from walk_importance.visibility.rays import count_triangle_rays, count_voxel_rays

_WARM = (12, 10, 6)


def rooms_scene(voxels: int) -> Scene:
    """Returns a made-up building of two storeys of rooms with doors and clutter, with about this many voxels.

    Its proportions are 20 x 16 x 6 m; rooms keep their size in metres while the voxels get smaller.
    """
    h = (20 * 16 * 6 / voxels) ** (1 / 3)
    shape = (round(20 / h), round(16 / h), round(6 / h))
    blocked = np.zeros(shape, bool)
    thick = max(1, round(0.25 / h))

    def at(metres: float) -> int:
        return round(metres / h)

    for wall in (0.0, 5.0, 10.0, 15.0):
        blocked[at(wall) : at(wall) + thick] = True
    for wall in (0.0, 5.3, 10.6):
        blocked[:, at(wall) : at(wall) + thick] = True
    for door in (2.0, 7.0, 13.0):
        for floor in (0.0, 3.0):
            blocked[:, at(door) : at(door + 1.0), at(floor + 0.3) : at(floor + 2.3)] = False
            blocked[at(door + 0.5) : at(door + 1.5), :, at(floor + 0.3) : at(floor + 2.3)] = False
    blocked[-thick:] = blocked[:thick] = blocked[:, -thick:] = blocked[:, :thick] = True
    blocked[:, :, :thick] = blocked[:, :, -thick:] = blocked[:, :, at(3.0) : at(3.0) + thick] = True
    rng = np.random.default_rng(1)
    for x, y, storey in rng.random((40, 3)) * (19.0, 15.0, 2.0):
        low = at(3.0 * int(storey))
        blocked[at(x) : at(x + 0.8), at(y) : at(y + 0.6), low : low + at(1.0)] = True
    return Scene.of(VoxelGrid(origin=np.zeros(3), voxel_size_m=h, shape=shape), ~blocked)


def bench(free_voxels: int = 100_000, ray_sources: int = 500, memory_voxels: int = 8_000_000) -> dict[str, Any]:
    """Returns the figures of visibility as JSON can hold them.

    Rays are cast for `ray_sources` voxels drawn at random, to all free voxels, and their time is extrapolated to
    all; the same rays are the truth that the correlation and the bias are against.
    """
    _compile()
    scene = rooms_scene(round(free_voxels * 1.25))
    rays = _rays(scene, ray_sources)
    exact = _exact(scene, rays)
    return {
        "machine": {"cores": len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()},
        "grid": {"voxels": scene.grid.size, "free": int(scene.free.sum())},
        "rays": {k: v for k, v in rays.items() if not isinstance(v, np.ndarray)},
        "exact": {k: v for k, v in exact.items() if not isinstance(v, np.ndarray)},
        "progressive": _progressive(scene, exact),
        "memory": _memory(memory_voxels) if memory_voxels else {},
        "ratio": {"exact_over_rays": rays["seconds"] / exact["seconds"]},
    }


def bench_building(building: Building, voxel_size_m: float = 0.25, ray_sources: int = 40) -> dict[str, Any]:
    """Returns how the exact map of a building's voxels compares with rays on its triangles.

    Rays are cast for `ray_sources` voxels drawn at random, to all free voxels, and their time is extrapolated. Voxels
    are thicker than walls and furniture, so they hide more: that is the bias.
    """
    _compile()
    scene = visibility_scene(building, ImportanceConfig(voxel_size_m=voxel_size_m))
    every = np.argwhere(scene.free)
    sources = every[np.random.default_rng(0).permutation(len(every))[:ray_sources]]
    count_triangle_rays(scene, sources[:1])
    start = time.perf_counter()
    by_rays = count_triangle_rays(scene, sources) / (len(every) - 1.0)
    rays_s = (time.perf_counter() - start) * len(every) / len(sources)
    start = time.perf_counter()
    (view,) = MODES["exact"](scene)
    exact_s = time.perf_counter() - start
    by_voxels = view.share[tuple(sources.T)].astype(float)
    return {
        "grid": {"voxels": scene.grid.size, "free": len(every)},
        "triangle_rays": {"seconds": rays_s, "extrapolated_from_sources": len(sources)},
        "exact": {
            "seconds": exact_s,
            "correlation_with_triangle_rays": float(np.corrcoef(by_voxels, by_rays)[0, 1]),
            "bias_share_of_free_space": float(np.mean(by_voxels - by_rays)),
        },
        "ratio": {"exact_over_triangle_rays": rays_s / exact_s},
    }


def growth(sizes: tuple[int, ...] = (10_000, 30_000, 100_000, 300_000, 1_000_000, 10_000_000)) -> list[dict[str, Any]]:
    """Returns, for grids of growing size, the seconds to the first map, to an error of 0.1, and to the exact map.

    The exact time is measured up to 400,000 voxels and above extrapolated from displacements drawn at random.
    """
    _compile()
    found = []
    for size in sizes:
        scene = rooms_scene(size)
        start = time.perf_counter()
        first = good = np.nan
        for view in MODES["progressive"](scene):
            good = time.perf_counter() - start
            first = good if np.isnan(first) else first
            if view.stderr <= 0.1 * view.spread:
                break
        seconds, measured = _exact_seconds(scene)
        found.append(
            {
                "voxels": scene.grid.size,
                "free": int(scene.free.sum()),
                "first_map_s": first,
                "error_0.1_s": good,
                "exact_s": seconds,
                "exact_measured": measured,
            }
        )
    return found


def _compile() -> None:
    scene = Scene.of(VoxelGrid(origin=np.zeros(3), voxel_size_m=1.0, shape=_WARM), np.ones(_WARM, bool))
    for mode in ("exact", "progressive", "voxel_rays"):
        for _ in MODES[mode](scene):
            pass
    distance_map(scene.grid, ~scene.free, 2.0)


def _rays(scene: Scene, number: int) -> dict[str, Any]:
    every = np.argwhere(scene.free)
    sources = every[np.random.default_rng(0).permutation(len(every))[:number]]
    start = time.perf_counter()
    seen = count_voxel_rays(scene, sources)
    seconds = (time.perf_counter() - start) * len(every) / len(sources)
    return {
        "seconds": seconds,
        "extrapolated_from_sources": len(sources),
        "pairs_per_s": len(every) * (len(every) - 1.0) / seconds,
        "sources": sources,
        "share": seen / (len(every) - 1.0),
    }


def _exact(scene: Scene, rays: dict[str, Any]) -> dict[str, Any]:
    start = time.perf_counter()
    (view,) = MODES["exact"](scene)
    seconds = time.perf_counter() - start
    share = view.share[tuple(rays["sources"].T)].astype(float)
    n = float(scene.free.sum())
    return {
        "seconds": seconds,
        "pairs_per_s": n * (n - 1) / seconds,
        "correlation_with_rays": float(np.corrcoef(share, rays["share"])[0, 1]),
        "bias_share_of_free_space": float(np.mean(share - rays["share"])),
        "share": view.share,
    }


def _progressive(scene: Scene, exact: dict[str, Any]) -> dict[str, Any]:
    truth = exact["share"][scene.free]
    steps: list[dict[str, float]] = []
    seconds = 0.0
    maps = MODES["progressive"](scene)
    while not steps or steps[-1]["correlation"] < 0.999:
        start = time.perf_counter()
        view = next(maps)
        seconds += time.perf_counter() - start
        share = view.share[scene.free]
        steps.append(
            {
                "seconds": seconds,
                "done": view.done,
                "stderr": view.stderr,
                "actual_error": float(np.sqrt(np.mean((share - truth) ** 2))),
                "correlation": float(np.corrcoef(share, truth)[0, 1]),
            }
        )
    good = next(step["seconds"] for step in steps if step["correlation"] >= 0.99)
    return {
        "first_map_s": steps[0]["seconds"],
        "seconds_to_correlation_0.99": good,
        "share_of_exact_time": good / exact["seconds"],
        "steps": steps,
    }


def _exact_seconds(scene: Scene) -> tuple[float, bool]:
    if scene.grid.size <= 400_000:
        start = time.perf_counter()
        list(MODES["exact"](scene))
        return time.perf_counter() - start, True
    counter = PairCounter(scene)
    counts = counter.new_counts()
    total = half_space(counter.layout.shape)
    drawn = np.sort(np.random.default_rng(0).integers(0, total, 2000 * counter.threads))
    every = [nth_displacements(i, i + 1, np.array(counter.layout.shape)) for i in drawn]
    chosen: NDArray[np.int64] = np.concatenate(every)
    start = time.perf_counter()
    counter.add(chosen, counts)
    return (time.perf_counter() - start) * total / len(chosen), False


def _memory(voxels: int) -> dict[str, float]:
    """Peak of what the maps of one grid hold at once; arrays are traced, so the interpreter itself is left out."""
    tracemalloc.start()
    try:
        scene = rooms_scene(voxels)
        distance = distance_map(scene.grid, ~scene.free, 2.0)
        maps = MODES["progressive"](scene)
        kept = [next(maps), next(maps), distance]
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert len(kept) == 3
    return {"voxels": scene.grid.size, "peak_bytes_a_voxel": peak / scene.grid.size}
