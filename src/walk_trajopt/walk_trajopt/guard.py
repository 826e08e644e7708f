# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From solved points to a way that the body was swept along: drawn, swept, and mended where it does not pass."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_trajopt.bending import FIRM
from walk_trajopt.check import PathCheck
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.pieces import Pieces
from walk_trajopt.repair import Mended, colliding, planned_way_is_free, repair
from walk_trajopt.state import State, drawn

Stretches = list[tuple[float, float]]

_EASE_M = 1.5  # on both sides of a colliding stretch that is optimised again
_EASED = "optimised again with more weight on the clearance"


class Guard:
    """Holds a state's way to the guarantee."""

    def __init__(self, building: Building, chord_error_m: float) -> None:
        self._check = PathCheck(building.geometry, building.walker, building.surface)
        self._chord_error_m = chord_error_m

    def passes(self, state: State) -> bool:
        """Returns whether the body passes along the whole way."""
        return not colliding(state.way, self._check, (float(state.arc_m[0]), float(state.arc_m[-1])))

    def swept(self, state: State, x: NDArray[np.float64], first: int, last: int) -> tuple[State, Stretches]:
        """Returns the state with other points `x` (n, 3) from `first` to `last`, and where it collides.

        Its way is drawn anew there.
        """
        begin, end = _reach(state, first, last)
        state = drawn(state, x, begin, end, self._chord_error_m)
        return state, colliding(state.way, self._check, _window(state, first, last))

    def hopeless(self, state: State, touching: Stretches) -> Stretches:
        """Returns the stretches in which the planned tour does not pass either: there is nothing to go back to."""
        return [
            stretch
            for stretch in touching
            if not planned_way_is_free(state.way, state.tour, state.keypoint_m, state.pins(), self._check, stretch)
        ]

    def mended(
        self, state: State, first: int, last: int, touching: Stretches, pieces: Pieces, config: TrajoptConfig
    ) -> State:
        """Returns a swept state with what collides optimised again, firmer, and repaired where that is not enough.

        Args:
            state: As `swept` returns it.
            first: The first point of the window.
            last: The last one.
            touching: As `swept` returns it.
            pieces: Solves again.
            config: For that.
        """
        if not (touching or state.mended):
            return state
        soft = [stretch for stretch in touching if not _is_firm(state, stretch)]
        for stretch in soft:
            state = _eased(state, stretch, (first, last), pieces, config)
        eased = [Mended(start_m=a, end_m=b, free=True, how=_EASED) for a, b in soft]
        if eased:
            state, touching = self.swept(state, state.x, first, last)
        way, mended = repair(state.way, state.tour, state.keypoint_m, state.pins(), self._check, touching)
        eased = [e for e in eased if not any(_meet(m, e) for m in mended)]
        kept = [m for m in state.mended if _stays(m, state, first, last) and not any(_meet(m, e) for e in eased)]
        return dataclasses.replace(state, way=way, mended=tuple(sorted(kept + eased + mended, key=lambda m: m.start_m)))


def _eased(
    state: State, stretch_m: tuple[float, float], limits: tuple[int, int], pieces: Pieces, config: TrajoptConfig
) -> State:
    """Optimises a stretch that collides again: from the planned tour, with more weight on the clearance."""
    first = max(int(np.searchsorted(state.arc_m, stretch_m[0] - _EASE_M)), limits[0])
    last = min(int(np.searchsorted(state.arc_m, stretch_m[1] + _EASE_M)), limits[1])
    if last - first < 2:
        return state
    x, firmness = state.x.copy(), state.firmness.copy()
    x[first + 1 : last] = state.start[first + 1 : last]
    firmness[first + 1 : last] = FIRM
    state = dataclasses.replace(state, x=x, firmness=firmness)
    return dataclasses.replace(state, x=pieces.solve(state, first, last, config).x)


def _is_firm(state: State, stretch_m: tuple[float, float]) -> bool:
    """Whether the clearance counts more already at every point about a stretch: more of the same would be in vain."""
    before = max(int(state.arc_m.searchsorted(stretch_m[0], side="right")) - 1, 0)
    after = int(state.arc_m.searchsorted(stretch_m[1]))
    return bool((state.firmness[before : after + 1] > 1.0).all())


def _reach(state: State, first: int, last: int) -> tuple[int, int]:
    """A curve reaches one span beyond a moved point."""
    return max(first - 1, 0), min(last + 1, len(state.x) - 1)


def _window(state: State, first: int, last: int) -> tuple[float, float]:
    begin, end = _reach(state, first, last)
    return float(state.arc_m[begin]), float(state.arc_m[end])


def _meet(a: Mended, b: Mended) -> bool:
    return a.start_m < b.end_m and a.end_m > b.start_m


def _stays(mended: Mended, state: State, first: int, last: int) -> bool:
    """Whether a stretch is outside of a window, or still firm within it."""
    low, high = _window(state, first, last)
    if mended.end_m < low or mended.start_m > high:
        return True
    firm = state.firmness[(state.arc_m >= mended.start_m) & (state.arc_m <= mended.end_m)]
    return mended.how == _EASED and bool((firm > 1.0).any())
