# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What the importance node's answers cost over real DDS: another cone, a later start, a map of a million voxels.

`python -m walk_ros.live_bench.maps BUILDING…` prints JSON. The process that listens is there before, as viewers are.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from walk_building.errors import WalkError
from walk_ros.live_bench.figures import summary_ms
from walk_ros.live_bench.hand import BenchError
from walk_ros.live_bench.map_listener import LATER_S, MAP, SUGGESTED, Listener
from walk_ros.live_bench.map_node import SHAPE
from walk_ros.live_bench.processes import Processes, take_own_domain

_FIRST_S = 400.0  # until the maps of a building are computed
_RADII_M = (3.0, 4.0)  # taken in turns


def measure(building: str, cache: Path, starts: int, cones: int) -> dict[str, Any]:
    """Returns the figures of one building.

    Args:
        building: Path.
        cache: Folder of computed maps; what is not in it is computed by a start that does not count.
        starts: Later starts.
        cones: Changes of the cone, all of one process.
    """
    listener = Listener()
    report: dict[str, Any] = {"building": Path(building).name}
    try:
        with _node(listener, building, cache, _FIRST_S):
            listener.wait(lambda: listener.state() == "ready", "the building", _FIRST_S)
            if cones:
                report |= _cones(listener, cones)
        later: dict[str, list[float]] = {MAP: [], SUGGESTED: []}
        for _ in range(starts):
            with _node(listener, building, cache, LATER_S) as began:
                for topic, seconds in later.items():
                    seconds.append(listener.heard_s[topic][0] - began)
        return report | {f"later_start_to_{topic}_ms": summary_ms(seconds) for topic, seconds in later.items()}
    finally:
        listener.close()


def million() -> dict[str, Any]:
    """Returns what it costs to publish a map of a million voxels, and until another process has it whole."""
    listener = Listener()
    command = [sys.executable, "-m", "walk_ros.live_bench.map_node"]
    try:
        with subprocess.Popen(command, stdout=subprocess.PIPE) as node:
            listener.wait(lambda: node.poll() is not None, "the maps", LATER_S)
            listener.pause(0.5)
            times = json.loads(node.stdout.read()) if node.stdout and not node.returncode else []
    finally:
        listener.close()
    heard = listener.heard_s[MAP]
    if not times or len(heard) != len(times):
        raise BenchError(f"{len(heard)} of {len(times)} maps came in; measure again on a machine that is less busy")
    return {
        "voxels": math.prod(SHAPE),
        "published_ms": summary_ms([done - began for began, done in times]),
        "received_ms": summary_ms([at - began for at, (began, _) in zip(heard, times, strict=True)]),
    }


def _cones(listener: Listener, count: int) -> dict[str, Any]:
    maps = len(listener.heard_s[MAP])
    seconds = [listener.set_cone(_RADII_M[k % 2]) for k in range(count)]
    listener.pause(0.3)
    return {
        "another_cone_ms": summary_ms(seconds),
        "another_cone_the_first_ms": round(1e3 * seconds[0], 1),
        "maps_published_again": len(listener.heard_s[MAP]) - maps,
    }


@contextmanager
def _node(listener: Listener, building: str, cache: Path, limit_s: float) -> Iterator[float]:
    """Starts the node and waits for its map and suggestions; yields when it was started [s] and ends it."""
    with tempfile.TemporaryDirectory(prefix="walk_bench_") as folder:
        processes = Processes(Path(folder))
        listener.pause(0.5)
        listener.forget()
        began = time.perf_counter()
        try:
            processes.start("importance", {"building": building, "cache_dir": cache})
            listener.wait(lambda: listener.heard_s[MAP] and listener.heard_s[SUGGESTED], "the suggestions", limit_s)
            yield began
        finally:
            processes.close()


def main(arguments: Sequence[str] | None = None) -> int:
    """Measures and prints; returns the exit code: 2 where the input cannot be used."""
    parser = argparse.ArgumentParser(prog="python -m walk_ros.live_bench.maps", description=__doc__)
    parser.add_argument("buildings", nargs="*", metavar="BUILDING")
    parser.add_argument("--cache", type=Path, help="folder of computed maps to begin with and to keep")
    parser.add_argument("--starts", type=int, default=9, help="later starts of each building (default: %(default)s)")
    parser.add_argument("--cones", type=int, default=10, help="changes of the cone (default: %(default)s)")
    parser.add_argument("--million", action="store_true", help="publish a map of a million voxels too")
    given = parser.parse_args(arguments)
    take_own_domain()
    report: dict[str, Any] = {}
    try:
        with tempfile.TemporaryDirectory(prefix="walk_bench_") as folder:
            for building in given.buildings:
                if not Path(building).is_file():
                    raise BenchError(f"{building}: there is no such building")
                cache = given.cache or Path(folder)
                report[Path(building).name] = measure(building, cache, given.starts, given.cones)
        if given.million:
            report["million"] = million()
    except WalkError as error:
        sys.stderr.write(f"walk: {error}\n")
        return 2
    sys.stdout.write(json.dumps(report, indent=2) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
