# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What the sequencer hands on: legs, the order, the tour."""

from __future__ import annotations

import dataclasses
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from walk_sequencer.roadmap import Roadmap


class Stand(NamedTuple):
    """Where a walker stands."""

    place: int  # of the roadmap's ground
    x: float  # [m]
    y: float  # [m]


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Leg:
    """A planned walk between two keypoints."""

    start: int  # index of the keypoint it leaves
    goal: int  # index of the keypoint it reaches
    points: NDArray[np.float64]  # (m, 3) eye positions [m], at least two; straight between them
    length_m: float  # of the points as a polyline

    def reversed(self) -> Leg:
        """Returns the same walk the other way round."""
        points = self.points[::-1]
        return Leg(start=self.goal, goal=self.start, points=points, length_m=self.length_m)


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Unreachable:
    """A keypoint that the tour leaves out."""

    index: int  # into the keypoints
    reason: str  # in words, for the user


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Tour:
    """An order of the keypoints and the walks between them. Arrays are read-only."""

    order: NDArray[np.int64]  # (M,) indices into the keypoints, reachable ones only
    unreachable: tuple[Unreachable, ...]
    legs: tuple[Leg, ...]  # M - 1, along the order
    pairs: tuple[Leg, ...]  # one per planned pair, start < goal
    lengths_m: NDArray[np.float64]  # (K, K) walkable lengths, inf where there is no way, 0 on the diagonal
    stands: NDArray[np.float64]  # (K, 3) where the walker's eye is at each keypoint, nan where it cannot stand
    polyline: NDArray[np.float64]  # (L, 3) eye positions of the legs in a row
    length_m: float
    method: str  # the order's method as it was used: never "auto"
    stand_of: dict[int, Stand] = dataclasses.field(repr=False)  # by keypoint, reachable ones only
    roadmap: Roadmap | None = dataclasses.field(repr=False)  # to plan on with; None where nobody can stand anywhere


def polyline_length_m(points: NDArray[np.float64]) -> float:
    """Returns the length of an (m, 3) polyline [m]; 0 for fewer than two points."""
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
