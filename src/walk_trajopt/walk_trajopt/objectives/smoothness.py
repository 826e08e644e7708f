# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""O_a: how much the path bends and how unevenly it advances."""

from __future__ import annotations

import numpy as np

from walk_trajopt.objectives.base import Points, QuadraticObjective, Setting, difference_bands, difference_terms


class Smoothness(QuadraticObjective):
    """1/h³ Σ |x_{i+1} − 2 x_i + x_{i−1}|² ≈ ∫ |x''|² ds; zero on an evenly divided straight line [1/m]."""

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        self.bands = difference_bands(len(setting.start), (1.0, -2.0, 1.0), 1.0 / setting.spacing_m**3)

    def terms(self, x: Points) -> Points:
        """Returns the terms (n,) of the sum."""
        return np.asarray(difference_terms(x, 2, 1.0 / self.setting.spacing_m**3))
