# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""L-BFGS by SciPy, the source's solver and the reference for the others (`liu1989`, `schmidiger`)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from walk_trajopt.config import TrajoptConfig
from walk_trajopt.problem import Problem
from walk_trajopt.solvers.base import Solution

_RESTARTS = 30

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
    x, value, iterations, evaluations = x0, np.inf, 0, 0
    for _ in range(_RESTARTS):
        # A plain iteration of this method lowers the cost far less than one of the others: the same tolerance would
        # end it early, at a higher cost.
        options = {"maxiter": config.max_iterations - iterations, "ftol": config.tolerance * 0.01, "gtol": 0.0}
        result = minimize(cost, x, jac=True, method="L-BFGS-B", options={"maxfun": 1_000_000, **options})
        gain, x, value = value - float(result.fun), result.x, float(result.fun)
        iterations, evaluations = iterations + int(result.nit), evaluations + int(result.nfev)
        # The line search gives up at a kink of the clearance; without its memory the method goes on.
        failed = result.status == 2
        if not failed or iterations >= config.max_iterations or gain <= config.tolerance * abs(value):
            break
    return x, value, iterations, evaluations
