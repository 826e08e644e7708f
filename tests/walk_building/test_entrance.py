# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Where one comes in when no ground is drawn outside."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from scenes import box, model_of, shell

from walk_building import Building, Door, LoadOptions, Walker, prepare_building


def building_with(*doors: Door) -> Building:
    """Two rooms of 4 x 4 m with an open door between them, and a doorway of 1 m through the south wall of each."""
    floor, ceiling, west, east, _, north = shell(8.2, 4)
    south = [box((x0, -0.2, 0), (x1, 0, 3)) for x0, x1 in ((0, 1.5), (2.5, 5.5), (6.5, 8.2))]
    wall = [box((4.0, 0, 0), (4.2, 1.5, 3)), box((4.0, 2.5, 0), (4.2, 4, 3))]
    model = model_of([floor, ceiling, west, east, north, *south, *wall])
    return prepare_building(dataclasses.replace(model, doors=doors), LoadOptions(), Walker())


def door(x: float, y: float, size: tuple[float, float, float]) -> Door:
    return Door(name="", storey="", centre=np.array([x, y, size[2] / 2]), size=np.array(size))


INNER = door(4.1, 2.0, (0.2, 1.6, 2.1))
WEST, EAST = door(2.0, -0.1, (0.9, 0.2, 2.1)), door(6.0, -0.1, (1.0, 0.2, 2.1))


def test_the_entrance_is_the_widest_door_with_floor_on_one_side_only() -> None:
    building = building_with(INNER, WEST, EAST)
    assert building.surface.places[building.entrance] == pytest.approx([6.0, 0.45, 0], abs=0.3)
    assert building.reachable[building.entrance]


def test_an_inner_door_is_no_entrance() -> None:
    assert building_with(INNER).entrance == -1


def test_a_door_of_another_storey_is_no_entrance() -> None:
    assert building_with(dataclasses.replace(EAST, centre=EAST.centre + [0, 0, 3.0])).entrance == -1
