# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The files of a plan: a writer for each, by the name of the file."""

from __future__ import annotations

import dataclasses
import json
import time
from collections.abc import Callable
from pathlib import Path

from walk_bag.exports.glb import write_glb
from walk_bag.exports.ride import Ride
from walk_bag.exports.trajectory_csv import write_trajectory_csv
from walk_bag.walkthrough import walkthrough_messages, write_walkthrough_bag
from walk_building.progress import Progress, no_progress
from walk_plan.compare.comparison import Comparison, write_figures
from walk_plan.compare.page import write_page
from walk_plan.report import write_report
from walk_plan.summary import summary
from walk_plan.walkthrough import Walkthrough

MARKER = "report.json"
"""Written last: a folder that has it holds a complete plan."""

STAMP_NS = 0
"""When the recorded walk begins: the same plan gives the same bag."""


def write_tour_bag(path: Path, walkthrough: Walkthrough) -> None:
    """Writes what the nodes would publish for the walk as one MCAP file."""
    building, suggestion = walkthrough.building, walkthrough.suggestion
    rooms = [building.rooms[room].name if room >= 0 else "" for room in suggestion.room]
    messages = walkthrough_messages(
        importance_map=walkthrough.importance_map,
        floors_z=[storey.elevation_m for storey in building.storeys],
        eye_height_m=building.walker.eye_height_m,
        positions=suggestion.positions,
        quat_xyzw=suggestion.quat_xyzw,
        labels=rooms,
        tour=walkthrough.tour,
        trajectory=walkthrough.trajectory,
        stamp_ns=STAMP_NS,
        building=_named(walkthrough),
    )
    write_walkthrough_bag(path, messages)


def _named(walkthrough: Walkthrough) -> dict[str, str]:
    """Returns what `walk_bag.imports.recorded_building` needs to find the building again, and to see it changed."""
    model, load = walkthrough.building.model, walkthrough.config.load
    return {
        "building": str(model.source.resolve()),
        "building_hash": walkthrough.building.hash,
        "content_hash": model.content_hash,
        "load": json.dumps(dataclasses.asdict(load)),
        "offset_m": json.dumps(model.offset_m.tolist()),
    }


def ride_of(walkthrough: Walkthrough) -> Ride:
    """Returns the walk as the exports take it."""
    building, trajectory = walkthrough.building, walkthrough.trajectory
    return Ride(
        t_s=trajectory.t_s,
        positions=trajectory.positions,
        quat_xyzw=trajectory.quat_xyzw,
        stop=trajectory.stop,
        keypoints=walkthrough.keypoints,
        offset_m=building.model.offset_m,
        model=building.model,
        building_name=building.model.source.name,
        building_hash=building.hash,
    )


WRITERS: dict[str, Callable[[Path, Walkthrough], None]] = {
    "tour.mcap": write_tour_bag,
    "trajectory.csv": lambda path, walkthrough: write_trajectory_csv(path, ride_of(walkthrough)),
    "walkthrough.glb": lambda path, walkthrough: write_glb(path, ride_of(walkthrough)),
}
"""Writers of everything but the report, which is written last because it tells what the others cost."""


COMPARISON_WRITERS: dict[str, Callable[[Path, Comparison], None]] = {
    "compare.html": write_page,
    "compare.json": write_figures,
}
"""Writers of what a plan writes only where it is asked to compare."""


def write_comparison(comparison: Comparison, folder: Path) -> None:
    """Writes all files of a comparison into an existing folder."""
    for name, write in COMPARISON_WRITERS.items():
        write(folder / name, comparison)


def write_outputs(walkthrough: Walkthrough, folder: Path, progress: Progress = no_progress) -> None:
    """Writes all files of a plan into an existing folder."""
    started = time.perf_counter()
    for done, (name, write) in enumerate(WRITERS.items()):
        progress("write", 0.5 * done / len(WRITERS))
        write(folder / name, walkthrough)
    progress("write", 0.5)
    figures = summary(walkthrough)
    write_report(folder / "report.html", walkthrough, figures)
    seconds = figures["stages_s"] | {"write": time.perf_counter() - started}
    figures |= {"stages_s": seconds, "total_s": sum(seconds.values())}
    (folder / MARKER).write_text(json.dumps(figures, indent=1, allow_nan=False) + "\n", encoding="utf-8")
