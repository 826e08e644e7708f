# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the cores once on a small building, so that numba has compiled and stored every kernel they use."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from walk_plan.walkthrough import Walkthrough

Box = tuple[tuple[float, float, float], tuple[float, float, float]]

# Two rooms of 4 m × 3 m with a door between them, under a ceiling: low and high corner of each piece [m].
_PIECES: tuple[Box, ...] = (
    ((-0.2, -0.2, -0.2), (8.2, 3.2, 0.0)),
    ((-0.2, -0.2, 2.6), (8.2, 3.2, 2.8)),
    ((-0.2, -0.2, 0.0), (0.0, 3.2, 2.6)),
    ((8.0, -0.2, 0.0), (8.2, 3.2, 2.6)),
    ((0.0, -0.2, 0.0), (8.0, 0.0, 2.6)),
    ((0.0, 3.0, 0.0), (8.0, 3.2, 2.6)),
    ((3.9, 0.0, 0.0), (4.1, 1.0, 2.6)),
    ((3.9, 2.0, 0.0), (4.1, 3.0, 2.6)),
    ((3.9, 1.0, 2.1), (4.1, 2.0, 2.6)),
)
_MIDDLE_X = 4.0  # of the wall between the two
_SIDES = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))


def main() -> None:
    """Runs every stage and prints `PERCENT STAGE` before each."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "two_rooms.obj"
        file.write_text("\n".join(two_rooms_obj()) + "\n", encoding="utf-8")
        run(file)


def run(file: Path) -> None:
    """Plans a walk through a building file, then takes the ways that a plan does not take by itself."""
    _tell(0, "imports")
    # Imported here: it is the slow part, and part of what the progress is about.
    from walk_importance.config import ImportanceConfig
    from walk_importance.pipeline import compute_importance
    from walk_plan.options import PlanConfig
    from walk_plan.pipeline import make_walkthrough
    from walk_plan.stages import STAGES, StageClock
    from walk_sequencer.config import SequencerConfig
    from walk_sequencer.pipeline import plan_tour

    def progress(stage: str, fraction: float) -> None:
        if fraction == 0.0:
            _tell(5 + 80 * STAGES.index(stage) // len(STAGES), stage)

    walkthrough = make_walkthrough(file, PlanConfig(), StageClock(progress))
    building = walkthrough.building
    for percent, visibility in ((85, "exact"), (90, "rays")):
        _tell(percent, f"{visibility} visibility")
        compute_importance(building, ImportanceConfig(voxel_size_m=0.5, visibility=visibility))
    _tell(94, "local search")
    plan_tour(building, walkthrough.suggestion.positions, SequencerConfig(milestones=100, method="local_search"))
    _tell(97, "edits")
    drag(walkthrough)


def drag(walkthrough: Walkthrough) -> None:
    """Drags each keypoint into the other room, through the wall and round it, as a hand does, and lets it go."""
    from walk_building.footing import eye_over_floor
    from walk_trajopt.live import Revision, live_path
    from walk_trajopt.timing import time_path

    building, tour = walkthrough.building, walkthrough.tour
    stands = tour.stands[tour.order]
    live = live_path(building, walkthrough.config.trajectory)
    live.follow(Revision(ids=tuple(range(len(stands))), keypoints=stands, polyline=tour.polyline))
    live.prepare()
    for keypoint, (x, y, z) in enumerate(stands.tolist()):
        for share in (0.0, 0.2, 0.5, 0.8, 1.0):
            there = eye_over_floor(building, (x + share * (_MIDDLE_X - x) * 1.8, y, z))
            outcome = live.move(keypoint, there, hasty=share < 1.0)
            time_path(outcome.path, walkthrough.config.timing)


def _tell(percent: int, stage: str) -> None:
    print(percent, stage, flush=True)


def two_rooms_obj() -> Iterator[str]:
    """Yields the lines of an OBJ file of the two rooms."""
    for number, (low, high) in enumerate(_PIECES):
        yield f"o piece_{number}"
        for corner in range(8):
            xyz = (high[axis] if corner >> axis & 1 else low[axis] for axis in range(3))
            yield "v " + " ".join(f"{value:g}" for value in xyz)
        for a, b, c, d in _SIDES:
            first = 8 * number + 1
            yield f"f {first + a} {first + b} {first + c} {first + d}"


if __name__ == "__main__":
    main()
