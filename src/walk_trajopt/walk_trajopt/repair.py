# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Local repair: where the body does not pass on the optimised path, that stretch goes back towards the planned tour.

The planned tour is free by construction, so a wide enough stretch of it, with its corners as round as they may be,
always serves; the attempts are ordered from the least change to the most.
"""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from walk_trajopt.blending import blended
from walk_trajopt.check import PathCheck, colliding_runs
from walk_trajopt.polyline import Polyline
from walk_trajopt.redraw import SAME_M, replaced

_GAP_M = 0.5  # colliding stretches closer than a step are mended as one
_RAMPS_M = (0.5, 1.0, 2.0, 4.0, 8.0)  # over which a stretch goes over into its neighbours


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Way:
    """A polyline whose points know which arc length of the planned tour they belong to."""

    points: NDArray[np.float64]  # (m, 3) [m]
    tour_m: NDArray[np.float64]  # (m,) rising

    def between(self, low_m: float, high_m: float) -> Way:
        """Returns the piece whose arc lengths on the tour are from `low_m` to `high_m`."""
        begin = self.tour_m.searchsorted(low_m - SAME_M)
        end = self.tour_m.searchsorted(high_m + SAME_M, side="right")
        return Way(points=self.points[begin:end], tour_m=self.tour_m[begin:end])

    def replaced(self, piece: Way) -> Way:
        """Returns the way with what lies between the ends of `piece` replaced by it."""
        points, tour_m = replaced((self.points, self.tour_m), (piece.points, piece.tour_m))
        return Way(points=points, tour_m=tour_m)


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Mended:
    """A stretch of the tour that did not pass."""

    start_m: float  # arc length on the planned tour
    end_m: float
    free: bool  # passes now
    how: str


@dataclasses.dataclass(frozen=True, slots=True)
class _Attempt:
    share: float  # how far towards the planned tour
    radius_m: float  # over which the tour's corners are rounded
    how: str


_ATTEMPTS = (
    _Attempt(0.5, 0.4, "moved halfway to the planned tour"),
    _Attempt(1.0, 0.4, "moved to the planned tour with its corners rounded"),
    _Attempt(1.0, 0.15, "moved to the planned tour with its corners slightly rounded"),
    _Attempt(1.0, 0.0, "moved to the planned tour"),
)


def colliding(way: Way, check: PathCheck, window_m: tuple[float, float]) -> list[tuple[float, float]]:
    """Returns the stretches of the way within a window, as arc lengths on the tour, that the body does not pass."""
    begin = max(int(way.tour_m.searchsorted(window_m[0], side="right")) - 1, 0)
    end = min(int(way.tour_m.searchsorted(window_m[1])), len(way.tour_m) - 1)
    free = check.segments_free(way.points[begin : end + 1], remember=True)
    return colliding_runs(free, way.tour_m[begin : end + 1], _GAP_M)


def planned_way_is_free(
    way: Way, tour: Polyline, keep_m: NDArray[np.float64], pins: Way, check: PathCheck, core_m: tuple[float, float]
) -> bool:
    """Returns whether the body passes on the planned tour itself along a stretch [m of the tour]."""
    start, end = core_m
    planned = _piece(way, tour, (keep_m, pins), core_m, 1e-3, _ATTEMPTS[-1])
    inner = (planned.tour_m >= start) & (planned.tour_m <= end)
    return bool(check.segments_free(planned.points[inner]).all())


def repair(
    way: Way,
    tour: Polyline,
    keep_m: NDArray[np.float64],
    pins: Way,
    check: PathCheck,
    stretches_m: list[tuple[float, float]],
) -> tuple[Way, list[Mended]]:
    """Mends stretches that do not pass.

    Args:
        way: The optimised path.
        tour: The planned polyline, by whose arc length the way is parametrised.
        keep_m: Arc lengths on the tour that must stay points of the way: those of the keypoints.
        pins: What the way passes exactly.
        check: What tells where the body passes.
        stretches_m: What does not pass, as `colliding` returns it.

    Returns:
        The way, and what was done about each stretch, `free` telling with what success.
    """
    done = []
    for start, end in stretches_m:
        way, mended = _mend(way, tour, (keep_m, pins), check, (start, end))
        done.append(mended)
    return way, done


def _mend(
    way: Way, tour: Polyline, keep: tuple[NDArray[np.float64], Way], check: PathCheck, core_m: tuple[float, float]
) -> tuple[Way, Mended]:
    start, end = core_m
    tour_free = planned_way_is_free(way, tour, *keep, check, core_m)
    for ramp in (*_RAMPS_M, tour.length_m):
        for attempt in _ATTEMPTS:
            piece = _piece(way, tour, keep, core_m, ramp, attempt)
            if check.segments_free(piece.points).all():
                return way.replaced(piece), Mended(start_m=start, end_m=end, free=True, how=attempt.how)
        if not tour_free:
            break
    how = "the body touches the building here, and on the planned tour too"
    return way, Mended(start_m=start, end_m=end, free=False, how=how)


def _piece(
    way: Way,
    tour: Polyline,
    keep: tuple[NDArray[np.float64], Way],
    core_m: tuple[float, float],
    ramp_m: float,
    attempt: _Attempt,
) -> Way:
    """Returns the stretch, drawn towards the tour over its core and going over into the way on both sides."""
    keep_m, pins = keep
    line, pinned = (way.points, way.tour_m), (pins.points, pins.tour_m)
    amount = attempt.share, attempt.radius_m
    points, arc = blended(line, (tour.points, tour.arc_m), keep_m, pinned, core_m, float(ramp_m), amount)
    return Way(points=points, tour_m=arc)
