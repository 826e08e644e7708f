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
