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
def _of_three(values, rim):
    """Returns what `box` does for no whole neighbour: without a running sum, which would have to wait for itself."""
    last, scale = len(values) - 1, 1.0 / (1.0 + 2.0 * rim)
    out = np.empty(len(values))
    out[0] = (values[0] + rim * (values[0] + values[min(1, last)])) * scale
    for i in range(1, last):
        out[i] = (values[i] + rim * (values[i - 1] + values[i + 1])) * scale
    out[last] = (values[last] + rim * (values[max(last - 1, 0)] + values[last])) * scale
    return out


@numba.njit(cache=True, nogil=True)
def box(values, half, rim):
    """Returns the mean (n,) over `half` neighbours on both sides, the next ones beyond counting `rim` as much."""
    width, n = 2 * half + 1, len(values)
    if half == 0:
        return _of_three(values, rim)
    # With the ends drawn out there is nothing to ask at each value; the rims are at `i` and at `i + width + 1`.
    padded, out = np.empty(n + width + 1), np.empty(n)
    padded[: half + 1], padded[half + 1 : half + 1 + n], padded[half + 1 + n :] = values[0], values, values[-1]
    total, scale = padded[1 : width + 1].sum(), 1.0 / (width + 2.0 * rim)
    for i in range(n):
        above = padded[i + width + 1]
        out[i] = (total + rim * (padded[i] + above)) * scale
        total += above - padded[i + 1]
    return out
