# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A keypoint that moves: its legs bent, or found anew where a bent one leads through a wall; solved, swept, mended."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from walk_building.route import Router
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.guard import Guard, Stretches
from walk_trajopt.pieces import Pieces
from walk_trajopt.solvers import Solution
from walk_trajopt.state import Legs, State, bent

_HASTY_ITERATIONS, _HASTY_TOLERANCE = 10, 1e-2  # of a drag: the next one goes on from there, a release takes its time
# Of any other move: from between two minima the cost falls slowly at first, and a bent piece often begins there.
_PATIENCE = 0.1


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Move:
    """What is wanted."""

    keypoint: int
    eye: NDArray[np.float64]  # (3,) over the floor [m]
    radius_m: float  # how near to pass
    hasty: bool  # one of many that follow each other


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Moved:
    """What became of it."""

    state: State  # without its terms
    touching: Stretches  # of the way as it was solved
    hopeless: Stretches  # where it collides and could not be mended
    solution: Solution
    mended: bool = False


class Mover:
    """Moves keypoints.

    Attributes:
        router: Finds legs anew; None for none.
    """

    def __init__(self, guard: Guard, pieces: Pieces, config: TrajoptConfig, router: Router | None) -> None:
        self.router = router
        self._guard, self._pieces = guard, pieces
        self._config = dataclasses.replace(config, tolerance=max(_PATIENCE * config.tolerance, 1e-15))
        self._hasty = dataclasses.replace(
            config,
            max_iterations=min(config.max_iterations, _HASTY_ITERATIONS),
            tolerance=max(config.tolerance, _HASTY_TOLERANCE),
        )

    def moved(self, state: State, move: Move, legs: Legs) -> Moved:
        """Returns a state with a keypoint moved, checked.

        Args:
            state: Solved and checked.
            move: Which one, and where to.
            legs: Planned ones to take; None for one that is bent and, where that leads through a wall, found anew.
        """
        moved = self._bent(state, move, legs)
        # A leg that is found anew may push the other one, which was bent, into a wall of its own: twice at most.
        while True:
            if not moved.hopeless:
                moved = self._mended(state, move, moved)
            others = self._other_legs(state, move, legs, moved.hopeless)
            if others is None:
                break
            legs = others
            moved = self._bent(state, move, legs)
        # In vain, most likely; a hand that goes on does not wait for it.
        return moved if moved.mended or move.hasty else self._mended(state, move, moved)

    def rehearse(self, state: State) -> None:
        """Mends what needs no mending and finds a way that nobody takes: code is slow the first time it runs."""
        middle_m = 0.5 * state.tour.length_m
        self._guard.mended(state, 0, len(state.x) - 1, [(middle_m, middle_m)], self._pieces, self._hasty)
        if self.router is not None and len(state.keypoints):
            self.router.way(state.keypoints[0], state.keypoints[-1])

    def _bent(self, old: State, move: Move, legs: Legs) -> Moved:
        """Returns the state with the keypoint moved, solved and drawn, and where it collides."""
        state = bent(old, move.keypoint, move.eye, move.radius_m, legs, self._pieces.spacing_m)
        first, last = state.window(move.keypoint)
        if not move.hasty:
            state = state.relaxed(first, last)
        solution = self._pieces.solve(state, first, last, self._hasty if move.hasty else self._config)
        state, touching = self._guard.swept(state, solution.x, first, last)
        hopeless = self._guard.hopeless(state, touching)
        return Moved(state=state, touching=touching, hopeless=hopeless, solution=solution)

    def _mended(self, old: State, move: Move, moved: Moved) -> Moved:
        first, last = moved.state.window(move.keypoint)
        config = self._hasty if move.hasty else self._config
        state = self._guard.mended(moved.state, first, last, moved.touching, self._pieces, config)
        stuck = [(m.start_m, m.end_m) for m in state.mended if not m.free and m not in old.mended]
        return dataclasses.replace(moved, state=state, hopeless=stuck, mended=True)

    def _other_legs(self, old: State, move: Move, legs: Legs, hopeless: Stretches) -> Legs | None:
        """Returns the legs, those found anew that are bent through a wall; None where there is none to find."""
        if self.router is None or not hopeless:
            return None
        first, last = old.window(move.keypoint)
        here = float(old.keypoint_m[move.keypoint])
        begin, end = (old.tour.at(old.arc_m[at])[0] for at in (first, last))
        before, after = legs
        if before is None and any(a < here for a, _ in hopeless):
            before = self.router.way(begin, move.eye)
        if after is None and any(b > here for _, b in hopeless):
            after = self.router.way(move.eye, end)
        found = before is not legs[0] or after is not legs[1]
        return (before, after) if found else None
