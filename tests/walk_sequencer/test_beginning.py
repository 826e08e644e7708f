# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Where a tour begins when nobody says so."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from scenes import box, building_of, ramp, shell

from walk_sequencer.config import SequencerConfig
from walk_sequencer.pipeline import plan_tour

EYE = 1.6


def hall_with_a_way_in() -> list[trimesh.Trimesh]:
    """A hall along x with ground outside its west wall, which has a door of 1 m in the middle."""
    floor, ceiling, _, east, south, north = shell(12, 4)
    west = [box((-0.2, 0, 0), (0, 1.5, 3)), box((-0.2, 2.5, 0), (0, 4, 3))]
    return [floor, ceiling, east, south, north, *west, box((-4, 0, -0.2), (-0.2, 4, 0))]


POINTS = np.array([(6.0, 2, EYE), (1.5, 2, EYE), (11, 1, EYE), (9, 3, EYE)])


def test_the_entrance_is_the_way_in_from_the_ground_outside() -> None:
    building = building_of(hall_with_a_way_in())
    assert building.surface.places[building.entrance] == pytest.approx([-0.1, 2.0, 0.0], abs=0.3)


def test_a_tour_begins_at_the_keypoint_nearest_to_the_entrance() -> None:
    building = building_of(hall_with_a_way_in())
    assert plan_tour(building, POINTS).order[0] == 1


def test_a_wished_start_or_order_goes_before_the_entrance() -> None:
    building = building_of(hall_with_a_way_in())
    assert plan_tour(building, POINTS, SequencerConfig(start=2)).order[0] == 2
    assert plan_tour(building, POINTS, SequencerConfig(method="given")).order.tolist() == [0, 1, 2, 3]
    assert plan_tour(building, POINTS, SequencerConfig(end=1)).order[-1] == 1


def test_a_building_without_a_way_in_leaves_the_start_free() -> None:
    building = building_of(shell(12, 4))
    assert building.entrance == -1
    assert sorted(plan_tour(building, POINTS).order.tolist()) == [0, 1, 2, 3]


def test_without_a_way_in_a_tour_goes_upwards() -> None:
    building = building_of(ramp(slope=0.125))
    low, high = (2.5, 1.0, EYE + 0.06), (9.5, 1.0, EYE + 0.94)
    for points in (np.array([low, high]), np.array([high, low])):
        order = plan_tour(building, points).order
        assert points[order[0], 2] < points[order[-1], 2]
