# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The optimiser with its state: a path that is solved once and then goes on from where it is."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from walk_building.building import Building
from walk_building.errors import ParameterError
from walk_trajopt.check import PathCheck
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.objectives import Setting
from walk_trajopt.path import OptimisedPath
from walk_trajopt.polyline import Polyline, as_polyline_points, tour_of
from walk_trajopt.problem import Problem
from walk_trajopt.repair import Mended, colliding, repair
from walk_trajopt.resample import keypoint_arcs, point_count
from walk_trajopt.result import path_of
from walk_trajopt.revise import ends_at_keypoints, revised, share_of_new
from walk_trajopt.solvers import SOLVERS, Solution
from walk_trajopt.state import State, around, bent, drawn, initial_state

_ROUGH = 1e-2  # tolerance of a problem that is only on the way to another

_MOSTLY_NEW = 0.5  # share of new legs above which solving all of them finds a better path in the same time

_EASE_M = 1.5  # on both sides of a colliding stretch that is optimised again
_EASED = "optimised again with more weight on the clearance"


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class EditOutcome:
    """What became of an edit."""

    path: OptimisedPath  # the new one, or the last valid one if the edit was refused
    accepted: bool
    reason: str  # why it was refused, "" if it was not


class Optimiser:
    """Holds one trajectory problem and its solution; an edit changes both locally.

    What is not beside an edited keypoint stays exactly where it is. Not safe to share between threads.

    Attributes:
        config: As given.
        spacing_m: h, the mean distance between points of the tour that was solved as a whole.
        state: The solution; taking back an earlier one undoes what came after it.
        watch: Told of each problem that is solved, where it started and at what cost it ended; for benchmarks.
    """

    def __init__(
        self,
        building: Building,
        polyline: ArrayLike,
        keypoints: ArrayLike,
        config: TrajoptConfig | None = None,
        locked: ArrayLike | None = None,
    ) -> None:
        """Takes a tour as it was planned; `solve` and `check` make a path of it.

        Args:
            building: Where to walk.
            polyline: (L, 3) the planned tour's eye positions [m].
            keypoints: (M, 3) in the order of the tour, which passes them [m].
            config: The problem and its solver.
            locked: (M,) keypoints that the path passes exactly; None for none.
        """
        self.config = config or TrajoptConfig()
        self._building = building
        self._check = PathCheck(building.geometry, building.walker)
        tour = tour_of(polyline)
        n = point_count(tour.length_m, self.config)
        self.state: State = self._fresh(tour, as_polyline_points("keypoints", keypoints, at_least=0), locked, n)
        self.spacing_m = tour.length_m / (n - 1)
        self.watch: Callable[[Problem, NDArray[np.float64], float], None] | None = None
        # The points that were solved last and their problem, which knows much about the geometry around them.
        self._solved: tuple[NDArray[np.float64], Problem] | None = None
        self._solution = Solution(x=self.state.x, cost=np.inf, iterations=0, evaluations=0)

    def solve(self) -> None:
        """Solves the whole problem from the planned tour.

        There are many minima, and which one is found depends on the way. The default solver is fast enough to go two
        ways, straight from the tour and after a problem with more clearance; the better end counts.
        """
        start = dataclasses.replace(self.state, x=self.state.start)
        last = len(start.x) - 1
        self._solution = self._solve(start, 0, last)
        if self.config.solver == "levenberg_marquardt":
            wide = self._solve(start, 0, last, dataclasses.replace(self._stiffer(), tolerance=_ROUGH))
            other = self._solve(dataclasses.replace(start, x=wide.x), 0, last)
            self._solution = min(self._solution, other, key=lambda solution: solution.cost)
        solved = dataclasses.replace(start, x=self._solution.x)
        self.state = dataclasses.replace(solved, terms=self._terms(solved))

    def restore(self, state: State, spacing_m: float) -> bool:
        """Goes on from a state that was kept; returns whether it may, which is where its path still passes."""
        window = float(state.arc_m[0]), float(state.arc_m[-1])
        if colliding(state.way, self._check, window):
            return False
        self.state, self.spacing_m = state, spacing_m
        return True

    def check(self) -> OptimisedPath:
        """Sweeps the body along the whole path, repairs it where it does not pass, and returns it."""
        last = len(self.state.x) - 1
        checked = self._checked(self.state, 0, last)
        self.state = dataclasses.replace(checked, terms=self._terms(checked))
        return self.path()

    def move_keypoint(
        self,
        keypoint: int,
        position: ArrayLike,
        before: ArrayLike | None = None,
        after: ArrayLike | None = None,
    ) -> EditOutcome:
        """Moves a keypoint and optimises the legs beside it, from where they are.

        Args:
            keypoint: Its index.
            position: (3,) where its eye is wanted; the floor decides about the height [m].
            before: (L, 3) a newly planned leg from the keypoint before to the position; None bends the one there is.
            after: (L, 3) the same from the position to the keypoint after.

        Returns:
            The new path; or, if there is no floor or the body does not pass even after repair, the last valid path
            and the reason.

        Raises:
            ParameterError: No such keypoint, or numbers that are not finite.
        """
        if not 0 <= keypoint < len(self.state.keypoints):
            raise ParameterError("keypoint", keypoint, f"an index below {len(self.state.keypoints)}")
        if self.state.pinned[keypoint]:
            return EditOutcome(path=self.path(), accepted=False, reason="the keypoint is locked")
        eye = self._on_floor(as_polyline_points("position", np.reshape(position, (-1, 3)), at_least=1))
        if not np.isfinite(eye).all():
            return EditOutcome(path=self.path(), accepted=False, reason="there is no floor below the new place")
        legs = tuple(None if leg is None else as_polyline_points("leg", leg) for leg in (before, after))
        radius = float(self._radii(eye)[0])
        moved = bent(self.state, keypoint, eye[0], radius, (legs[0], legs[1]), self.spacing_m)
        first, last = moved.window(keypoint)
        solution = self._solve(moved, first, last)
        checked = self._checked(dataclasses.replace(moved, x=solution.x), first, last)
        stuck = [m for m in checked.mended if not m.free and m not in self.state.mended]
        if stuck:
            reason = f"the body would touch the building {len(stuck)} times beside keypoint {keypoint}"
            return EditOutcome(path=self.path(), accepted=False, reason=reason)
        self.state = dataclasses.replace(checked, terms=self._spliced_terms(checked, first, last))
        self._solution = solution
        return EditOutcome(path=self.path(), accepted=True, reason="")

    def revise(
        self, polyline: ArrayLike, keypoints: ArrayLike, came_from: NDArray[np.int64], locked: ArrayLike | None = None
    ) -> bool:
        """Goes over to another tour and solves only the legs that are new, from where the others are.

        Args:
            polyline: (L, 3) the new tour [m].
            keypoints: (M, 3) in its order [m].
            came_from: (M,) index of each in the present state, −1 for a new one.
            locked: (M,) keypoints that the path passes exactly; None for none.

        Returns:
            False where more than half of the legs are new, or the tour reaches beyond its keypoints: then nothing has
            changed, and the whole problem had better be solved.
        """
        tour, stops = tour_of(polyline), as_polyline_points("keypoints", keypoints, at_least=0)
        n = max(round(tour.length_m / self.spacing_m), len(stops)) + 1
        fresh = self._fresh(tour, stops, locked, n)
        if not (ends_at_keypoints(fresh) and ends_at_keypoints(self.state)):
            return False
        if share_of_new(self.state, fresh, came_from) > _MOSTLY_NEW:
            return False
        state, windows = revised(self.state, fresh, came_from)
        for first, last in windows:
            self._solution = self._solve(state, first, last)
            state = self._checked(dataclasses.replace(state, x=self._solution.x), first, last)
        self.state = dataclasses.replace(state, terms=self._terms(state))
        return True

    def path(self) -> OptimisedPath:
        """Returns the path of the present state, its stretches named by its own arc length."""
        return path_of(self.state, self._solution, self.config.solver)

    def _fresh(self, tour: Polyline, stops: NDArray[np.float64], locked: ArrayLike | None, n: int) -> State:
        pinned = np.zeros(len(stops), bool) if locked is None else np.array(locked, dtype=bool)
        if pinned.shape != (len(stops),):
            raise ParameterError("locked", pinned.shape, f"an array of shape ({len(stops)},), one for each keypoint")
        return initial_state(tour, stops, self._radii(stops), pinned, keypoint_arcs(tour, stops), n)

    def _on_floor(self, eyes: NDArray[np.float64]) -> NDArray[np.float64]:
        height = self._building.walker.eye_height_m
        floor = self._building.surface.floor_z(eyes, height)
        return np.column_stack([eyes[:, :2], floor + height])

    def _solve(self, state: State, first: int, last: int, config: TrajoptConfig | None = None) -> Solution:
        """Optimises the points between `first` and `last`, these two and all beyond them fixed."""
        config = config or self.config
        low, high = around(state, first, last)
        fixed = np.ones(high - low, bool)
        fixed[first + 1 - low : last - low] = False
        pins = state.keypoint_index[state.pinned] - low
        fixed[pins[(pins >= 0) & (pins < high - low)]] = True
        problem = Problem(self._setting(state, low, high), config, fixed)
        solution = SOLVERS[config.solver](problem, state.x[low:high], config)
        if self.watch is not None:
            self.watch(problem, state.x[low:high], solution.cost)
        x = state.x.copy()
        x[low:high] = solution.x
        self._solved = (x, problem) if config is self.config else None
        return dataclasses.replace(solution, x=x)

    def _stiffer(self) -> TrajoptConfig:
        return dataclasses.replace(self.config, weight_clearance=min(10.0 * self.config.weight_clearance + 1.0, 1e6))

    def _terms(self, state: State) -> dict[str, NDArray[np.float64]]:
        free = np.zeros(len(state.x), bool)
        return Problem(self._setting(state, 0, len(state.x)), self.config, free).terms(state.x)

    def _spliced_terms(self, state: State, first: int, last: int) -> dict[str, NDArray[np.float64]]:
        """Returns the terms of a state that differs from the present one between two points: beside, they stay."""
        low, high = around(state, first, last)
        if self._solved is not None and self._solved[0] is state.x:
            problem = self._solved[1]
        else:
            problem = Problem(self._setting(state, low, high), self.config, np.zeros(high - low, bool))
        new, added = problem.terms(state.x[low:high]), len(state.x) - len(self.state.x)
        return {
            name: np.concatenate([old[:low], new[name][: last - low], old[last - added :]])
            for name, old in self.state.terms.items()
        }

    def _radii(self, keypoints: NDArray[np.float64]) -> NDArray[np.float64]:
        """Returns how near to each keypoint to pass: nearer where it has little room, or a small room were missed."""
        surface = self._building.surface
        places = surface.nearest(keypoints - np.array([0.0, 0.0, self._building.walker.eye_height_m]))
        return np.minimum(self.config.keypoint_radius_m, 0.5 * surface.clearance_m[places])

    def _setting(self, state: State, low: int, high: int) -> Setting:
        inside = (state.keypoint_index >= low) & (state.keypoint_index < high)
        return Setting(
            start=state.start[low:high],
            spacing_m=self.spacing_m,
            keypoints=state.keypoints[inside],
            keypoint_index=state.keypoint_index[inside] - low,
            keypoint_radius_m=state.radius_m[inside],
            geometry=self._building.geometry,
            surface=self._building.surface,
            walker=self._building.walker,
            clearance_m=self.config.clearance_m,
            clearance_of=self.config.clearance_of,
        )

    def _checked(self, state: State, first: int, last: int) -> State:
        """Draws the curve through points `first` to `last` anew, sweeps the body along it and repairs it."""
        # A curve reaches one span beyond a moved point.
        begin, end = max(first - 1, 0), min(last + 1, len(state.x) - 1)
        window = float(state.arc_m[begin]), float(state.arc_m[end])
        state = drawn(state, begin, end, self.config.chord_error_m)
        touching, eased = colliding(state.way, self._check, window), []
        for stretch in touching:
            state = self._eased(state, stretch, (first, last))
            eased.append(Mended(start_m=stretch[0], end_m=stretch[1], free=True, how=_EASED))
        if eased:
            state = drawn(state, begin, end, self.config.chord_error_m)
            touching = colliding(state.way, self._check, window)
        way, mended = repair(state.way, state.tour, state.keypoint_m, state.pins(), self._check, touching)
        eased = [e for e in eased if not any(m.start_m < e.end_m and m.end_m > e.start_m for m in mended)]
        kept = [m for m in state.mended if m.end_m < window[0] or m.start_m > window[1]]
        return dataclasses.replace(state, way=way, mended=tuple(sorted(kept + eased + mended, key=lambda m: m.start_m)))

    def _eased(self, state: State, stretch_m: tuple[float, float], limits: tuple[int, int]) -> State:
        """Optimises a stretch that collides again: from the planned tour, with more weight on the clearance."""
        first = max(int(np.searchsorted(state.arc_m, stretch_m[0] - _EASE_M)), limits[0])
        last = min(int(np.searchsorted(state.arc_m, stretch_m[1] + _EASE_M)), limits[1])
        if last - first < 2:
            return state
        x = state.x.copy()
        x[first + 1 : last] = state.start[first + 1 : last]
        solution = self._solve(dataclasses.replace(state, x=x), first, last, self._stiffer())
        return dataclasses.replace(state, x=solution.x)
