# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Levenberg–Marquardt on the banded structure of the problem (`levenberg1944`, `marquardt1963`), aware of kinks.

In the middle between two walls that are nearer than twice the wished clearance the cost has a kink, and a step that
sees one wall overshoots towards the other. The model of a step therefore keeps the largest of several functions as
what it is (`newton.py`); the geometry is asked once for each step, and the step costs time linear in n.
"""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from walk_trajopt.config import TrajoptConfig
from walk_trajopt.problem import Problem
from walk_trajopt.solvers.base import Solution
from walk_trajopt.solvers.newton import Model, newton_step

# In units of the median of the constant matrix's diagonal. The first holds steps to decimetres: as far as a model of
# the nearest walls is worth anything.
_FIRST_DAMPING = 0.01
_LEAST_DAMPING = 1e-8
_MOST_DAMPING = 1e4
_SMALL_ENDS = 8  # iterations in a row that lower the cost by less than the tolerance, steps taken back included


def levenberg_marquardt(problem: Problem, x0: NDArray[np.float64], config: TrajoptConfig) -> Solution:
    """Minimises by damped steps to the minimum of the model."""
    base = _constant_bands(problem.bands, problem.fixed)
    scale = max(float(np.median(base[0])), 1e-9)
    x, damping = x0, _FIRST_DAMPING
    here = problem.linearise(x)
    iterations = small = 0
    while iterations < config.max_iterations and damping <= _MOST_DAMPING:
        iterations += 1
        model = Model(
            base=base,
            gradient=here.gradient,
            values=here.values,
            slopes=here.slopes,
            bends=here.bends,
            first=problem.first,
            scale=problem.scale,
            damping=damping * scale,
            fixed=problem.fixed,
        )
        step, promised = newton_step(model)
        enough = config.tolerance * abs(here.value)
        # Where the model itself sees nothing left to gain, no other damping finds anything either.
        if promised <= enough:
            break
        there = problem.linearise(x + step)
        gain = here.value - there.value
        damping *= _response(gain, promised)
        damping = max(damping, _LEAST_DAMPING)
        if gain > 0.0:
            x, here = x + step, there
        small = small + 1 if gain <= enough else 0
        if small >= _SMALL_ENDS:
            break
    return Solution(x=x, cost=here.value, iterations=iterations, evaluations=iterations + 1, local=here)


def _response(gain: float, promised: float) -> float:
    """Returns the factor by which the damping changes after a step that kept so much of what the model promised."""
    if gain <= 0.0:
        return 10.0
    kept = gain / max(promised, 1e-12)
    return 0.1 if kept > 0.75 else 1.0 if kept > 0.25 else 4.0


@numba.njit(cache=True, nogil=True)
def _constant_bands(own, fixed):
    """Returns the lower bands (7, 3 n) of the quadratic objectives' Hessian, fixed points cut loose with a 1.

    Args:
        own: (3, n) lower bands of half of it, per coordinate.
        fixed: (n,).
    """
    n = len(fixed)
    bands = np.zeros((7, 3 * n))
    for k in range(3):
        for i in range(n - k):
            loose = fixed[i] or fixed[i + k]
            for c in range(3):
                bands[3 * k, 3 * i + c] = 0.0 if loose else 2.0 * own[k, i]
    for i in range(n):
        if fixed[i]:
            bands[0, 3 * i : 3 * i + 3] = 1.0
    return bands
