# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the cores once on a small building, so that numba has compiled and stored every kernel they use."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

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
_SIDES = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))


def main() -> None:
    """Runs every stage and prints `PERCENT STAGE` before each."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "two_rooms.obj"
        file.write_text("\n".join(two_rooms_obj()) + "\n", encoding="utf-8")
        for percent, stage in run(file):
            print(percent, stage, flush=True)


def run(file: Path) -> Iterator[tuple[int, str]]:
    """Runs the method on a building file stage by stage, yielding what comes next."""
    # Each import is a stage's own: what is slow to load is part of what the user waits for.
    yield 0, "walk_building"
    from walk_building.model import LoadOptions
    from walk_building.pipeline import load_building

    building = load_building(file, LoadOptions(units_m=1.0, up="z"))
    yield 30, "walk_importance"
    from walk_importance.config import ImportanceConfig, KeypointConfig
    from walk_importance.pipeline import compute_importance, suggest_keypoints

    for visibility in ("progressive", "exact", "rays"):
        importance = compute_importance(building, ImportanceConfig(voxel_size_m=0.5, visibility=visibility))
    keypoints = suggest_keypoints(building, importance, KeypointConfig(count=4))
    yield 60, "walk_sequencer"
    from walk_sequencer.config import SequencerConfig
    from walk_sequencer.pipeline import plan_tour

    for method in ("exact", "local_search"):
        tour = plan_tour(building, keypoints.positions, SequencerConfig(milestones=100, method=method))
    yield 75, "walk_trajopt"
    from walk_trajopt.config import TimingConfig, TrajoptConfig
    from walk_trajopt.pipeline import optimise_path, time_path

    path = optimise_path(building, tour.polyline, keypoints.positions[tour.order], TrajoptConfig())
    time_path(path, TimingConfig())


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
    sys.exit(main())
