# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The plan of the sample building, a small house of culture, as data: levels, rooms, walls, doors, windows.

The plan is 24 m by 16 m, x to the east and y to the north, the entrance in the south. A column hall of double
height lies in the middle, a gallery runs around it on three sides, and a ramp of two lanes climbs along its north
side. All lengths are in metres.
"""

from __future__ import annotations

import dataclasses

from walk_bringup.sample.shapes import Point2

LENGTH, DEPTH = 24.0, 16.0
OUTER_WALL = 0.35
SLAB = 0.25
RISE = 3.2  # from floor to floor: 20 risers of 0.16, and 32 m of ramp at 1:10
CEILING = RISE - SLAB
ROOF = 2 * RISE - SLAB  # underside of the roof
PARAPET = ROOF + 0.8
PLAZA = -0.02  # the pavement outside lies a drop below the floor, so that nothing but the planner keeps a walker in

EAST, NORTH = LENGTH - OUTER_WALL, DEPTH - OUTER_WALL
HALL_NORTH = 11.95  # the column hall ends where the ramp begins
LANE = 13.65  # north edge of the ramp's lower lane
LANE_WALL = 0.2  # between the lanes
RAMP_WEST, RAMP_EAST = 4.0, 21.6
REST = 1.6  # length of the level rest in the middle of each lane
VOID_WEST, VOID_EAST, VOID_SOUTH = 8.2, 16.0, 7.2
STAIR_WEST, STAIR_SOUTH, STAIR_NORTH, STAIR_FOOT = 18.2, 8.4, 11.75, 19.7
COLUMNS = tuple((x, y) for y in (7.0, 9.3, 11.6) for x in (8.0, 10.7, 13.5, 16.2))

HALL_VOID: tuple[Point2, ...] = (
    (VOID_WEST, VOID_SOUTH),
    (VOID_EAST, VOID_SOUTH),
    (VOID_EAST, HALL_NORTH),
    (EAST, HALL_NORTH),
    (EAST, NORTH),
    (RAMP_WEST, NORTH),
    (RAMP_WEST, LANE),
    (VOID_WEST, LANE),
)
STAIR_VOID: tuple[Point2, ...] = (
    (STAIR_FOOT, STAIR_SOUTH),
    (EAST, STAIR_SOUTH),
    (EAST, STAIR_NORTH),
    (STAIR_FOOT, STAIR_NORTH),
)


def ramp_lane(upper: bool) -> tuple[Point2, ...]:
    """Returns the (x, z) line of a lane's floor from west to east: a run, a rest, a run."""
    run = (RAMP_EAST - RAMP_WEST - REST) / 2
    xs = (RAMP_WEST, RAMP_WEST + run, RAMP_WEST + run + REST, RAMP_EAST)
    quarter = RISE / 4
    zs = (4, 3, 3, 2) if upper else (0, 1, 1, 2)
    return tuple((x, quarter * z) for x, z in zip(xs, zs, strict=True))


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Opening:
    """A hole in a wall: a door, a window or a plain passage."""

    kind: str  # "door", "window" or "passage"
    at: float  # of its middle, the coordinate along the wall
    width: float
    height: float
    sill: float = 0.0  # above the wall's foot
    glazed: bool = False  # a door with glass in its leaves


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Wall:
    """A straight wall along an axis; its length is the longer side of the rectangle."""

    name: str
    storey: int
    low: Point2
    high: Point2
    foot: float
    top: float
    outer: bool = False
    openings: tuple[Opening, ...] = ()


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Block:
    """A solid piece of a room: a polygon of the plan between two heights."""

    outline: tuple[Point2, ...]
    foot: float
    top: float


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Slice:
    """A piece of a room whose floor or ceiling slopes: a polygon of (x, z) between two y."""

    outline: tuple[Point2, ...]
    south: float
    north: float


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Room:
    """A room: its number, its name and the air in it."""

    number: str
    name: str
    storey: int
    pieces: tuple[Block | Slice, ...]


def door(at: float, width: float = 1.0, height: float = 2.1, *, glazed: bool = False) -> Opening:
    """Returns a door whose middle is at a coordinate along its wall."""
    return Opening(kind="door", at=at, width=width, height=height, glazed=glazed)


def window(at: float, width: float, sill: float, height: float) -> Opening:
    """Returns a window whose middle is at a coordinate along its wall."""
    return Opening(kind="window", at=at, width=width, height=height, sill=sill)


def passage(at: float, width: float, height: float = 2.4) -> Opening:
    """Returns an opening without a door."""
    return Opening(kind="passage", at=at, width=width, height=height)


def rectangle(x0: float, y0: float, x1: float, y1: float) -> tuple[Point2, ...]:
    """Returns the corners of a rectangle, counter-clockwise."""
    return ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
