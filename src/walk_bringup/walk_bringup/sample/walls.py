# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The walls of the sample building with their doors and windows."""

from __future__ import annotations

from walk_bringup.sample import plan
from walk_bringup.sample.plan import Opening, Wall, door, passage, window
from walk_bringup.sample.shapes import Point2

W = plan.OUTER_WALL
E, N = plan.EAST, plan.NORTH


def walls() -> tuple[Wall, ...]:
    """Returns all straight walls, storey by storey."""
    return (*_outer_ground(), *_inner_ground(), *_outer_upper(), *_inner_upper())


def _outer(name: str, storey: int, low: Point2, high: Point2, *openings: Opening) -> Wall:
    foot, top = (0.0, plan.RISE) if storey == 0 else (plan.RISE, plan.PARAPET)
    return Wall(name=name, storey=storey, low=low, high=high, foot=foot, top=top, outer=True, openings=tuple(openings))


def _inner(name: str, storey: int, low: Point2, high: Point2, *openings: Opening) -> Wall:
    foot, top = (0.0, plan.CEILING) if storey == 0 else (plan.RISE, plan.ROOF)
    return Wall(name=name, storey=storey, low=low, high=high, foot=foot, top=top, openings=tuple(openings))


def _outer_ground() -> tuple[Wall, ...]:
    south = (
        window(1.9, 2.0, 0.4, 2.1),
        door(4.05, 1.1, 2.3, glazed=True),
        window(6.2, 2.0, 0.4, 2.1),
        window(9.3, 1.8, 0.1, 2.5),
        door(12.1, 2.0, 2.4, glazed=True),
        window(14.7, 1.8, 0.1, 2.5),
        window(17.9, 1.4, 0.9, 1.5),
        window(21.7, 0.9, 1.6, 0.8),
    )
    west = (
        window(2.7, 2.2, 0.4, 2.1),
        window(6.5, 1.6, 0.9, 1.6),
        window(8.8, 1.6, 0.9, 1.6),
        window(13.0, 2.6, 0.4, 2.1),
    )
    east = (
        window(1.5, 0.9, 1.6, 0.8),
        window(3.9, 0.9, 1.6, 0.8),
        window(6.7, 1.8, 0.9, 1.6),
    )
    return (
        _outer("South wall, ground floor", 0, (0.0, 0.0), (plan.LENGTH, W), *south),
        _outer("North wall, ground floor", 0, (0.0, N), (plan.LENGTH, plan.DEPTH), window(2.2, 2.2, 0.4, 2.1)),
        _outer("West wall, ground floor", 0, (0.0, W), (W, N), *west),
        _outer("East wall, ground floor", 0, (E, W), (plan.LENGTH, N), *east),
    )


def _inner_ground() -> tuple[Wall, ...]:
    lane_wall = plan.LANE + plan.LANE_WALL
    return (
        _inner("Wall foyer–hall", 0, (W, 5.0), (E, 5.2), passage(12.1, 2.4)),
        _inner("Wall café–foyer", 0, (7.8, W), (8.0, 5.0), door(2.0, 1.2, glazed=True)),
        _inner("Wall foyer–cloakroom", 0, (16.0, W), (16.2, 5.0), door(1.6, 1.1)),
        _inner("Wall cloakroom–WC", 0, (19.6, W), (19.75, 5.0), door(1.5, 0.95), door(3.9, 1.05)),
        _inner("Wall WC–accessible WC", 0, (19.75, 2.6), (E, 2.75)),
        _inner("Wall workshop–hall", 0, (6.0, 5.2), (6.2, 10.2), door(7.9, 1.2)),
        _inner("Wall workshop–ramp foyer", 0, (W, 10.0), (6.0, 10.2), door(1.6, 1.0)),
        _inner("Wall hall–office–stair", 0, (18.0, 5.2), (18.2, plan.HALL_NORTH), door(7.2), door(9.15, 1.2)),
        _inner("Wall office–stair", 0, (18.2, 8.2), (E, 8.4)),
        _inner("Wall stair–ramp", 0, (18.2, plan.STAIR_NORTH), (E, plan.HALL_NORTH)),
        _inner("Wall store–ramp foyer", 0, (plan.RAMP_WEST, lane_wall), (4.15, N), door(14.7, 0.95)),
        # Closes off where the stair's upper flight leaves too little head-room below it.
        Wall(name="Wall under the stair", storey=0, low=(20.9, 9.95), high=(21.0, 11.75), foot=0.0, top=2.09),
        Wall(name="Wall behind the store", storey=0, low=(11.0, lane_wall), high=(11.15, N), foot=0.0, top=2.3),
    )


def _outer_upper() -> tuple[Wall, ...]:
    south = (
        window(1.9, 2.0, 0.7, 1.7),
        window(6.2, 2.0, 0.7, 1.7),
        window(9.3, 1.8, 0.7, 1.7),
        window(12.1, 2.6, 0.2, 2.2),
        window(14.7, 1.8, 0.7, 1.7),
        window(17.9, 1.4, 0.7, 1.7),
        window(19.8, 1.4, 0.7, 1.7),
        window(21.7, 1.4, 0.7, 1.7),
    )
    north = tuple(window(x, 1.8, 0.8, 1.8) for x in (2.2, 5.5, 8.8, 12.1, 15.4, 18.7, 22.0))
    west = (
        window(2.7, 2.2, 0.7, 1.7),
        window(6.5, 1.6, 0.7, 1.7),
        window(8.8, 1.6, 0.7, 1.7),
        window(13.0, 3.2, 0.3, 2.1),
    )
    east = (
        window(2.7, 2.2, 0.7, 1.7),
        window(6.7, 1.8, 0.7, 1.7),
        window(10.1, 1.4, 0.3, 2.1),
        window(13.8, 2.2, 0.3, 2.1),
    )
    return (
        _outer("South wall, upper floor", 1, (0.0, 0.0), (plan.LENGTH, W), *south),
        _outer("North wall, upper floor", 1, (0.0, N), (plan.LENGTH, plan.DEPTH), *north),
        _outer("West wall, upper floor", 1, (0.0, W), (W, N), *west),
        _outer("East wall, upper floor", 1, (E, W), (plan.LENGTH, N), *east),
    )


def _inner_upper() -> tuple[Wall, ...]:
    return (
        _inner("Wall south rooms–gallery", 1, (W, 5.0), (E, 5.2), door(7.0, 1.1), door(12.1, 2.0), door(17.1, 1.1)),
        _inner("Wall library–exhibition", 1, (7.8, W), (8.0, 5.0), door(1.5, 1.1)),
        _inner("Wall exhibition–reading room", 1, (16.0, W), (16.2, 5.0), door(1.5, 1.1)),
        _inner("Wall studio–gallery", 1, (6.0, 5.2), (6.2, 10.2), door(8.6, 1.0)),
        _inner("Wall studio–lookout", 1, (W, 10.0), (6.0, 10.2), door(4.6, 1.0)),
        _inner("Wall gallery–meeting–stair", 1, (18.0, 5.2), (18.2, plan.HALL_NORTH), door(7.2), passage(10.97, 1.2)),
        _inner("Wall meeting–stair", 1, (18.2, 8.2), (E, 8.4)),
        _inner("Wall stair–ramp, upper floor", 1, (18.2, plan.STAIR_NORTH), (E, plan.HALL_NORTH)),
    )
