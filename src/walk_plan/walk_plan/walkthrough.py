# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a plan is made of, from the building to the figures of the report."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_importance.importance_map import ImportanceMap
from walk_importance.keypoints import Suggestion
from walk_plan.options import PlanConfig
from walk_plan.profile import Profile
from walk_plan.quality import PathQuality
from walk_plan.rooms import RoomVisit
from walk_sequencer.tour import Tour
from walk_trajopt.path import OptimisedPath
from walk_trajopt.trajectory import Trajectory


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Walkthrough:
    """A planned walk with everything it was made from."""

    config: PlanConfig
    building: Building
    importance_map: ImportanceMap
    suggestion: Suggestion
    tour: Tour
    path: OptimisedPath
    trajectory: Trajectory
    profile: Profile
    qualities: tuple[PathQuality, ...]  # ours first, then what it is compared with
    visits: tuple[RoomVisit, ...]  # one per room of the building
    warnings: tuple[str, ...]  # sentences for the user
    stage_s: dict[str, float]  # wall time of the stages that are done [s]

    @property
    def quality(self) -> PathQuality:
        """The figures of the walk itself."""
        return self.qualities[0]

    @property
    def keypoints(self) -> NDArray[np.float64]:
        """(M, 3): where the eye is at each keypoint, in the order of the tour [m]."""
        return self.tour.stands[self.tour.order]
