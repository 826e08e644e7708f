# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Products and solutions with the banded matrices of a path, in compiled code.

The unknowns are in the order x₁ y₁ z₁ x₂ …; a point's coordinates meet those of two neighbours on each side, so there
are six bands beside the diagonal. A symmetric matrix A is kept as bands (7, N) with bands[k, j] = A[j + k, j].
"""

from __future__ import annotations

import numba
import numpy as np

_BAND = 6


@numba.njit(cache=True, nogil=True)
def solve_banded(bands, rhs):
    """Solves A u = rhs (N,) in place, by a Cholesky factorisation that overwrites the bands; linear in N."""
    n = bands.shape[1]
    for j in range(n):
        # A positive definite matrix never gets here below zero but by rounding.
        root = np.sqrt(max(bands[0, j], 1e-300))
        bands[0, j] = root
        reach = min(_BAND, n - 1 - j)
        for k in range(1, reach + 1):
            bands[k, j] /= root
        for k in range(1, reach + 1):
            for m in range(k, reach + 1):
                bands[m - k, j + k] -= bands[m, j] * bands[k, j]
    for j in range(n):
        rhs[j] /= bands[0, j]
        for k in range(1, min(_BAND, n - 1 - j) + 1):
            rhs[j + k] -= bands[k, j] * rhs[j]
    for j in range(n - 1, -1, -1):
        for k in range(1, min(_BAND, n - 1 - j) + 1):
            rhs[j] -= bands[k, j] * rhs[j + k]
        rhs[j] /= bands[0, j]


@numba.njit(cache=True, nogil=True)
def add_product(bands, gradient, damping, step, out):
    """Writes −(g + B δ) to `out` (3 n,) and returns gᵀ δ + ½ δᵀ B δ, for B = A + damping and A of equal coordinates.

    Args:
        bands: (7, 3 n) of an A that couples x with x, y with y, z with z only.
        gradient: (n, 3) g.
        damping: Added to the diagonal.
        step: (n, 3) δ.
        out: (3 n,).
    """
    n = len(gradient)
    value = 0.0
    for i in range(n):
        for k in range(3):
            u = 3 * i + k
            total = gradient[i, k] + (bands[0, u] + damping) * step[i, k]
            for m in (1, 2):
                if i + m < n:
                    total += bands[3 * m, u] * step[i + m, k]
                if i >= m:
                    total += bands[3 * m, u - 3 * m] * step[i - m, k]
            out[u] = -total
            value += 0.5 * step[i, k] * (gradient[i, k] + total)
    return value
