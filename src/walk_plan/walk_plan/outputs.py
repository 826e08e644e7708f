# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The files of a plan: a writer for each, by the name of the file."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path

from walk_bag.walkthrough import walkthrough_messages, write_walkthrough_bag
from walk_building.progress import Progress, no_progress
from walk_plan.glb import write_glb
from walk_plan.report import write_report
from walk_plan.summary import summary
from walk_plan.trajectory_csv import write_trajectory_csv
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
    )
    write_walkthrough_bag(path, messages)


WRITERS: dict[str, Callable[[Path, Walkthrough], None]] = {
    "tour.mcap": write_tour_bag,
    "trajectory.csv": lambda path, walkthrough: write_trajectory_csv(
        path, walkthrough.building, walkthrough.trajectory
    ),
    "walkthrough.glb": write_glb,
}
"""Writers of everything but the report, which is written last because it tells what the others cost."""


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
