# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The objectives by name. A new one is a file here, a line in this dict and a weight in the config."""

from __future__ import annotations

from walk_trajopt.objectives.base import Objective, PointwiseObjective, QuadraticObjective, Setting
from walk_trajopt.objectives.clearance import Clearance
from walk_trajopt.objectives.deviation import Deviation
from walk_trajopt.objectives.height import Height
from walk_trajopt.objectives.keypoints import Keypoints
from walk_trajopt.objectives.length import Length
from walk_trajopt.objectives.smoothness import Smoothness

OBJECTIVES: dict[str, type[Objective]] = {
    "deviation": Deviation,
    "length": Length,
    "smoothness": Smoothness,
    "clearance": Clearance,
    "height": Height,
    "keypoints": Keypoints,
}

__all__ = ["OBJECTIVES", "Objective", "PointwiseObjective", "QuadraticObjective", "Setting"]
