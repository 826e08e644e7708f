# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The guarantee: the walker's body swept along every segment of a path against the exact geometry."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray


class Sweep(Protocol):
    """What the check needs of `walk_building.BodySweep`."""

    def segments_free(self, eye_path: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Returns for each segment of the path (n, 3) whether the body passes it, (n − 1,)."""
        ...


def colliding_runs(free: NDArray[np.bool_], arc_m: NDArray[np.float64], gap_m: float) -> list[tuple[float, float]]:
    """Returns the intervals of arc length that are not free, those closer than `gap_m` joined.

    Args:
        free: (n − 1,) per segment.
        arc_m: (n,) at the points, rising.
        gap_m: Free pieces shorter than this do not part two intervals.
    """
    runs: list[tuple[float, float]] = []
    for i in np.flatnonzero(~free):
        start, end = float(arc_m[i]), float(arc_m[i + 1])
        if runs and start - runs[-1][1] < gap_m:
            runs[-1] = (runs[-1][0], end)
        else:
            runs.append((start, end))
    return runs
