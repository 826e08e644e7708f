# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Stage 2: the importance map, as a picture of each storey at the eye's height.

./walk python examples/2_importance.py [BUILDING [PICTURE]]
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from walk_bringup.sample import sample_path
from walk_building import load_building
from walk_importance.config import ImportanceConfig
from walk_importance.pipeline import refine_importance

building = load_building(sys.argv[1] if len(sys.argv) > 1 else sample_path())

# Each map is better than the one before, and says how far off it may be. A program that is in a hurry takes the first.
for importance_map in refine_importance(building, ImportanceConfig(weight_visibility=2.0)):
    print(f"standard error of the visibility: {importance_map.visibility_stderr:.4f}")

grid = importance_map.grid
figure, axes = plt.subplots(1, len(building.storeys), figsize=(6 * len(building.storeys), 5), squeeze=False)
for axis, storey in zip(axes[0], building.storeys, strict=True):
    level = int((storey.elevation_m + building.walker.eye_height_m - grid.origin[2]) / grid.voxel_size_m)
    importance = np.where(importance_map.obstacle > 0, np.nan, importance_map.importance)[:, :, level]
    axis.imshow(importance.T, origin="lower")
    axis.set_title(storey.name)
picture = Path(sys.argv[2] if len(sys.argv) > 2 else "out/importance.png")
picture.parent.mkdir(parents=True, exist_ok=True)
figure.savefig(picture)
print(f"{picture} is written")
