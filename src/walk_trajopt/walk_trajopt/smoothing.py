# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Averages along a path or over time, in time linear in the number of values."""

from __future__ import annotations

import numba
import numpy as np

_PASSES = 4  # boxes one after the other; what is left of their corners is below a hundredth of the peak


@numba.njit(cache=True, nogil=True)
def gaussian(values, sigma):
    """Returns `values` (n,) averaged with a Gaussian of standard deviation `sigma` [cells].

    By averages over boxes with fractional rims, whose variances add up to the Gaussian's (`gwosdek2011`). Beyond its
    ends the sequence goes on with its first and its last value.
    """
    spread = sigma * sigma / _PASSES
    half = int(np.floor(0.5 * (np.sqrt(1.0 + 12.0 * spread) - 1.0)))
    rim = (2 * half + 1) * (3.0 * spread - half * (half + 1)) / (6.0 * ((half + 1) ** 2 - spread))
    for _ in range(_PASSES):
        values = box(values, half, rim)
    return values


@numba.njit(cache=True, nogil=True)
def box(values, half, rim):
    """Returns the mean (n,) over `half` neighbours on both sides, the next ones beyond counting `rim` as much."""
    last = len(values) - 1
    out = np.empty(len(values))
    total = values[0] * (half + 1)
    for k in range(1, half + 1):
        total += values[min(k, last)]
    for i in range(len(values)):
        above, below = values[min(i + half + 1, last)], values[max(i - half - 1, 0)]
        out[i] = (total + rim * (above + below)) / (2 * half + 1 + 2.0 * rim)
        total += above - values[max(i - half, 0)]
    return out
