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
from walk_trajopt.guard import Guard, Stretches
from walk_trajopt.path import OptimisedPath
from walk_trajopt.pieces import Pieces
from walk_trajopt.polyline import Polyline, as_polyline_points, tour_of
from walk_trajopt.resample import keypoint_arcs, point_count
from walk_trajopt.result import path_of
from walk_trajopt.revise import ends_at_keypoints, revised, share_of_new
from walk_trajopt.solvers import Solution
from walk_trajopt.state import Legs, State, bent, initial_state

_ROUGH = 1e-2  # tolerance of a problem that is only on the way to another
_MOSTLY_NEW = 0.5  # share of new legs above which solving all of them finds a better path in the same time
_HASTY_ITERATIONS, _HASTY_TOLERANCE = 10, 1e-3  # of a drag: the next one goes on from there, a release takes its time


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class EditOutcome:
    """What became of an edit."""

    path: OptimisedPath  # the new one, or the last valid one if the edit was refused
    accepted: bool
    reason: str  # why it was refused, "" if it was not


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class _Try:
    """A moved keypoint, its way drawn and swept."""

    state: State
    touching: Stretches  # of its way
    hopeless: Stretches  # of these, where it cannot be mended
    solution: Solution
    mended: bool = False


class Optimiser:
    """Holds one trajectory problem and its solution; an edit changes both locally.

    What is not beside an edited keypoint stays exactly where it is. Not safe to share between threads.

    Attributes:
        config: As given.
        pieces: Solves what an edit changes; its spacing is that of the tour that was solved as a whole.
        router: Finds another way where a bent leg collides; without one such an edit is refused.
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
        self._hasty = dataclasses.replace(
            self.config,
            max_iterations=min(self.config.max_iterations, _HASTY_ITERATIONS),
            tolerance=max(self.config.tolerance, _HASTY_TOLERANCE),
        )
        self._building = building
        self.router = router
        self._guard = Guard(building, self.config.chord_error_m)
        tour = tour_of(polyline)
        n = point_count(tour.length_m, self.config)
        self.state: State = self._fresh(tour, as_polyline_points("keypoints", keypoints, at_least=0), locked, n)
        self.pieces = Pieces(building, self.config, tour.length_m / (n - 1))
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
        eye = self._on_floor(as_polyline_points("position", np.reshape(position, (-1, 3)), at_least=1))
        if not np.isfinite(eye).all():
            return self._refused("there is no floor below the new place")
        before, after = (None if leg is None else as_polyline_points("leg", leg) for leg in (before, after))
        tried = self._moved(keypoint, eye[0], (before, after), hasty)
        if tried.hopeless:
            times = len(tried.hopeless)
            return self._refused(f"the body would touch the building {times} times beside keypoint {keypoint}")
        window = tried.state.window(keypoint)
        self.state = dataclasses.replace(tried.state, terms=self.pieces.spliced_terms(self.state, tried.state, *window))
        self._solution = tried.solution
        return EditOutcome(path=self.path(), accepted=True, reason="")

    def rehearse(self) -> None:
        """Does once what an edit may need and drops what comes of it: code is slow the first time it runs."""
        state, solution = self.state, self._solution
        for keypoint in np.flatnonzero(~state.pinned)[:1].tolist():
            for hasty in (True, False):
                self.move_keypoint(keypoint, state.keypoints[keypoint], hasty=hasty)
        self.state, self._solution = state, solution
        middle_m = 0.5 * state.tour.length_m
        self._guard.mended(state, 0, len(state.x) - 1, [(middle_m, middle_m)], self.pieces, self._hasty)
        if self.router is not None and len(state.keypoints):
            self.router.way(state.keypoints[0], state.keypoints[-1])

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

    def _radii(self, keypoints: NDArray[np.float64]) -> NDArray[np.float64]:
        """Returns how near to each keypoint to pass: nearer where it has little room, or a small room were missed."""
        surface = self._building.surface
        places = surface.nearest(keypoints - np.array([0.0, 0.0, self._building.walker.eye_height_m]))
        return np.minimum(self.config.keypoint_radius_m, 0.5 * surface.clearance_m[places])

    def _refused(self, reason: str) -> EditOutcome:
        return EditOutcome(path=self.path(), accepted=False, reason=reason)

    def _moved(self, keypoint: int, eye: NDArray[np.float64], legs: Legs, hasty: bool) -> _Try:
        """Returns the state with a keypoint moved, checked; by other legs where a bent one leads through a wall."""
        config = self._hasty if hasty else self.config
        tried = self._bent(keypoint, eye, legs, config)
        # A leg that is found anew may push the other one, which was bent, into a wall of its own: twice at most.
        while True:
            if not tried.hopeless:
                tried = self._mended(tried, keypoint, config)
            others = self._other_legs(keypoint, eye, legs, tried.hopeless)
            if others is None:
                break
            legs = others
            tried = self._bent(keypoint, eye, legs, config)
        # In vain, most likely; a hand that goes on does not wait for it.
        return tried if tried.mended or hasty else self._mended(tried, keypoint, config)

    def _mended(self, tried: _Try, keypoint: int, config: TrajoptConfig) -> _Try:
        first, last = tried.state.window(keypoint)
        state = self._guard.mended(tried.state, first, last, tried.touching, self.pieces, config)
        stuck = [(m.start_m, m.end_m) for m in state.mended if not m.free and m not in self.state.mended]
        return dataclasses.replace(tried, state=state, hopeless=stuck, mended=True)

    def _bent(self, keypoint: int, eye: NDArray[np.float64], legs: Legs, config: TrajoptConfig) -> _Try:
        """Returns the state with a keypoint moved, solved and drawn, and where it collides."""
        radius = float(self._radii(eye[None])[0])
        moved = bent(self.state, keypoint, eye, radius, legs, self.pieces.spacing_m)
        first, last = moved.window(keypoint)
        if config is self.config:
            moved = moved.relaxed(first, last)
        solution = self.pieces.solve(moved, first, last, config)
        state, touching = self._guard.swept(dataclasses.replace(moved, x=solution.x), first, last)
        hopeless = self._guard.hopeless(state, touching)
        return _Try(state=state, touching=touching, hopeless=hopeless, solution=solution)

    def _other_legs(self, keypoint: int, eye: NDArray[np.float64], legs: Legs, hopeless: Stretches) -> Legs | None:
        """Returns the legs, those found anew that are bent through a wall; None where there is none to find."""
        if self.router is None or not hopeless:
            return None
        first, last = self.state.window(keypoint)
        here = float(self.state.keypoint_m[keypoint])
        begin, end = (self.state.tour.at(self.state.arc_m[at])[0] for at in (first, last))
        before, after = legs
        if before is None and any(a < here for a, _ in hopeless):
            before = self.router.way(begin, eye)
        if after is None and any(b > here for _, b in hopeless):
            after = self.router.way(eye, end)
        found = before is not legs[0] or after is not legs[1]
        return (before, after) if found else None

    def _checked(self, state: State, first: int, last: int, config: TrajoptConfig) -> State:
        """Draws the curve through points `first` to `last` anew, sweeps the body along it and repairs it."""
        state, touching = self._guard.swept(state, first, last)
        return self._guard.mended(state, first, last, touching, self.pieces, config)
