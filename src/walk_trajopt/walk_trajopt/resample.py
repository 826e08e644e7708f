# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The planned tour as evenly spaced points, with the keypoints among them."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from walk_building.errors import ParameterError
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.polyline import Polyline

_MIN_POINTS = 100  # of the source; a short tour gets no fewer


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Samples:
    """Points on a polyline."""

    points: NDArray[np.float64]  # (n, 3) [m]
    arc_m: NDArray[np.float64]  # (n,) arc length of each on the polyline, rising
    keypoint_index: NDArray[np.int64]  # (M,) the point that is each keypoint's


def keypoint_arcs(line: Polyline, keypoints: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the arc lengths (M,) at which the polyline passes the keypoints (M, 3), in their order.

    The vertices are chosen that lie nearest to the keypoints in the sum of squares, among all choices that keep
    the order: a tour may come past a keypoint before it is that keypoint's turn. By dynamic programming.
    """
    if len(keypoints) == 0:
        return np.zeros(0)
    square = ((keypoints[:, None, :] - line.points[None, :, :]) ** 2).sum(axis=2)
    best = np.empty_like(square)
    best[0] = square[0]
    for k in range(1, len(keypoints)):
        best[k] = square[k] + np.minimum.accumulate(best[k - 1])
    index = np.empty(len(keypoints), np.int64)
    last = len(line.points)
    for k in range(len(keypoints) - 1, -1, -1):
        index[k] = int(np.argmin(best[k, :last]))
        last = int(index[k]) + 1
    return line.arc_m[index]


def resample(line: Polyline, arcs_m: NDArray[np.float64], n: int) -> Samples:
    """Returns `n` points, as evenly spaced as it can be done with a point at each of the arc lengths (M,).

    Raises:
        ParameterError: Fewer points than there are keypoints and ends.
    """
    stops = np.unique(np.concatenate([[0.0], arcs_m, [line.length_m]]))
    counts = _shares(np.diff(stops), n - 1)
    arc = np.concatenate(
        [np.linspace(a, b, c, endpoint=False) for a, b, c in zip(stops[:-1], stops[1:], counts, strict=True)]
        + [stops[-1:]]
    )
    first = np.concatenate([[0], np.cumsum(counts)])
    return Samples(points=line.at(arc), arc_m=arc, keypoint_index=first[np.searchsorted(stops, arcs_m)])


def point_count(length_m: float, config: TrajoptConfig) -> int:
    """Returns how many points a polyline of that length is resampled to."""
    if config.points > 0:
        return config.points
    return max(_MIN_POINTS, int(np.ceil(length_m / config.spacing_m)) + 1)


def _shares(lengths_m: NDArray[np.float64], total: int) -> NDArray[np.int64]:
    """Splits `total` intervals over the lengths: each at least one, the rest where intervals are longest."""
    if total < len(lengths_m):
        raise ParameterError("points", total + 1, f"at least {len(lengths_m) + 1}, one for each keypoint and end")
    counts = np.maximum((lengths_m / lengths_m.sum() * total).astype(np.int64), 1)
    while counts.sum() != total:
        if counts.sum() < total:
            counts[np.argmax(lengths_m / counts)] += 1
        else:
            counts[np.argmin(np.where(counts > 1, lengths_m / (counts - 1.0 + (counts == 1)), np.inf))] -= 1
    return counts
