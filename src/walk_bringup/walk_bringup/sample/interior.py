# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Where the furniture of the sample building stands."""

from __future__ import annotations

import math

from walk_bringup.sample import plan
from walk_bringup.sample.furniture import PIECES
from walk_bringup.sample.ifc_file import IfcFile

Spot = tuple[str, float, float, float]  # piece, x, y, turn in degrees counter-clockwise

GROUND: tuple[Spot, ...] = (
    # Foyer
    ("Reception desk", 14.6, 3.2, 90.0),
    ("Chair", 15.3, 3.2, 90.0),
    ("Bench", 9.2, 4.7, 180.0),
    ("Yellow picture", 8.0, 3.9, -90.0),
    # Café: the counter along its north wall
    ("Café counter", 5.3, 3.9, 180.0),
    ("Bookshelf", 5.3, 5.0, 180.0),
    # Cloakroom and WCs
    ("Lockers", 17.5, 5.0, 180.0),
    ("Bench", 17.8, 2.9, 0.0),
    ("Toilet", 23.65, 1.4, 90.0),
    ("Wash basin", 22.0, 2.6, 180.0),
    ("Toilet", 23.65, 4.3, 90.0),
    ("Wash basin", 21.8, 2.75, 0.0),
    # Column hall
    ("Sculpture", 12.1, 9.3, 20.0),
    ("Display case", 9.35, 8.2, 0.0),
    ("Display case", 14.85, 8.2, 0.0),
    ("Display case", 9.35, 10.5, 0.0),
    ("Display case", 14.85, 10.5, 0.0),
    ("Bench", 12.1, 11.3, 180.0),
    ("Bench", 6.9, 6.2, -90.0),
    ("Red picture", 18.0, 10.9, 90.0),
    ("Blue picture", 8.6, 5.2, 0.0),
    ("Yellow picture", 15.4, 5.2, 0.0),
    # Workshop
    ("Long table", 3.1, 6.6, 0.0),
    ("Long table", 3.6, 8.7, 0.0),
    ("Bookshelf", 1.6, 5.2, 0.0),
    ("Bookshelf", 4.4, 5.2, 0.0),
    # Office
    ("Desk", 20.4, 6.5, 0.0),
    ("Desk", 22.6, 6.5, 0.0),
    ("Low shelf", 21.5, 8.2, 180.0),
    # Ramp foyer and store
    ("Bench", 0.8, 13.0, -90.0),
    ("Blue picture", 3.4, 10.2, 0.0),
    ("Low shelf", 6.5, 15.65, 180.0),
    ("Low shelf", 8.2, 15.65, 180.0),
)

UPPER: tuple[Spot, ...] = (
    # Gallery
    ("Red picture", 9.4, 5.2, 0.0),
    ("Blue picture", 14.8, 5.2, 0.0),
    ("Yellow picture", 18.0, 9.2, 90.0),
    ("Red picture", 6.2, 6.6, -90.0),
    # Library
    ("Bookshelf", 1.5, 5.0, 180.0),
    ("Bookshelf", 3.4, 5.0, 180.0),
    ("Bookshelf", 5.3, 5.0, 180.0),
    ("Bookshelf", 7.8, 3.4, 90.0),
    ("Armchair", 0.95, 1.2, -45.0),
    ("Armchair", 0.95, 3.9, -90.0),
    ("Long table", 4.0, 2.3, 0.0),
    # Exhibition room
    ("Display case", 10.0, 2.7, 90.0),
    ("Display case", 14.2, 2.7, 90.0),
    ("Bench", 12.1, 2.4, 0.0),
    ("Red picture", 9.5, 5.0, 180.0),
    ("Yellow picture", 14.0, 5.0, 180.0),
    ("Blue picture", 8.0, 3.6, -90.0),
    ("Blue picture", 16.0, 3.6, 90.0),
    # Reading room
    ("Desk", 19.4, 3.4, 0.0),
    ("Desk", 21.6, 3.4, 0.0),
    ("Bookshelf", 20.0, 5.0, 180.0),
    ("Bookshelf", 22.0, 5.0, 180.0),
    ("Armchair", 23.0, 1.0, 45.0),
    ("Armchair", 21.4, 0.95, -20.0),
    # Meeting room
    ("Long table", 22.0, 6.7, 0.0),
    ("Low shelf", 20.2, 8.2, 180.0),
    # Studio
    ("Long table", 2.6, 7.2, 90.0),
    ("Low shelf", 1.4, 5.2, 0.0),
    ("Low shelf", 4.6, 5.2, 0.0),
    ("Sculpture", 4.7, 6.7, 10.0),
    ("Stool", 0.9, 9.4, 0.0),
    ("Stool", 3.9, 6.1, 0.0),
    # Lookout
    ("Armchair", 1.1, 11.9, -90.0),
    ("Armchair", 1.1, 13.6, -90.0),
    ("Round table", 1.1, 12.75, 0.0),
    ("Blue picture", 2.0, 10.2, 0.0),
)

OUTSIDE: tuple[Spot, ...] = (
    ("Tree", -2.6, -2.0, 0.0),
    ("Tree", -2.6, -6.0, 25.0),
    ("Tree", 18.0, -4.5, 10.0),
    ("Tree", 22.0, -4.5, 40.0),
    ("Tree", 26.4, 3.0, 15.0),
    ("Tree", 26.4, 10.0, 5.0),
    ("Bench", 20.0, -4.5, 0.0),
    ("Bench", 20.0, -1.2, 180.0),
    ("Sculpture", 7.6, -5.2, 35.0),
)

# Where round tables stand.
CAFE_TABLES = ((1.5, 1.5), (1.5, 3.8), (6.5, 1.2))
TERRACE_TABLES = ((1.5, -2.0), (6.6, -2.0))


def add_furniture(file: IfcFile) -> None:
    """Draws every piece once and puts it where it stands."""
    types = {name: file.furniture_type(f"{kind}Type", name, draw(file.shapes)) for name, (kind, draw) in PIECES.items()}
    ground, upper = file.storeys
    floors = (
        (ground, 0.0, (*GROUND, *_seats(GROUND), *_round(CAFE_TABLES))),
        (upper, plan.RISE, (*UPPER, *_seats(UPPER))),
        (file.site, plan.PLAZA, (*OUTSIDE, *_round(TERRACE_TABLES))),
    )
    for place, height, spots in floors:
        for name, x, y, turn in spots:
            file.place_furniture(types[name], PIECES[name][0], (x, y, height), turn, place)


def _seats(spots: tuple[Spot, ...]) -> tuple[Spot, ...]:
    """Returns the chairs that belong to desks (one) and long tables (two on each side)."""
    around = {
        "Desk": ((0.0, -0.62, 0.0),),
        "Long table": ((-0.6, -0.75, 0.0), (0.6, -0.75, 0.0), (-0.6, 0.75, 180.0), (0.6, 0.75, 180.0)),
    }
    seats: list[Spot] = []
    for name, x, y, turn in spots:
        cos, sin = math.cos(math.radians(turn)), math.sin(math.radians(turn))
        for a, b, face in around.get(name, ()):
            seats.append(("Chair", x + cos * a - sin * b, y + sin * a + cos * b, (turn + face) % 360.0))
    return tuple(seats)


def _round(tables: tuple[tuple[float, float], ...]) -> tuple[Spot, ...]:
    """Returns round tables with three chairs each."""
    spots: list[Spot] = []
    for number, (x, y) in enumerate(tables):
        spots.append(("Round table", x, y, 0.0))
        for k in range(3):
            angle = 35.0 * number + 120.0 * k
            cos, sin = math.cos(math.radians(angle)), math.sin(math.radians(angle))
            # A chair looks at the table: its +y points against the way out to it.
            spots.append(("Chair", x + 0.58 * cos, y + 0.58 * sin, (angle + 90.0) % 360.0))
    return tuple(spots)
