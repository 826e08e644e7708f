# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What the user can set about the importance map and the keypoints."""

from __future__ import annotations

import dataclasses

from walk_building.config import Config, param
from walk_importance.grid import DOOR_M


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class ImportanceConfig(Config):
    """How the importance map is computed."""

    voxel_size_m: float = param(
        0.25, "edge of a voxel; above 0.6 m a door would close", unit="m", low=0.05, high=DOOR_M
    )
    max_voxels: int = param(
        1_500_000, "more voxels than this make the grid coarser, and the map says so", low=1000, high=64_000_000
    )
    weight_obstacle: float = param(
        10.0, "weight of being free; large, so that no voxel inside an obstacle wins", low=0.0, high=1e6
    )
    weight_distance: float = param(1.0, "weight of the distance to obstacles", low=0.0, high=1e6)
    weight_visibility: float = param(1.0, "weight of the share of the free space that is seen", low=0.0, high=1e6)
    distance_clip_m: float = param(
        2.0, "distance to obstacles that counts as 1; farther is no better", unit="m", low=0.1, high=20.0
    )
    floor_area_m2: float = param(
        4.0, "level pieces of an unlabelled mesh from this area on are floors or ceilings", unit="m2", low=0.1, high=1e4
    )
    visibility: str = param(
        "progressive",
        "progressive: sampled displacements; exact: every pair of voxels; rays: a ray per pair on the triangles",
        choices=("progressive", "exact", "rays"),
    )
    visibility_error: float = param(
        0.1,
        "progressive stops at this standard error, as a share of the map's own spread; 0.1 is a correlation of 0.995",
        low=0.0,
        high=1.0,
    )
    visibility_sources: str = param(
        "all", "voxels whose view is computed: all, or those within a voxel of a walker's eye", choices=("all", "eye")
    )
    free_space: str = param(
        "all", "what there is to see: all free voxels, or those indoors", choices=("all", "indoors")
    )
    seed: int = param(0, "of the order in which displacements are sampled", low=0, high=2**31 - 1)


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class KeypointConfig(Config):
    """How keypoints are chosen from the importance map."""

    count: int = param(0, "number of keypoints; 0 takes what the building needs", low=0, high=1000)
    cone_radius_m: float = param(
        4.0, "a keypoint lowers the importance around it out to here", unit="m", low=0.1, high=100.0
    )
    cone_depth: float = param(1.0, "by how much it lowers it at its own place", low=0.0, high=1e6)
    room_coverage: float = param(
        0.9, "with count 0, share of a room's floor that its keypoints see together", low=0.0, high=1.0
    )
    view_distance_m: float = param(
        15.0,
        "with count 0, floor farther than this from a keypoint does not count as seen",
        unit="m",
        low=1.0,
        high=200.0,
    )
    snap_radius_m: float = param(
        1.5, "how far a keypoint asked for by the user may be moved to a better place", unit="m", low=0.1, high=20.0
    )
