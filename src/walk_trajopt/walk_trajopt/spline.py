# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The manual mode of the source, and its baseline: a spline through the keypoints in their order, not optimised."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import make_interp_spline

from walk_building.building import Building
from walk_building.errors import ParameterError
from walk_trajopt.check import PathCheck, colliding_runs
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.curve import refine
from walk_trajopt.path import OptimisedPath, Stretch, read_only
from walk_trajopt.polyline import arc_lengths, as_polyline_points

KINDS = ("catmull_rom", "b_spline")
_STEP_M = 0.1  # between the points of a B-spline before it is refined


def spline_path(
    building: Building, keypoints: ArrayLike, config: TrajoptConfig | None = None, kind: str = "catmull_rom"
) -> OptimisedPath:
    """Returns a spline through the keypoints; where the body collides on it is reported, not repaired.

    Args:
        building: Against which the body is swept.
        keypoints: (M, 3) eye positions in the order of the walk, M >= 2 [m].
        config: For the chord error.
        kind: "catmull_rom", with centripetal knots, or "b_spline", the cubic B-spline that interpolates.

    Raises:
        ParameterError: Fewer than two different keypoints, numbers that are not finite, or another kind.
    """
    config = config or TrajoptConfig()
    if kind not in KINDS:
        raise ParameterError("kind", kind, "one of " + ", ".join(KINDS))
    given = as_polyline_points("keypoints", keypoints)
    distinct = np.concatenate([[True], np.linalg.norm(np.diff(given, axis=0), axis=1) > 1e-6])
    through = given[distinct]
    if len(through) < 2:
        raise ParameterError("keypoints", "all at one place", "at least 2 different places")
    points, place = _curve(through, config.chord_error_m, kind)
    arc = arc_lengths(points)
    free = PathCheck(building.geometry, building.walker).segments_free(points)
    at = place[np.searchsorted(arc, [m for run in colliding_runs(free, arc, 0.5) for m in run])].reshape(-1, 2)
    colliding = tuple(
        Stretch(
            start_m=start,
            end_m=end,
            after_keypoint=int(np.floor(first)),
            before_keypoint=int(np.ceil(last)),
            how="the body touches the building",
        )
        for (start, end), (first, last) in zip(colliding_runs(free, arc, 0.5), at, strict=True)
    )
    index = np.searchsorted(place, np.cumsum(distinct) - 1 - 1e-9)
    return OptimisedPath(
        points=read_only(points),
        keypoint_index=index.astype(np.int64),
        cost={},
        iterations=0,
        evaluations=0,
        solver=kind,
        repaired=(),
        colliding=colliding,
    )


def _curve(
    through: NDArray[np.float64], chord_error_m: float, kind: str
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns a fine polyline and for each vertex its place among the points, a rising number."""
    if kind == "catmull_rom" or len(through) < 3:
        return refine(through, chord_error_m, exponent=0.5)
    chord = np.sqrt(np.linalg.norm(np.diff(through, axis=0), axis=1))
    knots = np.concatenate([[0.0], np.cumsum(chord)])
    spline = make_interp_spline(knots, through, k=min(3, len(through) - 1))
    pieces = np.maximum(np.ceil(chord**2 / _STEP_M), 1).astype(int)
    place = np.concatenate([i + np.arange(n) / n for i, n in enumerate(pieces)] + [np.array([len(through) - 1.0])])
    fine, at = refine(spline(np.interp(place, np.arange(len(knots)), knots)), chord_error_m)
    return fine, np.interp(at, np.arange(len(place)), place)
