# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The stair, the ramp and the railings of the sample building."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

from walk_bringup.sample import plan
from walk_bringup.sample.ifc_file import IfcFile, Item
from walk_bringup.sample.shapes import Entity, Point2, Point3, Shapes

TREAD = 0.28
RISERS = 10  # in each of the two flights
STAIR_LANE = 1.55
WAIST = 0.18
RAMP_SLAB = 0.2
RAIL_HEIGHT = 1.0
RAIL = 0.05
POST_SPACING = 1.6
EASTWARD: Point2 = (1.0, 0.0)


def railing(shapes: Shapes, line: Sequence[Point3]) -> list[Item]:
    """Returns a glass railing along a line on the floor: posts, panels and a handrail.

    Each stretch of the line may turn and climb; heights are measured upwards from the line.
    """
    items: list[Item] = []
    for start, end in itertools.pairwise(line):
        run = math.dist(start[:2], end[:2])
        along = ((end[0] - start[0]) / run, (end[1] - start[1]) / run)
        climb = (end[2] - start[2]) / run

        def band(
            s0: float, s1: float, low: float, high: float, foot: float = start[2], slope: float = climb
        ) -> list[Point2]:
            z0, z1 = foot + slope * s0, foot + slope * s1
            return [(s0, z0 + low), (s1, z1 + low), (s1, z1 + high), (s0, z0 + high)]

        origin = (start[0], start[1])
        items.append(("oak", shapes.upright(band(0.0, run, RAIL_HEIGHT - RAIL, RAIL_HEIGHT), origin, along, RAIL)))
        items.append(("glass", shapes.upright(band(RAIL, run - RAIL, 0.06, RAIL_HEIGHT - RAIL), origin, along, 0.015)))
        posts = max(1, round(run / POST_SPACING))
        for number in range(posts + 1):
            s = min(max(run * number / posts, RAIL / 2), run - RAIL / 2)
            sides = band(s - RAIL / 2, s + RAIL / 2, 0.0, RAIL_HEIGHT - RAIL)
            items.append(("metal", shapes.upright(sides, origin, along, RAIL)))
    return items


def add_stair(file: IfcFile) -> Entity:
    """Adds the stair of two flights; returns it."""
    ground = file.storeys[0]
    foot, turn = plan.STAIR_FOOT, plan.STAIR_FOOT + (RISERS - 1) * TREAD
    lower = (plan.STAIR_SOUTH, plan.STAIR_SOUTH + STAIR_LANE)
    upper = (plan.STAIR_NORTH - STAIR_LANE, plan.STAIR_NORTH)
    half = plan.RISE / 2
    stair = file.element("IfcStair", "Stair", ground, [], predefined="HALF_TURN_STAIR")
    parts = [
        _flight(file, "Lower flight", foot, 1.0, 0.0, lower),
        _flight(file, "Upper flight", turn, -1.0, half, upper),
        file.element(
            "IfcSlab",
            "Landing of the stair",
            ground,
            [("terrazzo", file.shapes.box((turn, lower[0], half - WAIST), (plan.EAST, upper[1], half)))],
            predefined="LANDING",
            inside=False,
        ),
    ]
    inner = RAIL / 2 + 0.02
    climb = half - plan.RISE / (2 * RISERS)  # the rails run from nosing to nosing
    riser = plan.RISE / (2 * RISERS)
    low_rail = [(foot, lower[1] - inner, riser), (turn, lower[1] - inner, riser + climb)]
    high_rail = [(turn, upper[0] + inner, half + riser), (foot, upper[0] + inner, half + riser + climb)]
    for name, line in (("Lower stair railing", low_rail), ("Upper stair railing", high_rail)):
        parts.append(
            file.element("IfcRailing", name, ground, railing(file.shapes, line), predefined="GUARDRAIL", inside=False)
        )
    file.part(stair, parts)
    return stair


def _flight(file: IfcFile, name: str, foot: float, sign: float, base: float, lane: tuple[float, float]) -> Entity:
    """A flight as one solid: the saw of its steps above, the waist's slope below."""
    riser = plan.RISE / (2 * RISERS)
    saw: list[Point2] = [(0.0, base)]
    for step in range(RISERS - 1):
        saw += [(step * TREAD, base + (step + 1) * riser), ((step + 1) * TREAD, base + (step + 1) * riser)]
    run = (RISERS - 1) * TREAD
    # Vertical depth of the waist below the line of the nosings.
    depth = WAIST * math.hypot(riser, TREAD) / TREAD + riser
    end = base + RISERS * riser
    below = [(run, end - depth), (0.0, max(base + riser - depth, base - WAIST, 0.0))]
    if base == 0.0:
        # The lower flight rests on the floor where its waist would go below it.
        rest = (depth - riser) / riser * TREAD
        below = [(run, end - depth), (rest, 0.0)]
    # The outline runs along +x for either direction of climb; mirrored, it is turned back to counter-clockwise.
    outline = [(foot + sign * s, z) for s, z in [*saw, *below]]
    if sign > 0:
        outline.reverse()
    solid = file.shapes.upright(outline, (0.0, (lane[0] + lane[1]) / 2), EASTWARD, lane[1] - lane[0])
    flight = file.element(
        "IfcStairFlight", name, file.storeys[0], [("terrazzo", solid)], predefined="STRAIGHT", inside=False
    )
    flight.NumberOfRisers, flight.NumberOfTreads = RISERS, RISERS - 1
    flight.RiserHeight, flight.TreadLength = riser, TREAD
    return flight


def add_ramp(file: IfcFile) -> Entity:
    """Adds the ramp of two lanes, its landing, the wall between the lanes and its railings; returns it."""
    ground, shapes = file.storeys[0], file.shapes
    lower, upper = plan.ramp_lane(upper=False), plan.ramp_lane(upper=True)
    wall_north = plan.LANE + plan.LANE_WALL
    # The lower lane is solid down to the floor: under it nobody could stand.
    wedge = [(plan.RAMP_EAST, 0.0), *reversed(lower)]
    slab = [*((x, z - RAMP_SLAB) for x, z in upper), *reversed(upper)]
    ramp = file.element("IfcRamp", "Ramp", ground, [], predefined="TWO_STRAIGHT_RUN_RAMP")
    parts = [
        _plate(file, "IfcRampFlight", "Lower lane", wedge, (plan.HALL_NORTH, plan.LANE), "terrazzo"),
        _plate(file, "IfcRampFlight", "Upper lane", slab, (wall_north, plan.NORTH), "terrazzo"),
        file.element(
            "IfcSlab",
            "Landing of the ramp",
            ground,
            [("terrazzo", shapes.box((plan.RAMP_EAST, plan.HALL_NORTH, 0.0), (plan.EAST, plan.NORTH, plan.RISE / 2)))],
            predefined="LANDING",
            inside=False,
        ),
    ]
    kerb = 0.1
    between = [(plan.RAMP_WEST, 0.0), (plan.RAMP_EAST, 0.0), *((x, z + kerb) for x, z in reversed(upper))]
    parts.append(_plate(file, "IfcWall", "Wall between the lanes", between, (plan.LANE, wall_north), "plaster"))
    edge = plan.HALL_NORTH + RAIL / 2
    hall_side = [(x, edge, z) for x, z in lower if x < 18.0]
    slope = (lower[-1][1] - lower[-2][1]) / (lower[-1][0] - lower[-2][0])
    hall_side.append((18.0, edge, lower[-1][1] - slope * (lower[-1][0] - 18.0)))
    middle = (plan.LANE + wall_north) / 2
    lines = {
        "Ramp railing towards the hall": hall_side,
        "Ramp railing between the lanes": [(x, middle, z + kerb) for x, z in upper],
    }
    for name, line in lines.items():
        parts.append(
            file.element("IfcRailing", name, ground, railing(shapes, line), predefined="GUARDRAIL", inside=False)
        )
    file.part(ramp, parts)
    return ramp


def add_guards(file: IfcFile) -> None:
    """Adds the railings of the upper floor: around the hall's void and at the stair's."""
    z, inset = plan.RISE, RAIL / 2 + 0.02
    west, east, south = plan.VOID_WEST - inset, plan.VOID_EAST + inset, plan.VOID_SOUTH - inset
    lines: dict[str, list[Point3]] = {
        "Gallery railing": [
            (west, plan.LANE, z),
            (west, south, z),
            (east, south, z),
            (east, plan.HALL_NORTH - inset, z),
            (18.0, plan.HALL_NORTH - inset, z),
        ],
        "Stairwell railing": [
            (plan.STAIR_FOOT - inset, plan.STAIR_SOUTH, z),
            (plan.STAIR_FOOT - inset, plan.STAIR_NORTH - STAIR_LANE + inset, z),
        ],
    }
    for name, line in lines.items():
        file.element("IfcRailing", name, file.storeys[1], railing(file.shapes, line), predefined="GUARDRAIL")


def _plate(
    file: IfcFile, kind: str, name: str, outline: Sequence[Point2], lane: tuple[float, float], colour: str
) -> Entity:
    middle = (0.0, (lane[0] + lane[1]) / 2)
    solid = file.shapes.upright(outline, middle, EASTWARD, lane[1] - lane[0])
    predefined = "STRAIGHT" if kind == "IfcRampFlight" else None
    return file.element(kind, name, file.storeys[0], [(colour, solid)], predefined=predefined, inside=False)
