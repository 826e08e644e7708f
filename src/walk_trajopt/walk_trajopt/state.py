# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The state of an optimiser, and how a moved keypoint bends it before it is optimised again."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from walk_trajopt.bending import bent_arcs, bent_points, bent_tour, spliced
from walk_trajopt.polyline import Polyline
from walk_trajopt.redraw import redrawn
from walk_trajopt.repair import Mended, Way
from walk_trajopt.resample import resample

_NO_LEG = np.empty(0), np.empty((0, 3))
_BESIDE = 2  # fixed points beside a window: as many as the widest difference reaches
Legs = tuple[NDArray[np.float64] | None, NDArray[np.float64] | None]
"""Newly planned legs to and from a keypoint, (L, 3) each; None for one that is bent instead."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class State:
    """One solved problem. Never changed: an edit makes a new one, and undo takes the old one back.

    Attributes:
        tour: The planned polyline; its parameter is arc length until an edit bends it.
        keypoints: (M, 3) [m].
        radius_m: (M,) how near to each to pass [m].
        pinned: (M,) whether the path passes it exactly, as it does a locked one.
        keypoint_m: (M,) parameter of the tour at each keypoint.
        keypoint_index: (M,) the point that is each keypoint's.
        start: (n, 3) the points on the tour, x⁰.
        arc_m: (n,) parameter of the tour at each point.
        x: (n, 3) the optimised points.
        firmness: (n,) how many times as much the clearance counts at each: 1, or FIRM where it had to be more.
        way: The checked curve through them.
        mended: What the repair did.
        terms: The weighted terms (n,) of each objective at `x`, by name; empty where nobody has asked for them yet.
    """

    tour: Polyline
    keypoints: NDArray[np.float64]
    radius_m: NDArray[np.float64]
    pinned: NDArray[np.bool_]
    keypoint_m: NDArray[np.float64]
    keypoint_index: NDArray[np.int64]
    start: NDArray[np.float64]
    arc_m: NDArray[np.float64]
    x: NDArray[np.float64]
    firmness: NDArray[np.float64]
    way: Way
    mended: tuple[Mended, ...]
    terms: dict[str, NDArray[np.float64]]

    @property
    def cost(self) -> dict[str, float]:
        """Weighted value of each objective at `x`, by name."""
        return {name: float(values.sum()) for name, values in self.terms.items()}

    def window(self, keypoint: int) -> tuple[int, int]:
        """Returns the first and the last point of the legs beside a keypoint."""
        first = int(self.keypoint_index[keypoint - 1]) if keypoint > 0 else 0
        last = int(self.keypoint_index[keypoint + 1]) if keypoint + 1 < len(self.keypoints) else len(self.x) - 1
        return first, last

    def relaxed(self, first: int, last: int) -> State:
        """Returns the state with the clearance counting once between two points."""
        firmness = self.firmness.copy()
        firmness[first : last + 1] = 1.0
        return dataclasses.replace(self, firmness=firmness)

    def pins(self) -> Way:
        """Returns the places that the way must pass exactly."""
        return Way(points=self.keypoints[self.pinned], tour_m=self.keypoint_m[self.pinned])


def initial_state(
    tour: Polyline,
    keypoints: NDArray[np.float64],
    radius_m: NDArray[np.float64],
    pinned: NDArray[np.bool_],
    keypoint_m: NDArray[np.float64],
    n: int,
) -> State:
    """Returns the state whose points are on the tour itself."""
    samples = resample(tour, keypoint_m, n)
    points = samples.points
    points[samples.keypoint_index[pinned]] = keypoints[pinned]
    return State(
        tour=tour,
        keypoints=keypoints,
        radius_m=radius_m,
        pinned=pinned,
        keypoint_m=keypoint_m,
        keypoint_index=samples.keypoint_index,
        start=points,
        arc_m=samples.arc_m,
        x=points,
        firmness=np.ones(len(points)),
        way=Way(points=points, tour_m=samples.arc_m),
        mended=(),
        terms={},
    )


def around(state: State, first: int, last: int) -> tuple[int, int]:
    """Returns the range of points that terms of the cost between `first` and `last` refer to."""
    return max(first + 1 - _BESIDE, 0), min(last + _BESIDE, len(state.x))


def drawn(state: State, x: NDArray[np.float64], begin: int, end: int, chord_error_m: float) -> State:
    """Returns the state with optimised points `x` (n, 3), its way drawn anew between two of them, without the check."""
    points, tour_m = redrawn((state.way.points, state.way.tour_m), x, state.arc_m, (begin, end), chord_error_m)
    return dataclasses.replace(state, x=x, way=Way(points=points, tour_m=tour_m))


def bent(
    state: State,
    keypoint: int,
    position: NDArray[np.float64],
    radius_m: float,
    legs: Legs,
    spacing_m: float,
) -> State:
    """Returns the state, without terms, with a keypoint moved and the legs beside it bent, or replaced by planned ones.

    A leg is bent by moving its points along, fully at the keypoint and not at all at its other end; so are the
    optimised points, from where the optimiser then goes on.
    """
    first, last = state.window(keypoint)
    window = float(state.arc_m[first]), float(state.keypoint_m[keypoint]), float(state.arc_m[last])
    shift = position - state.keypoints[keypoint]
    tour = _bent_tour(state, window, shift, legs)
    old = slice(first, last + 1)
    arc = bent_arcs(tour.points, tour.arc_m, state.arc_m[old], window[1], spacing_m)
    start = tour.at(arc)
    if any(leg is not None for leg in legs):
        x, firmness = start.copy(), np.ones(len(arc))
        has_side = np.array([[window[0] < window[1]], [window[2] > window[1]]])
        x[[0, -1]] = np.where(has_side, state.x[[first, last]], position)
    else:
        x, firmness = bent_points(state.x[old], state.firmness[old], state.arc_m[old], arc, window, shift)
    index = state.keypoint_index.copy()
    index[keypoint + 1 :] += len(arc) - (last + 1 - first)
    index[keypoint] = first + int(np.abs(arc - window[1]).argmin())
    keypoints, radii = state.keypoints.copy(), state.radius_m.copy()
    keypoints[keypoint], radii[keypoint] = position, radius_m

    whole = spliced((state.start, state.arc_m, state.x, state.firmness), (start, arc, x, firmness), first, last)
    return dataclasses.replace(
        state,
        tour=tour,
        keypoints=keypoints,
        radius_m=radii,
        keypoint_index=index,
        start=whole[0],
        arc_m=whole[1],
        x=whole[2],
        firmness=whole[3],
        terms={},
    )


def _bent_tour(state: State, window: tuple[float, float, float], shift: NDArray[np.float64], legs: Legs) -> Polyline:
    low, here, high = window
    named = _named(legs[0], low, here), _named(legs[1], here, high)
    return Polyline(*bent_tour(state.tour.points, state.tour.arc_m, window, shift, named))


def _named(leg: NDArray[np.float64] | None, a: float, b: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns a planned leg with the tour's parameter at each vertex, from `a` to `b`; nothing for no leg."""
    if leg is None:
        return _NO_LEG
    line = Polyline(leg)
    return a + (b - a) * line.arc_m / max(line.length_m, 1e-9), line.points
