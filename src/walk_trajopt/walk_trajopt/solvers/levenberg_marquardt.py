# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Levenberg–Marquardt on the banded structure of the problem (`levenberg1944`, `marquardt1963`).

A point's coordinates meet only those of its neighbours and of theirs: with the unknowns in the order x₁ y₁ z₁ x₂ … the
Gauss–Newton matrix has six bands beside its diagonal, and a step costs time linear in n.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from walk_trajopt.config import TrajoptConfig
from walk_trajopt.problem import Problem
from walk_trajopt.solvers.base import Solution

_FIRST_DAMPING = 1e-3  # of the largest diagonal element of the constant matrix per unit; small: the model is good
_DAMPING_RANGE = (1e-9, 1e9)


def levenberg_marquardt(problem: Problem, x0: NDArray[np.float64], config: TrajoptConfig) -> Solution:
    """Minimises by damped Gauss–Newton steps."""
    base = _constant_bands(problem)
    scale = max(float(np.median(base[0])), 1e-9)
    x, damping = x0, _FIRST_DAMPING
    here = problem.linearise(x)
    evaluations = 1
    for iteration in range(config.max_iterations):
        step = _step(base, here.blocks, here.gradient, damping * scale)
        trial = problem.linearise(x + step)
        evaluations += 1
        gain = here.value - trial.value
        if gain <= 0.0:
            damping = max(damping * 10.0, 1e-4)
            if damping > _DAMPING_RANGE[1]:
                break
            continue
        x, here = x + step, trial
        damping = max(damping * 0.2, _DAMPING_RANGE[0])
        if gain <= config.tolerance * abs(here.value):
            break
    else:
        iteration = config.max_iterations - 1
    return Solution(x=x, cost=here.value, iterations=iteration + 1, evaluations=evaluations)


def _constant_bands(problem: Problem) -> NDArray[np.float64]:
    """Returns the lower bands (7, 3 n) of the quadratic objectives' Hessian, fixed points cut loose with a 1."""
    n = len(problem.fixed)
    bands = np.zeros((7, 3 * n))
    for k in range(3):
        row = 2.0 * problem.bands[k]
        m = max(n - k, 0)
        row[:m][problem.fixed[k:] | problem.fixed[:m]] = 0.0
        bands[3 * k] = np.repeat(row, 3)
    bands[0, np.repeat(problem.fixed, 3)] = 1.0
    return bands


def _step(
    base: NDArray[np.float64], blocks: NDArray[np.float64], gradient: NDArray[np.float64], damping: float
) -> NDArray[np.float64]:
    """Returns −(H + damping I)⁻¹ gradient, (n, 3)."""
    bands = base.copy()
    bands[0] += damping
    bands[0] += blocks[:, (0, 1, 2), (0, 1, 2)].ravel()
    bands[1, 0::3] += blocks[:, 1, 0]
    bands[1, 1::3] += blocks[:, 2, 1]
    bands[2, 0::3] += blocks[:, 2, 0]
    solved = solveh_banded(bands, -gradient.ravel(), lower=True, overwrite_ab=True, check_finite=False)
    return np.asarray(solved).reshape(-1, 3)
