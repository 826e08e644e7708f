# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Stage 4: the shortest walk through all keypoints, here the middles of the rooms.

./walk python examples/4_tour.py [BUILDING]
"""

import sys

import numpy as np

from walk_bringup.sample import sample_path
from walk_building import load_building
from walk_sequencer.config import SequencerConfig
from walk_sequencer.pipeline import plan_tour

building = load_building(sys.argv[1] if len(sys.argv) > 1 else sample_path())
eye = [0.0, 0.0, building.walker.eye_height_m]
rooms = [room for room in building.rooms if room.reachable]
keypoints = np.array([room.centre + eye for room in rooms])

for method in ("auto", "mst_dfs"):
    tour = plan_tour(building, keypoints, SequencerConfig(method=method))
    print(f"{tour.method}: {tour.length_m:.1f} m")
    for leg in tour.legs:
        print(f"  {rooms[leg.start].name} to {rooms[leg.goal].name}: {leg.length_m:.1f} m")
    for missed in tour.unreachable:
        print(f"  left out: {rooms[missed.index].name}, {missed.reason}")
