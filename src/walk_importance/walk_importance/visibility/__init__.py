# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Who sees whom: three modes behind one interface."""

from walk_importance.visibility.estimate import Scene, VisibilityEstimate
from walk_importance.visibility.exact import exact_visibility
from walk_importance.visibility.progressive import progressive_visibility
from walk_importance.visibility.rays import ray_visibility, voxel_ray_visibility

MODES = {
    "progressive": progressive_visibility,
    "exact": exact_visibility,
    "rays": ray_visibility,
    "voxel_rays": voxel_ray_visibility,
}

__all__ = ["MODES", "Scene", "VisibilityEstimate"]
