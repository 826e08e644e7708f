# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The solvers by name. They find the same minimum; `docs/trajectory.md` has what each costs."""

from __future__ import annotations

from walk_trajopt.solvers.base import Solution, Solver
from walk_trajopt.solvers.lbfgs import lbfgs
from walk_trajopt.solvers.lbfgs_whitened import lbfgs_whitened
from walk_trajopt.solvers.levenberg_marquardt import levenberg_marquardt

SOLVERS: dict[str, Solver] = {
    "levenberg_marquardt": levenberg_marquardt,
    "lbfgs": lbfgs,
    "lbfgs_whitened": lbfgs_whitened,
}

__all__ = ["SOLVERS", "Solution", "Solver"]
