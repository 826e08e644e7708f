# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Stage 3: keypoints, the places worth stopping at, from the importance map.

./walk python examples/3_keypoints.py [BUILDING]
"""

import sys

from walk_bringup.sample import sample_path
from walk_building import load_building
from walk_importance.config import ImportanceConfig, KeypointConfig
from walk_importance.keypoints import suggest_keypoints
from walk_importance.pipeline import compute_importance

building = load_building(sys.argv[1] if len(sys.argv) > 1 else sample_path())
importance_map = compute_importance(building, ImportanceConfig())

# A wide and deep cone keeps the keypoints apart; every reachable room gets one first.
suggestion = suggest_keypoints(building, importance_map, KeypointConfig(cone_radius_m=4.0))
for position, room, score in zip(suggestion.positions, suggestion.room, suggestion.score, strict=True):
    name = building.rooms[room].name if room >= 0 else "between rooms"
    print(f"{position.round(2)}  importance {score:.2f}  {name}")
for skipped in suggestion.skipped:
    print(f"no keypoint in {building.rooms[skipped.room].name}: {skipped.reason}")
