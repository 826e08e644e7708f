# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""L-BFGS in coordinates in which the smooth objectives are round. Our own.

With the Cholesky factor A = L Lᵀ of the problem's constant matrix and y = Lᵀ (x − x0), the quadratic objectives become
|y|² plus a linear term, so only clearance and height are left to be learnt by the method.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky_banded
from scipy.linalg.lapack import dtbtrs

from walk_trajopt.config import TrajoptConfig
from walk_trajopt.problem import Problem
from walk_trajopt.solvers.base import Solution
from walk_trajopt.solvers.lbfgs import run_lbfgs


def lbfgs_whitened(problem: Problem, x0: NDArray[np.float64], config: TrajoptConfig) -> Solution:
    """Minimises in coordinates whitened by the constant banded Hessian."""
    factor = cholesky_banded(_stiffened(problem), lower=True, check_finite=False)

    def points(y: NDArray[np.float64]) -> NDArray[np.float64]:
        return x0 + dtbtrs(factor, y.reshape(-1, 3), uplo="L", trans="T")[0]

    def cost(y: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
        value, gradient = problem.evaluate(points(y))
        return value, dtbtrs(factor, gradient, uplo="L", trans="N")[0].ravel()

    y, value, iterations, evaluations = run_lbfgs(cost, np.zeros(x0.size), config)
    return Solution(x=points(y), cost=value, iterations=iterations, evaluations=evaluations)


def _stiffened(problem: Problem) -> NDArray[np.float64]:
    """Returns the bands of A, made definite, with fixed points cut loose from the others."""
    bands = problem.bands.copy()
    # Without deviation nothing holds the points in place; a part in a million of the rest keeps the factor regular.
    bands[0] += 1e-6 * max(float(bands[0].max()), 1e-6)
    for k in (1, 2):
        n = max(bands.shape[1] - k, 0)
        bands[k, :n][problem.fixed[k:] | problem.fixed[:n]] = 0.0
    return bands
