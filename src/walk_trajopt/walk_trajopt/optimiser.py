# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The optimiser with its state: a path that is solved once and then goes on from where it is."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import ArrayLike, NDArray

from walk_building.building import Building
from walk_building.errors import ParameterError
from walk_building.sweep import BodySweep
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.curve import refine
from walk_trajopt.objectives import Setting
from walk_trajopt.path import OptimisedPath, Stretch, read_only
from walk_trajopt.polyline import Polyline, as_polyline_points
from walk_trajopt.problem import Problem
from walk_trajopt.repair import Mended, Way, repair
from walk_trajopt.resample import keypoint_arcs, point_count, resample
from walk_trajopt.solvers import SOLVERS, Solution

_BESIDE = 2  # fixed points beside a window: as many as the widest difference reaches


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class EditOutcome:
    """What became of an edit."""

    path: OptimisedPath  # the new one, or the last valid one if the edit was refused
    accepted: bool
    reason: str  # why it was refused, "" if it was not


class Optimiser:
    """Holds one trajectory problem and its solution; edits change both locally.

    Points keep their number and the tour its parameter through edits, so that what is not beside an edited keypoint
    stays exactly where it is.

    Attributes:
        config: As given.
        keypoints: (M, 3) as they are now, in the order of the tour [m].
        path: The last valid path; None before `optimise`.
    """

    def __init__(
        self, building: Building, polyline: ArrayLike, keypoints: ArrayLike, config: TrajoptConfig = TrajoptConfig()
    ) -> None:
        self.config = config
        self.keypoints = as_polyline_points("keypoints", keypoints, at_least=0)
        self.path: OptimisedPath | None = None
        self._building = building
        self._sweep = BodySweep(building.geometry, building.walker)
        self._tour = Polyline(as_polyline_points("polyline", polyline))
        if len(self._tour.points) < 2:
            raise ParameterError("polyline", "all points at one place", "a tour of some length")
        self._keypoint_m = keypoint_arcs(self._tour, self.keypoints)
        samples = resample(self._tour, self._keypoint_m, point_count(self._tour.length_m, config))
        self._spacing_m = self._tour.length_m / (len(samples.points) - 1)
        self._start, self._arc_m, self._keypoint_index = samples.points, samples.arc_m, samples.keypoint_index
        self._x = samples.points
        self._way = Way(points=samples.points, tour_m=samples.arc_m)
        self._mended: list[Mended] = []

    def solve(self) -> None:
        """Solves the whole problem from the planned tour."""
        self._solution = self._solve(self._start, self._start, 0, len(self._start) - 1)
        self._x = self._solution.x

    def check(self) -> OptimisedPath:
        """Sweeps the body along the whole path, repairs it where it does not pass, and returns it."""
        self._way, self._mended = self._checked(self._x, self._tour, 0, len(self._x) - 1)
        self.path = self._named(self._solution)
        return self.path

    def _solve(self, start: NDArray[np.float64], x: NDArray[np.float64], first: int, last: int) -> Solution:
        """Optimises the points between `first` and `last`, these two and all beyond them fixed."""
        low, high = max(first + 1 - _BESIDE, 0), min(last + _BESIDE, len(x))
        fixed = np.ones(high - low, bool)
        fixed[first + 1 - low : last - low] = False
        inside = (self._keypoint_index >= low) & (self._keypoint_index < high)
        setting = self._setting(start[low:high], self.keypoints[inside], self._keypoint_index[inside] - low)
        solution = SOLVERS[self.config.solver](Problem(setting, self.config, fixed), x[low:high], self.config)
        whole = x.copy()
        whole[low:high] = solution.x
        return dataclasses.replace(solution, x=whole)

    def _setting(
        self, start: NDArray[np.float64], keypoints: NDArray[np.float64], index: NDArray[np.int64]
    ) -> Setting:
        building = self._building
        return Setting(
            start=start,
            spacing_m=self._spacing_m,
            keypoints=keypoints,
            keypoint_index=index,
            geometry=building.geometry,
            surface=building.surface,
            walker=building.walker,
            clearance_m=self.config.clearance_m,
            clearance_of=self.config.clearance_of,
        )

    def _checked(self, x: NDArray[np.float64], tour: Polyline, first: int, last: int) -> tuple[Way, list[Mended]]:
        """Draws the curve through points `first` to `last` anew, sweeps the body along it and repairs it."""
        curve, place = refine(x, self.config.chord_error_m)
        drawn = Way(points=curve, tour_m=np.interp(place, np.arange(len(x)), self._arc_m))
        # A curve reaches one span beyond a moved point.
        low, high = self._arc_m[max(first - 1, 0)], self._arc_m[min(last + 1, len(x) - 1)]
        piece = drawn.between(low, high)
        way = self._way.replaced(piece)
        way, mended = repair(way, tour, self._keypoint_m, self._sweep, (low, high))
        return way, [m for m in self._mended if m.end_m < low or m.start_m > high] + mended

    def _named(self, solution: Solution) -> OptimisedPath:
        """Returns the path with its stretches named by its own arc length."""
        points, tour_m = self._way.points, self._way.tour_m
        arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
        index = np.abs(tour_m[None, :] - self._keypoint_m[:, None]).argmin(axis=1)

        def stretch(mended: Mended) -> Stretch:
            start, end = np.interp([mended.start_m, mended.end_m], tour_m, arc)
            after = int(np.searchsorted(self._keypoint_m, mended.start_m, side="right")) - 1
            before = int(np.searchsorted(self._keypoint_m, mended.end_m, side="left"))
            return Stretch(
                start_m=float(start), end_m=float(end), after_keypoint=after, before_keypoint=before, how=mended.how
            )

        whole = Problem(
            self._setting(self._start, self.keypoints, self._keypoint_index), self.config, np.zeros(len(self._x), bool)
        )
        return OptimisedPath(
            points=read_only(points),
            keypoint_index=index.astype(np.int64),
            cost=whole.costs(self._x),
            iterations=solution.iterations,
            evaluations=solution.evaluations,
            solver=self.config.solver,
            repaired=tuple(stretch(m) for m in self._mended if m.free),
            colliding=tuple(stretch(m) for m in self._mended if not m.free),
        )
