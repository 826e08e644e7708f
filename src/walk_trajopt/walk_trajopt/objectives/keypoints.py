# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""How far from its keypoints the path passes. Our own: the source's deviation term alone lets keypoints be cut off."""

from __future__ import annotations

import numpy as np

from walk_trajopt.objectives.base import QuadraticObjective, Setting


class Keypoints(QuadraticObjective):
    """Σ_k |x_{i_k} − p_k|², a sum over keypoints and so not multiplied by the spacing; zero on the keypoints. [m²]"""

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        self.target = np.zeros_like(setting.start)
        self.bands = np.zeros((3, len(setting.start)))
        # Several keypoints may share a point: their sum is that many times the square around their mean, plus a
        # constant, which is left out.
        np.add.at(self.bands[0], setting.keypoint_index, 1.0)
        np.add.at(self.target, setting.keypoint_index, setting.keypoints)
        self.target /= np.maximum(self.bands[0], 1.0)[:, None]
