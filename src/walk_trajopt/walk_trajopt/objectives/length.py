# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""O_v: how long the path is."""

from __future__ import annotations

import numpy as np

from walk_trajopt.objectives.base import Points, QuadraticObjective, Setting, difference_bands, difference_terms


class Length(QuadraticObjective):
    """1/h Σ |x_{i+1} − x_i|² ≈ ∫ |x'|² ds; zero where all points are one [m]."""

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        self.bands = difference_bands(len(setting.start), (-1.0, 1.0), 1.0 / setting.spacing_m)

    def terms(self, x: Points) -> Points:
        """Returns the terms (n,) of the sum."""
        return np.asarray(difference_terms(x, 1, 1.0 / self.setting.spacing_m))
