# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The optimised path: positions without time, and what is known about where it can be walked."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Stretch:
    """A piece of the path, named by arc length and by the keypoints it lies between."""

    start_m: float  # arc length along the path
    end_m: float
    after_keypoint: int  # index into the keypoints, -1 before the first
    before_keypoint: int  # index into the keypoints, their number after the last
    how: str  # what was done about it, or what is wrong with it

    def __str__(self) -> str:
        where = f"from {self.start_m:.1f} m to {self.end_m:.1f} m"
        return f"{where}, between keypoints {self.after_keypoint} and {self.before_keypoint}: {self.how}"


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class OptimisedPath:
    """A path for the eye as a polyline; the walker's body was swept along each of its segments. Read-only arrays.

    Attributes:
        points: (n, 3) eye positions, dense enough that the polyline stands for a smooth curve [m].
        keypoint_index: (M,) the point at which each keypoint is passed, rising.
        cost: Weighted value of each objective at the solution, by name; empty for a spline and in the middle of a drag.
        iterations: Of the solver.
        evaluations: Of the cost by the solver.
        solver: Its name, or what else made the path.
        repaired: Stretches that did not pass the check and were mended.
        colliding: Stretches on which the body touches the building; empty is the guarantee.
    """

    points: NDArray[np.float64]
    keypoint_index: NDArray[np.int64]
    cost: dict[str, float]
    iterations: int
    evaluations: int
    solver: str
    repaired: tuple[Stretch, ...]
    colliding: tuple[Stretch, ...]

    @property
    def length_m(self) -> float:
        """Length of the path [m]."""
        return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())

    @property
    def total_cost(self) -> float:
        """Weighted sum of all objectives."""
        return sum(self.cost.values())


def read_only(array: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the array, contiguous and locked against changes."""
    locked = np.ascontiguousarray(array)
    locked.setflags(write=False)
    return locked
