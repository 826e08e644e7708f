# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a new tour shares with the one that is solved: legs between the same keypoints are taken over as they are."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from walk_trajopt.polyline import Polyline, arc_lengths
from walk_trajopt.repair import Mended, Way
from walk_trajopt.state import State

_SAME_PLACE_M = 0.01  # a keypoint that moved less has not moved: floors are found in more than one way
_LONGER, _LONGER_M = 1.1, 0.5  # a bent leg this much longer than the newly planned one is given up for it
_PINNED_M = 1e-9


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Leg:
    """A state's piece between two neighbouring keypoints, its parameters counted from its own start."""

    tour: Polyline
    arc_m: NDArray[np.float64]  # (k,)
    start: NDArray[np.float64]  # (k, 3)
    x: NDArray[np.float64]  # (k, 3)
    firmness: NDArray[np.float64]  # (k,)
    way: Way
    mended: tuple[Mended, ...]
    span_m: float  # of the parameter

    @property
    def length_m(self) -> float:
        """Length of the planned leg [m]."""
        return float(arc_lengths(self.start)[-1])


def leg_of(state: State, k: int) -> Leg:
    """Returns the leg from keypoint `k` to the next."""
    low, high = float(state.keypoint_m[k]), float(state.keypoint_m[k + 1])
    rows = slice(int(state.keypoint_index[k]), int(state.keypoint_index[k + 1]) + 1)
    inside = (state.tour.arc_m >= low) & (state.tour.arc_m <= high)
    way = state.way.between(low, high)
    return Leg(
        tour=Polyline(state.tour.points[inside], state.tour.arc_m[inside] - low),
        arc_m=state.arc_m[rows] - low,
        start=state.start[rows],
        x=state.x[rows],
        firmness=state.firmness[rows],
        way=Way(points=way.points, tour_m=way.tour_m - low),
        mended=tuple(_shifted(m, -low) for m in state.mended if low <= 0.5 * (m.start_m + m.end_m) < high),
        span_m=high - low,
    )


def revised(old: State, fresh: State, came_from: NDArray[np.int64]) -> tuple[State, list[tuple[int, int]]]:
    """Returns a new tour's state with the legs of the old one that still hold, and what is to be solved.

    Args:
        old: Solved and checked.
        fresh: Of the new tour, its points on the tour itself; both begin and end at a keypoint.
        came_from: (M,) index of each new keypoint in the old state, −1 for a new one.

    Returns:
        The state, and the ranges of points (first, last) in which it is not solved: around the legs that are new.
    """
    fresh_legs = [leg_of(fresh, k) for k in range(len(fresh.keypoints) - 1)]
    kept = [_kept(old, fresh, k, came_from, leg) for k, leg in enumerate(fresh_legs)]
    legs = [mine or leg for mine, leg in zip(kept, fresh_legs, strict=True)]
    state = _joined(fresh, legs, [leg is not None for leg in kept])
    stays = [_stays(old, fresh, k, came_from) for k in range(len(came_from))]
    windows = _windows([leg is not None for leg in kept], stays)
    for k in sorted({0, len(legs), *np.flatnonzero(state.pinned).tolist()}):
        # A keypoint that has just been locked, or become the first or the last, is passed exactly from now on.
        if np.linalg.norm(state.x[state.keypoint_index[k]] - state.keypoints[k]) > _PINNED_M:
            state.x[state.keypoint_index[k]] = state.keypoints[k]
            windows.append((max(k - 1, 0), min(k + 1, len(legs))))
    at = state.keypoint_index
    return state, [(int(at[a]), int(at[b])) for a, b in _merged(windows)]


def ends_at_keypoints(state: State) -> bool:
    """Returns whether a state's points begin and end at keypoints, no two of which share a point."""
    index = state.keypoint_index
    return len(index) >= 2 and index[0] == 0 and index[-1] == len(state.x) - 1 and bool((np.diff(index) > 0).all())


def share_of_new(old: State, fresh: State, came_from: NDArray[np.int64]) -> float:
    """Returns which share of the new tour's legs, 0 to 1, has not been solved yet."""
    legs = len(fresh.keypoints) - 1
    known = sum(_kept(old, fresh, k, came_from, leg_of(fresh, k)) is not None for k in range(legs))
    return 1.0 - known / max(legs, 1)


def _kept(old: State, fresh: State, k: int, came_from: NDArray[np.int64], leg: Leg) -> Leg | None:
    """Returns the old state's leg that may stand for leg `k` of the new tour."""
    a, b = int(came_from[k]), int(came_from[k + 1])
    if b != a + 1 or not (_stays(old, fresh, k, came_from) and _stays(old, fresh, k + 1, came_from)):
        return None
    mine = leg_of(old, a)
    return mine if mine.length_m <= _LONGER * leg.length_m + _LONGER_M else None


def _stays(old: State, fresh: State, k: int, came_from: NDArray[np.int64]) -> bool:
    """Returns whether keypoint `k` of the new tour is where it was."""
    known = int(came_from[k])
    return known >= 0 and bool(np.abs(old.keypoints[known] - fresh.keypoints[k]).max() <= _SAME_PLACE_M)


def _windows(kept: list[bool], stays: list[bool]) -> list[tuple[int, int]]:
    """Returns the runs of new legs as ranges of keypoints.

    A single new leg between keypoints that stay is there because one was taken away from between, or the order changed:
    the legs beside it, drawn towards something else, are solved again too.
    """
    out = []
    for run in np.split(np.arange(len(kept)), np.flatnonzero(np.diff(kept)) + 1):
        if len(run) and not kept[run[0]]:
            beside = 1 if len(run) == 1 and stays[run[0]] and stays[run[0] + 1] else 0
            out.append((max(int(run[0]) - beside, 0), min(int(run[-1]) + 1 + beside, len(kept))))
    return out


def _merged(windows: list[tuple[int, int]]) -> list[tuple[int, int]]:
    out: list[tuple[int, int]] = []
    for a, b in sorted(windows):
        if out and a < out[-1][1]:
            out[-1] = (out[-1][0], max(b, out[-1][1]))
        else:
            out.append((a, b))
    return out


def _joined(fresh: State, legs: list[Leg], kept: list[bool]) -> State:
    """Returns the legs one behind the other; where a kept one meets a new one, the kept one's end counts."""
    begins = np.concatenate([[0.0], np.cumsum([leg.span_m for leg in legs])])
    index = np.concatenate([[0], np.cumsum([len(leg.arc_m) - 1 for leg in legs])]).astype(np.int64)

    def chained(pieces: list[NDArray[np.float64]]) -> NDArray[np.float64]:
        return np.concatenate([piece[:-1] for piece in pieces[:-1]] + pieces[-1:])

    x = chained([leg.x for leg in legs])
    for k in np.flatnonzero(kept):
        x[index[k] : index[k + 1] + 1] = legs[k].x
    shifted = list(zip(legs, begins[:-1], strict=True))
    tour_m = chained([begin + leg.tour.arc_m for leg, begin in shifted])
    way_m = chained([begin + leg.way.tour_m for leg, begin in shifted])
    return dataclasses.replace(
        fresh,
        tour=Polyline(chained([leg.tour.points for leg in legs]), tour_m),
        keypoint_m=begins,
        keypoint_index=index,
        start=chained([leg.start for leg in legs]),
        arc_m=chained([begin + leg.arc_m for leg, begin in shifted]),
        x=x,
        firmness=chained([leg.firmness for leg in legs]),
        way=Way(points=chained([leg.way.points for leg in legs]), tour_m=way_m),
        mended=tuple(_shifted(m, begin) for leg, begin in shifted for m in leg.mended),
    )


def _shifted(mended: Mended, by_m: float) -> Mended:
    return dataclasses.replace(mended, start_m=mended.start_m + by_m, end_m=mended.end_m + by_m)
