# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Which keypoints fit a building, and why the others do not."""

from __future__ import annotations

import dataclasses

import numpy as np

from walk_building.building import Building
from walk_sequencer.config import SequencerConfig
from walk_sequencer.editing import EditingConfig
from walk_sequencer.keypoints import Keypoints
from walk_sequencer.pipeline import plan_tour


def misfits(
    building: Building, keypoints: Keypoints, sequencer: SequencerConfig, editing: EditingConfig
) -> dict[int, str]:
    """Returns by identity why a keypoint cannot be in the tour: no floor, not reached on foot, no room for the body.

    The start is left free: one that has lost its floor would take the whole tour with it.
    """
    free = dataclasses.replace(sequencer, method="given", start=-1, end=-1, before="", together="", begin="anywhere")
    tour = plan_tour(building, keypoints.positions, free)
    reasons = {keypoints.ids[left.index]: left.reason for left in tour.unreachable}
    pulled_m = np.linalg.norm(tour.stands[:, :2] - keypoints.positions[:, :2], axis=1)
    for identity, pulled in zip(keypoints.ids, pulled_m, strict=True):
        if identity not in reasons and pulled > editing.pull_m:
            reasons[identity] = f"no room for the walker's body, as in a wall: the nearest is {pulled:.2f} m away"
    return {identity: reasons[identity] for identity in keypoints.ids if identity in reasons}
