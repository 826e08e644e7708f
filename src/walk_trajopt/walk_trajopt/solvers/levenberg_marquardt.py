# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Levenberg–Marquardt on the banded structure of the problem (`levenberg1944`, `marquardt1963`), aware of kinks.

In the middle between two walls that are nearer than twice the wished clearance the cost has a kink, and a step that
sees one wall overshoots towards the other. The model of a step therefore keeps the largest of several functions as
what it is (`newton.py`); the geometry is asked once for each step, and the step costs time linear in n.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from walk_trajopt.config import TrajoptConfig
from walk_trajopt.problem import Problem
from walk_trajopt.solvers.base import Solution
from walk_trajopt.solvers.newton import Model, newton_step

# In units of the problem's stiffness. The first holds steps to decimetres: as far as a model of the nearest walls is
# worth anything.
_FIRST_DAMPING = 0.01
_LEAST_DAMPING = 1e-8
_MOST_DAMPING = 1e4
_SMALL_ENDS = 8  # iterations in a row that lower the cost by less than the tolerance, steps taken back included


def levenberg_marquardt(problem: Problem, x0: NDArray[np.float64], config: TrajoptConfig) -> Solution:
    """Minimises by damped steps to the minimum of the model."""
    x, damping = x0, _FIRST_DAMPING
    here = problem.linearise(x)
    iterations = small = 0
    while iterations < config.max_iterations and damping <= _MOST_DAMPING:
        iterations += 1
        model = Model(
            base=problem.hessian,
            gradient=here.gradient,
            values=here.values,
            slopes=here.slopes,
            bends=here.bends,
            first=problem.first,
            scale=problem.scale,
            damping=damping * problem.stiffness,
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
            x, here = there.x, there
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
