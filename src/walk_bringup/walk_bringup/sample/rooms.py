# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The rooms of the sample building: numbers, names and outlines, clear of the walls."""

from __future__ import annotations

from walk_bringup.sample import plan
from walk_bringup.sample.plan import Block, Room, Slice, rectangle
from walk_bringup.sample.shapes import Point2


def rooms() -> tuple[Room, ...]:
    """Returns all rooms, storey by storey."""
    return (*_ground_floor(), *_upper_floor())


def _ground_floor() -> tuple[Room, ...]:
    west, south = plan.OUTER_WALL, plan.OUTER_WALL
    return (
        _low("0.01", "Foyer", rectangle(8.0, south, 16.0, 5.0)),
        _low("0.02", "Café", rectangle(west, south, 7.8, 5.0)),
        _low("0.03", "Cloakroom", rectangle(16.2, south, 19.6, 5.0)),
        _low("0.04", "WC", rectangle(19.75, south, plan.EAST, 2.6)),
        _low("0.05", "Accessible WC", rectangle(19.75, 2.75, plan.EAST, 5.0)),
        Room(number="0.06", name="Column hall", storey=0, pieces=_column_hall()),
        _low("0.07", "Workshop", rectangle(west, 5.2, 6.0, 10.0)),
        _low("0.08", "Office", rectangle(18.2, 5.2, plan.EAST, 8.2)),
        Room(number="0.09", name="Stair", storey=0, pieces=(_stair(),)),
        _low(
            "0.10",
            "Ramp foyer",
            (
                (west, 10.2),
                (6.2, 10.2),
                (6.2, plan.HALL_NORTH),
                (plan.RAMP_WEST, plan.HALL_NORTH),
                (plan.RAMP_WEST, plan.NORTH),
                (west, plan.NORTH),
            ),
        ),
        Room(number="0.11", name="Ramp", storey=0, pieces=_ramp()),
        Room(number="0.12", name="Store", storey=0, pieces=(_store(),)),
    )


def _upper_floor() -> tuple[Room, ...]:
    west, south = plan.OUTER_WALL, plan.OUTER_WALL
    gallery = (
        (6.2, 5.2),
        (18.0, 5.2),
        (18.0, plan.HALL_NORTH),
        (plan.VOID_EAST, plan.HALL_NORTH),
        (plan.VOID_EAST, plan.VOID_SOUTH),
        (plan.VOID_WEST, plan.VOID_SOUTH),
        (plan.VOID_WEST, plan.HALL_NORTH),
        (6.2, plan.HALL_NORTH),
    )
    lookout = (
        (west, 10.2),
        (6.2, 10.2),
        (6.2, plan.HALL_NORTH),
        (plan.VOID_WEST, plan.HALL_NORTH),
        (plan.VOID_WEST, plan.LANE),
        (plan.RAMP_WEST, plan.LANE),
        (plan.RAMP_WEST, plan.NORTH),
        (west, plan.NORTH),
    )
    return (
        _high("1.01", "Gallery", gallery),
        _high("1.02", "Library", rectangle(west, south, 7.8, 5.0)),
        _high("1.03", "Exhibition room", rectangle(8.0, south, 16.0, 5.0)),
        _high("1.04", "Reading room", rectangle(16.2, south, plan.EAST, 5.0)),
        _high("1.05", "Meeting room", rectangle(18.2, 5.2, plan.EAST, 8.2)),
        _high("1.06", "Studio", rectangle(west, 5.2, 6.0, 10.0)),
        _high("1.07", "Lookout", lookout),
    )


def _low(number: str, name: str, outline: tuple[Point2, ...]) -> Room:
    return Room(number=number, name=name, storey=0, pieces=(Block(outline=outline, foot=0.0, top=plan.CEILING),))


def _high(number: str, name: str, outline: tuple[Point2, ...]) -> Room:
    return Room(number=number, name=name, storey=1, pieces=(Block(outline=outline, foot=plan.RISE, top=plan.ROOF),))


def _column_hall() -> tuple[Block, ...]:
    """The air under the gallery and, beside it, that of the double height: no vertical line meets both."""
    south, north = 5.2, plan.HALL_NORTH
    under_gallery = (
        (6.2, south),
        (18.0, south),
        (18.0, north),
        (plan.VOID_EAST, north),
        (plan.VOID_EAST, plan.VOID_SOUTH),
        (plan.VOID_WEST, plan.VOID_SOUTH),
        (plan.VOID_WEST, north),
        (6.2, north),
    )
    void = rectangle(plan.VOID_WEST, plan.VOID_SOUTH, plan.VOID_EAST, north)
    return (
        Block(outline=under_gallery, foot=0.0, top=plan.CEILING),
        Block(outline=void, foot=0.0, top=plan.ROOF),
    )


def _stair() -> Slice:
    outline = (
        (plan.STAIR_WEST, 0.0),
        (plan.EAST, 0.0),
        (plan.EAST, plan.ROOF),
        (plan.STAIR_WEST, plan.ROOF),
        (plan.STAIR_WEST, plan.RISE),
        (plan.STAIR_FOOT, plan.RISE),
        (plan.STAIR_FOOT, plan.CEILING),
        (plan.STAIR_WEST, plan.CEILING),
    )
    return Slice(outline=outline, south=plan.STAIR_SOUTH, north=plan.STAIR_NORTH)


def _ramp() -> tuple[Slice, ...]:
    """The air above the two lanes; each piece reaches to the middle of the wall between them."""
    middle = plan.LANE + plan.LANE_WALL / 2
    landing = (plan.EAST, plan.RISE / 2)
    top = ((plan.EAST, plan.ROOF),)
    under_lookout = (
        (plan.VOID_WEST, plan.ROOF),
        (plan.VOID_WEST, plan.CEILING),
        (plan.RAMP_WEST, plan.CEILING),
    )
    lower = (*plan.ramp_lane(upper=False), landing, *top, *under_lookout)
    upper = (*plan.ramp_lane(upper=True), landing, *top, (plan.RAMP_WEST, plan.ROOF))
    return (
        Slice(outline=lower, south=plan.HALL_NORTH, north=middle),
        Slice(outline=upper, south=middle, north=plan.NORTH),
    )


def _store() -> Slice:
    outline = ((4.15, 0.0), (11.0, 0.0), (11.0, 2.3), (4.15, 2.98))
    return Slice(outline=outline, south=plan.LANE + plan.LANE_WALL, north=plan.NORTH)
