# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Levenberg–Marquardt on the banded structure of the problem (`levenberg1944`, `marquardt1963`).

A point's coordinates meet only those of its neighbours and of theirs: with the unknowns in the order x₁ y₁ z₁ x₂ … the
Gauss–Newton matrix has six bands beside its diagonal, and a step costs time linear in n.

In the middle between two walls that are nearer than twice the wished clearance the cost has a kink, and a step that
sees one wall overshoots towards the other. Points that are pushed back by such a step are held stiffer than the rest
(our own); a common damping would freeze the whole path for their sake.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from walk_trajopt.config import TrajoptConfig
from walk_trajopt.problem import Local, Problem
from walk_trajopt.solvers.base import Solution

# In units of the median of the constant matrix's diagonal. The first is small, because the model is good.
_FIRST_DAMPING = 1e-3
_LEAST_DAMPING = 1e-8
_MOST_DAMPING = 1e6
_PATIENCE = 4  # iterations without a gain that may be spent on points between two walls
_MOST_STIFF = 1e4  # a point this stiff stays where it is; more would spoil the factorisation


def levenberg_marquardt(problem: Problem, x0: NDArray[np.float64], config: TrajoptConfig) -> Solution:
    """Minimises by damped Gauss–Newton steps."""
    base = _constant_bands(problem)
    scale = max(float(np.median(base[0])), 1e-9)
    x, damping = x0, _FIRST_DAMPING
    here = problem.linearise(x)
    stiff = np.zeros(len(x))
    iterations = idle = 0
    while iterations < config.max_iterations and damping <= _MOST_DAMPING:
        iterations += 1
        trial = x + _step(base, here, damping * scale, stiff)
        there = problem.linearise(trial)
        turned = np.einsum("ij,ij->i", here.push, there.push) < 0.0
        stiff = np.where(turned, np.clip(4.0 * stiff, 1.0, _MOST_STIFF), 0.7 * stiff)
        gain = here.value - there.value
        idle = idle + 1 if gain <= config.tolerance * abs(here.value) else 0
        if gain <= 0.0:
            # If it is only between two walls that the step went too far, it is there that it has to be shorter.
            if idle >= 3 * _PATIENCE:
                break
            damping = damping if turned.any() and stiff.max() < _MOST_STIFF else max(damping * 10.0, 1e-4)
            continue
        x, here = trial, there
        damping = max(damping * 0.2, _LEAST_DAMPING)
        if idle > 0 and (idle >= _PATIENCE or not turned.any()):
            break
    return Solution(x=x, cost=here.value, iterations=iterations, evaluations=iterations + 1)


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


def _step(base: NDArray[np.float64], here: Local, damping: float, stiff: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns −(H + damping I)⁻¹ gradient, (n, 3), each point's block of H stiffened by its factor in `stiff` (n,)."""
    bands = base.copy()
    blocks = here.blocks * (1.0 + stiff)[:, None, None]
    bands[0] += damping
    bands[0] += blocks[:, (0, 1, 2), (0, 1, 2)].ravel()
    bands[1, 0::3] += blocks[:, 1, 0]
    bands[1, 1::3] += blocks[:, 2, 1]
    bands[2, 0::3] += blocks[:, 2, 0]
    solved = solveh_banded(bands, -here.gradient.ravel(), lower=True, overwrite_ab=True, check_finite=False)
    return np.asarray(solved).reshape(-1, 3)
