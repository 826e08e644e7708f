# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a solver takes and returns."""

from __future__ import annotations

import dataclasses
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from walk_trajopt.config import TrajoptConfig
from walk_trajopt.problem import Local, Problem


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Solution:
    """Where a solver came to rest."""

    x: NDArray[np.float64]  # (n, 3) [m]
    cost: float
    iterations: int
    evaluations: int  # of the cost
    local: Local | None = None  # the problem around x, of solvers that know it


class Solver(Protocol):
    """Minimises a problem from `x0` (n, 3), within the iterations and the tolerance of the config."""

    def __call__(self, problem: Problem, x0: NDArray[np.float64], config: TrajoptConfig) -> Solution:
        """Returns where it came to rest, the fixed points where they were."""
        ...
