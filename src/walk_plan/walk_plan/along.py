# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Polylines by the length walked along them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def walked_m(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the length walked up to each of the (n, 3) points, (n,) from 0 [m]."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def every(points: NDArray[np.float64], spacing_m: float) -> NDArray[np.float64]:
    """Returns points on the polyline, ends included, evenly spaced and no farther apart than `spacing_m`."""
    at = walked_m(points)
    count = int(np.ceil(at[-1] / spacing_m)) + 1
    where = np.linspace(0.0, at[-1], max(count, 2))
    return np.column_stack([np.interp(where, at, points[:, i]) for i in range(3)])


def densified(points: NDArray[np.float64], spacing_m: float) -> NDArray[np.float64]:
    """Returns the (n, d) points with as many between as keep neighbours within `spacing_m`."""
    pieces = np.maximum(np.ceil(np.linalg.norm(np.diff(points, axis=0), axis=1) / spacing_m).astype(int), 1)
    share = (np.arange(pieces.sum()) - np.repeat(np.cumsum(pieces) - pieces, pieces)) / np.repeat(pieces, pieces)
    start, step = np.repeat(points[:-1], pieces, axis=0), np.repeat(np.diff(points, axis=0), pieces, axis=0)
    return np.vstack([start + share[:, None] * step, points[-1:]])
