# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""L-BFGS by SciPy, the source's solver and the reference for the others (`liu1989`, `schmidiger2021`)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from walk_trajopt.config import TrajoptConfig
from walk_trajopt.problem import Problem
from walk_trajopt.solvers.base import Solution

CostAndGradient = Callable[[NDArray[np.float64]], tuple[float, NDArray[np.float64]]]


def lbfgs(problem: Problem, x0: NDArray[np.float64], config: TrajoptConfig) -> Solution:
    """Minimises in the points' own coordinates."""

    def cost(flat: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
        value, gradient = problem.evaluate(flat.reshape(-1, 3))
        return value, gradient.ravel()

    flat, value, iterations, evaluations = run_lbfgs(cost, x0.ravel(), config)
    return Solution(x=flat.reshape(-1, 3), cost=value, iterations=iterations, evaluations=evaluations)


def run_lbfgs(
    cost: CostAndGradient, x0: NDArray[np.float64], config: TrajoptConfig
) -> tuple[NDArray[np.float64], float, int, int]:
    """Minimises a function of a vector.

    Returns:
        Where it ended, the cost there, iterations, evaluations.
    """
    # A plain iteration of this method lowers the cost far less than one of the others: the same tolerance would
    # end it early, at a higher cost.
    options = {"maxiter": config.max_iterations, "maxfun": 10 * config.max_iterations + 10,
               "ftol": config.tolerance * 0.01, "gtol": 0.0}
    result = minimize(cost, x0, jac=True, method="L-BFGS-B", options=options)
    return result.x, float(result.fun), int(result.nit), int(result.nfev)
