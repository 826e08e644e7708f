# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Keypoints that the user brings in place of those that the importance map suggests."""

from __future__ import annotations

from walk_bag.keypoint_files import ImportedKeypoints
from walk_building.building import Building
from walk_importance import given as importance
from walk_importance.importance_map import ImportanceMap
from walk_importance.keypoints import Suggestion
from walk_sequencer.misplaced import misplaced
from walk_sequencer.tour import Tour


def given_suggestion(building: Building, importance_map: ImportanceMap, given: ImportedKeypoints) -> Suggestion:
    """Returns the keypoints of a file as if they had been suggested, in the file's order."""
    eyes = given.eyes_in(building)
    return importance.given_suggestion(building, importance_map, eyes, given.quat_xyzw, given.looks, given.source)


def left_out(building: Building, given: ImportedKeypoints, tour: Tour) -> tuple[str, ...]:
    """Returns a sentence for each of the user's keypoints that the tour leaves out, or passes elsewhere."""
    found = misplaced(building, given.eyes_in(building), tour)
    return tuple(f"{given.name_of(index)} {what}." for index, what in found.items())
