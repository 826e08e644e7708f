# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The optimiser with its state: a path that is solved once and then goes on from where it is."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import ArrayLike, NDArray

from walk_building.building import Building
from walk_building.errors import ParameterError
from walk_building.route import Router
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.guard import Guard
from walk_trajopt.moving import Move, Mover
from walk_trajopt.path import OptimisedPath
from walk_trajopt.pieces import Pieces
from walk_trajopt.polyline import Polyline, as_polyline_points, tour_of
from walk_trajopt.resample import keypoint_arcs, point_count
from walk_trajopt.result import path_of
from walk_trajopt.revise import ends_at_keypoints, revised, share_of_new
from walk_trajopt.solvers import Solution
from walk_trajopt.state import State, initial_state

_ROUGH = 1e-2  # tolerance of a problem that is only on the way to another
_MOSTLY_NEW = 0.5  # share of new legs above which solving all of them finds a better path in the same time


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
        pieces: Solves what an edit changes; its spacing is that of the tour that was solved as a whole.
        mover: Moves keypoints; without a router it refuses an edit that bends a leg through a wall.
        state: The solution; taking back an earlier one undoes what came after it.
    """

    def __init__(
        self,
        building: Building,
        polyline: ArrayLike,
        keypoints: ArrayLike,
        config: TrajoptConfig | None = None,
        locked: ArrayLike | None = None,
        router: Router | None = None,
    ) -> None:
        """Takes a tour as it was planned; `solve` and `check` make a path of it.

        Args:
            building: Where to walk.
            polyline: (L, 3) the planned tour's eye positions [m].
            keypoints: (M, 3) in the order of the tour, which passes them [m].
            config: The problem and its solver.
            locked: (M,) keypoints that the path passes exactly; None for none.
            router: Finds another way where a bent leg collides; None for none.
        """
        self.config = config or TrajoptConfig()
        self._building = building
        self._guard = Guard(building, self.config.chord_error_m)
        tour = tour_of(polyline)
        n = point_count(tour.length_m, self.config)
        self.state: State = self._fresh(tour, as_polyline_points("keypoints", keypoints, at_least=0), locked, n)
        self.pieces = Pieces(building, self.config, tour.length_m / (n - 1))
        self.mover = Mover(self._guard, self.pieces, self.config, router)
        self._solution = Solution(x=self.state.x, cost=np.inf, iterations=0, evaluations=0)

    def solve(self) -> None:
        """Solves the whole problem from the planned tour.

        There are many minima, and which one is found depends on the way. The default solver is fast enough to go two
        ways, straight from the tour and after a problem with more clearance; the better end counts.
        """
        start = dataclasses.replace(self.state, x=self.state.start, firmness=np.ones(len(self.state.x)))
        last = len(start.x) - 1
        self._solution = self.pieces.solve(start, 0, last, self.config)
        if self.config.solver == "levenberg_marquardt":
            weight = min(10.0 * self.config.weight_clearance + 1.0, 1e6)
            clear = dataclasses.replace(self.config, weight_clearance=weight, tolerance=_ROUGH)
            wide = self.pieces.solve(start, 0, last, clear)
            other = self.pieces.solve(dataclasses.replace(start, x=wide.x), 0, last, self.config)
            self._solution = min(self._solution, other, key=lambda solution: solution.cost)
        solved = dataclasses.replace(start, x=self._solution.x)
        self.state = dataclasses.replace(solved, terms=self.pieces.terms(solved))

    def restore(self, state: State, spacing_m: float) -> bool:
        """Goes on from a state that was kept; returns whether it may, which is where its path still passes."""
        if not self._guard.passes(state):
            return False
        self.state, self.pieces.spacing_m = state, spacing_m
        return True

    def check(self) -> OptimisedPath:
        """Sweeps the body along the whole path, repairs it where it does not pass, and returns it."""
        checked = self._checked(self.state, 0, len(self.state.x) - 1, self.config)
        self.state = dataclasses.replace(checked, terms=self.pieces.terms(checked))
        return self.path()

    def move_keypoint(
        self,
        keypoint: int,
        position: ArrayLike,
        before: ArrayLike | None = None,
        after: ArrayLike | None = None,
        *,
        hasty: bool = False,
    ) -> EditOutcome:
        """Moves a keypoint and optimises the legs beside it, from where they are.

        Args:
            keypoint: Its index.
            position: (3,) where its eye is wanted; the floor decides about the height [m].
            before: (L, 3) a newly planned leg from the keypoint before to the position; None bends the one there is.
            after: (L, 3) the same from the position to the keypoint after.
            hasty: One of many moves that follow each other: what the ones before found out about the clearance is
                kept, and few iterations must do. A move that is not is solved as if it were the first.

        Returns:
            The new path; or, if there is no floor or the body does not pass even after repair, the last valid path
            and the reason.

        Raises:
            ParameterError: No such keypoint, or numbers that are not finite.
        """
        if not 0 <= keypoint < len(self.state.keypoints):
            raise ParameterError("keypoint", keypoint, f"an index below {len(self.state.keypoints)}")
        if self.state.pinned[keypoint]:
            return self._refused("the keypoint is locked")
        eye = self._on_floor(as_polyline_points("position", np.reshape(position, (1, 3)), at_least=1))
        if not np.isfinite(eye).all():
            return self._refused("there is no floor below the new place")
        before, after = (None if leg is None else as_polyline_points("leg", leg) for leg in (before, after))
        move = Move(keypoint=keypoint, eye=eye[0], radius_m=float(self._radii(eye)[0]), hasty=hasty)
        moved = self.mover.moved(self.state, move, (before, after))
        if moved.hopeless:
            times = len(moved.hopeless)
            return self._refused(f"the body would touch the building {times} times beside keypoint {keypoint}")
        self._solution = moved.solution
        if hasty:
            # What each objective costs is not asked for in the middle of a drag.
            self.state = moved.state
            return EditOutcome(path=path_of(self.state, self._solution, self.config.solver), accepted=True, reason="")
        terms = self.pieces.spliced_terms(self.state, moved.state, *moved.state.window(keypoint))
        self.state = dataclasses.replace(moved.state, terms=terms)
        return EditOutcome(path=self.path(), accepted=True, reason="")

    def rehearse(self) -> None:
        """Does once what an edit may need and drops what comes of it: code is slow the first time it runs."""
        state, solution = self.state, self._solution
        for keypoint in np.flatnonzero(~state.pinned)[:1].tolist():
            for hasty in (True, False):
                self.move_keypoint(keypoint, state.keypoints[keypoint], hasty=hasty)
        self.state, self._solution = state, solution
        self.mover.rehearse(state)

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
        n = max(round(tour.length_m / self.pieces.spacing_m), len(stops)) + 1
        fresh = self._fresh(tour, stops, locked, n)
        if not (ends_at_keypoints(fresh) and ends_at_keypoints(self.state)):
            return False
        if share_of_new(self.state, fresh, came_from) > _MOSTLY_NEW:
            return False
        state, windows = revised(self.state, fresh, came_from)
        for first, last in windows:
            self._solution = self.pieces.solve(state, first, last, self.config)
            state = self._checked(dataclasses.replace(state, x=self._solution.x), first, last, self.config)
        self.state = dataclasses.replace(state, terms=self.pieces.terms(state))
        return True

    def path(self) -> OptimisedPath:
        """Returns the path of the present state, its stretches named by its own arc length."""
        if not self.state.terms:
            self.state = dataclasses.replace(self.state, terms=self.pieces.terms(self.state))
        return path_of(self.state, self._solution, self.config.solver)

    def _fresh(self, tour: Polyline, stops: NDArray[np.float64], locked: ArrayLike | None, n: int) -> State:
        pinned = np.zeros(len(stops), bool) if locked is None else np.array(locked, dtype=bool)
        if pinned.shape != (len(stops),):
            raise ParameterError("locked", pinned.shape, f"an array of shape ({len(stops)},), one for each keypoint")
        return initial_state(tour, stops, self._radii(stops), pinned, keypoint_arcs(tour, stops), n)

    def _on_floor(self, eyes: NDArray[np.float64]) -> NDArray[np.float64]:
        height, eyes = self._building.walker.eye_height_m, eyes.copy()
        eyes[:, 2] = self._building.surface.floor_z(eyes, height) + height
        return eyes

    def _radii(self, keypoints: NDArray[np.float64]) -> NDArray[np.float64]:
        """Returns how near to each keypoint to pass: nearer where it has little room, or a small room were missed."""
        surface = self._building.surface
        places = surface.nearest(keypoints - np.array([0.0, 0.0, self._building.walker.eye_height_m]))
        return np.minimum(self.config.keypoint_radius_m, 0.5 * surface.clearance_m[places])

    def _refused(self, reason: str) -> EditOutcome:
        return EditOutcome(path=self.path(), accepted=False, reason=reason)

    def _checked(self, state: State, first: int, last: int, config: TrajoptConfig) -> State:
        """Draws the curve through points `first` to `last` anew, sweeps the body along it and repairs it."""
        state, touching = self._guard.swept(state, state.x, first, last)
        return self._guard.mended(state, first, last, touching, self.pieces, config)
