# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What can go wrong with an importance map and its keypoints."""

from __future__ import annotations

import numpy as np

from walk_building.errors import WalkError


class NoFreeVoxelError(WalkError):
    """Every voxel of the grid meets geometry.

    Attributes:
        voxel_size_m: The voxels' edge.
    """

    def __init__(self, voxel_size_m: float) -> None:
        self.voxel_size_m = voxel_size_m
        super().__init__(
            f"no voxel of {voxel_size_m:g} m is free of geometry; use a smaller voxel_size_m or check the units"
        )


class NoPlaceError(WalkError):
    """There is no place a walker could reach, so no keypoint."""

    def __init__(self) -> None:
        super().__init__(
            "no place in the building can be reached by the walker, so there is no keypoint; "
            "try a smaller walker, another start or outdoors"
        )


class NoPlaceNearError(WalkError):
    """A keypoint was asked for where there is no place to take.

    Attributes:
        radius_m: How far around it was looked.
        nearest_m: How far off the next place on the same storey is, inf where there is none.
        on_storey: Whether the height is one of a storey.
    """

    def __init__(self, radius_m: float, nearest_m: float, *, on_storey: bool = True) -> None:
        self.radius_m = radius_m
        self.nearest_m = nearest_m
        self.on_storey = on_storey
        there = f"the next one is {nearest_m:.1f} m away" if np.isfinite(nearest_m) else "nor anywhere on that storey"
        sentence = f"no free place for a keypoint within {radius_m:g} m, {there}; point elsewhere or raise "
        sentence += "keypoints.snap_radius_m"
        if not on_storey:
            sentence = "the point is over no floor, and there is no storey at its height; point at a place over a floor"
        super().__init__(sentence)


class MapNotReadyError(WalkError):
    """A keypoint was asked for before there is a map to say which place is good."""

    def __init__(self) -> None:
        super().__init__("the importance map is not ready yet, so no good place can be found; ask again in a moment")


class TooManyKeypointsError(WalkError):
    """More keypoints were asked for than there is room for.

    Attributes:
        count: How many were asked for.
        fitting: How many fit.
    """

    def __init__(self, count: int, fitting: int) -> None:
        self.count = count
        self.fitting = fitting
        super().__init__(
            f"{count} keypoints were asked for, but only {fitting} fit a body's width apart; ask for at most {fitting}"
        )
