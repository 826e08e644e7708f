# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Stage 5: a smooth path that touches nothing, with a clock; then a keypoint is moved, as a hand in a headset would.

./walk python examples/5_trajectory.py [BUILDING]
"""

import sys
import time

import numpy as np

from walk_bringup.sample import sample_path
from walk_building import BodySweep, load_building
from walk_sequencer.config import SequencerConfig
from walk_sequencer.pipeline import plan_tour
from walk_trajopt import Optimiser, TimingConfig, TrajoptConfig, time_path

building = load_building(sys.argv[1] if len(sys.argv) > 1 else sample_path())
eye = [0.0, 0.0, building.walker.eye_height_m]
keypoints = np.array([room.centre + eye for room in building.rooms if room.reachable])
tour = plan_tour(building, keypoints, SequencerConfig())
stands = tour.stands[tour.order]

optimiser = Optimiser(building, tour.polyline, stands, TrajoptConfig(weight_clearance=2.0))
optimiser.solve()
path = optimiser.check()
trajectory = time_path(path, TimingConfig(speed_mps=1.2))
print(f"{path.length_m:.1f} m in {trajectory.duration_s:.0f} s; cost {path.cost}")

# The guarantee, asked of another engine: the walker's body is swept along the path.
free = BodySweep(building.geometry, building.walker).segments_free(path.points)
print(f"{np.count_nonzero(~free)} of {len(free)} segments touch the building")

began = time.perf_counter()
outcome = optimiser.move_keypoint(1, stands[1] + [0.3, 0.2, 0.0])
words = "the path follows" if outcome.accepted else outcome.reason
print(f"keypoint 1 moved in {1e3 * (time.perf_counter() - began):.1f} ms: {words}")
