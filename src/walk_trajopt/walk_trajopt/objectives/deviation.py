# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""O_d: how far the path is from the planned tour."""

from __future__ import annotations

import numpy as np

from walk_trajopt.objectives.base import Points, QuadraticObjective, Setting, difference_bands


class Deviation(QuadraticObjective):
    """h Σ |x_i − x_i⁰|² ≈ ∫ |x − x⁰|² ds; zero on the planned tour itself [m³]."""

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        self.target = setting.start
        self.bands = difference_bands(len(setting.start), (1.0,), setting.spacing_m)

    def terms(self, x: Points) -> Points:
        """Returns the terms (n,) of the sum."""
        return np.asarray(self.setting.spacing_m * ((x - self.setting.start) ** 2).sum(axis=1))
