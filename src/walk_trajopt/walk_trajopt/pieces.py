# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The problem of a piece of a state: some points move, all others stay."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.objectives import Setting
from walk_trajopt.problem import Problem
from walk_trajopt.solvers import SOLVERS, Solution
from walk_trajopt.state import State, around

_RECENT = 4  # problems whose knowledge of the geometry is kept

Watch = Callable[[Problem, NDArray[np.float64], float], None]


class Pieces:
    """Solves pieces of a state.

    Attributes:
        spacing_m: h, the mean distance between points of the tour that was solved as a whole.
        watch: Told of each problem that is solved, where it started and at what cost it ended; for benchmarks.
    """

    def __init__(self, building: Building, config: TrajoptConfig, spacing_m: float) -> None:
        self.spacing_m = spacing_m
        self.watch: Watch | None = None
        self._recent: dict[int, Problem] = {}
        self._building = building
        self._config = config
        # What was solved last and where: its terms need not be asked of the geometry again.
        self._last: tuple[Problem, Solution, tuple[int, int]] | None = None

    def solve(self, state: State, first: int, last: int, config: TrajoptConfig) -> Solution:
        """Returns the state's points (n, 3) with those between `first` and `last` optimised; these two stay too."""
        low, high = around(state, first, last)
        fixed = np.ones(high - low, bool)
        fixed[first + 1 - low : last - low] = False
        if state.pinned.any():
            pins = state.keypoint_index[state.pinned] - low
            fixed[pins[(pins >= 0) & (pins < high - low)]] = True
        setting, before = self._setting(state, low, high), self._recent.get(high - low)
        problem = Problem(setting, config, fixed, state.firmness[low:high], before)
        self._keep(problem)
        solution = SOLVERS[config.solver](problem, state.x[low:high], config)
        if self.watch is not None:
            self.watch(problem, state.x[low:high], solution.cost)
        x = state.x.copy()
        x[low:high] = solution.x
        solution = dataclasses.replace(solution, x=x)
        self._last = problem, solution, (low, high)
        return solution

    def _keep(self, problem: Problem) -> None:
        """Keeps a problem by its size: a hand moves one keypoint many times, and what is near its legs stays near."""
        size = len(problem.fixed)
        self._recent.pop(size, None)
        self._recent[size] = problem
        if len(self._recent) > _RECENT:
            del self._recent[next(iter(self._recent))]

    def terms(self, state: State) -> dict[str, NDArray[np.float64]]:
        """Returns the weighted terms (n,) of each objective, by name."""
        return self._problem(state, 0, len(state.x)).terms(state.x)

    def spliced_terms(self, old: State, new: State, first: int, last: int) -> dict[str, NDArray[np.float64]]:
        """Returns the terms of a state that differs from another one between two points: beside, they stay.

        Args:
            old: With its terms; where it has none, all are computed.
            new: Without.
            first: In `new`, the last point before what differs.
            last: In `new`, the first point behind it.
        """
        if not old.terms:
            return self.terms(new)
        low, high = around(new, first, last)
        own = self._known_terms(new, (low, high)) or self._problem(new, low, high).terms(new.x[low:high])
        added = len(new.x) - len(old.x)
        return {
            name: np.concatenate([values[:low], own[name][: last - low], values[last - added :]])
            for name, values in old.terms.items()
        }

    def _known_terms(self, state: State, window: tuple[int, int]) -> dict[str, NDArray[np.float64]] | None:
        if self._last is None:
            return None
        problem, solution, where = self._last
        if solution.x is not state.x or where != window or solution.local is None:
            return None
        return problem.terms_of(solution.local)

    def _problem(self, state: State, low: int, high: int) -> Problem:
        return Problem(self._setting(state, low, high), self._config, np.zeros(high - low, bool))

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
            clearance_m=self._config.clearance_m,
            clearance_of=self._config.clearance_of,
        )
