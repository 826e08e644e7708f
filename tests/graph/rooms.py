# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A small made building for the tests of the graph: three rooms in a row, doorways between them."""

from pathlib import Path

import numpy as np
import trimesh

LENGTH, DEPTH, HEIGHT, WALL = 12.0, 4.0, 2.6, 0.2


def _box(low, high):
    return trimesh.creation.box(bounds=np.array([low, high], dtype=float))


def make_rooms(path: Path) -> Path:
    """Writes the building as PLY: x 0..12, y 0..4, walls at x = 4 and x = 8 with a doorway of 1.2 m each."""
    half = WALL / 2
    parts = [
        _box((-half, -half, -0.2), (LENGTH + half, DEPTH + half, 0.0)),
        _box((-half, -half, HEIGHT), (LENGTH + half, DEPTH + half, HEIGHT + 0.2)),
        _box((-half, -half, 0), (half, DEPTH + half, HEIGHT)),
        _box((LENGTH - half, -half, 0), (LENGTH + half, DEPTH + half, HEIGHT)),
        _box((-half, -half, 0), (LENGTH + half, half, HEIGHT)),
        _box((-half, DEPTH - half, 0), (LENGTH + half, DEPTH + half, HEIGHT)),
    ]
    for x, door in ((4.0, 1.0), (8.0, 2.9)):
        parts.append(_box((x - half, half, 0), (x + half, door - 0.6, HEIGHT)))
        parts.append(_box((x - half, door + 0.6, 0), (x + half, DEPTH - half, HEIGHT)))
        parts.append(_box((x - half, door - 0.6, 2.1), (x + half, door + 0.6, HEIGHT)))
    trimesh.util.concatenate(parts).export(path)
    return path
