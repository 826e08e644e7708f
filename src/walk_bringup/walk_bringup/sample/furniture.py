# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The pieces of furniture of the sample building, each drawn once around its own origin on the floor.

A piece faces +y: who sits on a chair looks that way, a shelf has its back at -y.
"""

from __future__ import annotations

from collections.abc import Callable

from walk_bringup.sample.ifc_file import Item
from walk_bringup.sample.shapes import Shapes


def _chair(shapes: Shapes) -> list[Item]:
    legs = [(x, y) for x in (-0.19, 0.16) for y in (-0.2, 0.15)]
    return [
        *(("oak", shapes.box((x, y, 0.0), (x + 0.03, y + 0.03, 0.43))) for x, y in legs),
        ("oak", shapes.box((-0.21, -0.21, 0.43), (0.21, 0.2, 0.46))),
        ("fabric", shapes.box((-0.21, -0.22, 0.46), (0.21, -0.18, 0.84))),
    ]


def _stool(shapes: Shapes) -> list[Item]:
    return [
        ("metal", shapes.ngon((0.0, 0.0, 0.0), 0.16, 0.03)),
        ("metal", shapes.ngon((0.0, 0.0, 0.03), 0.025, 0.45, sides=6)),
        ("oak", shapes.ngon((0.0, 0.0, 0.48), 0.17, 0.04, sides=12)),
    ]


def _round_table(shapes: Shapes) -> list[Item]:
    return [
        ("metal", shapes.ngon((0.0, 0.0, 0.0), 0.26, 0.03, sides=12)),
        ("metal", shapes.ngon((0.0, 0.0, 0.03), 0.04, 0.67)),
        ("oak", shapes.ngon((0.0, 0.0, 0.7), 0.4, 0.03, sides=20)),
    ]


def _table(length: float, width: float) -> Callable[[Shapes], list[Item]]:
    def draw(shapes: Shapes) -> list[Item]:
        x, y = length / 2, width / 2
        legs = [(a, b) for a in (-x + 0.04, x - 0.1) for b in (-y + 0.04, y - 0.1)]
        return [
            *(("metal", shapes.box((a, b, 0.0), (a + 0.06, b + 0.06, 0.7))) for a, b in legs),
            ("oak", shapes.box((-x, -y, 0.7), (x, y, 0.74))),
        ]

    return draw


def _bench(shapes: Shapes) -> list[Item]:
    return [
        ("metal", shapes.box((-0.7, -0.18, 0.0), (-0.62, 0.18, 0.4))),
        ("metal", shapes.box((0.62, -0.18, 0.0), (0.7, 0.18, 0.4))),
        ("oak", shapes.box((-0.8, -0.22, 0.4), (0.8, 0.22, 0.46))),
    ]


def _armchair(shapes: Shapes) -> list[Item]:
    return [
        ("fabric", shapes.box((-0.36, -0.26, 0.12), (0.36, 0.38, 0.42))),
        ("fabric", shapes.box((-0.36, -0.4, 0.12), (0.36, -0.26, 0.82))),
        ("walnut", shapes.box((-0.44, -0.4, 0.0), (-0.36, 0.38, 0.6))),
        ("walnut", shapes.box((0.36, -0.4, 0.0), (0.44, 0.38, 0.6))),
    ]


def _shelf(length: float, height: float) -> Callable[[Shapes], list[Item]]:
    def draw(shapes: Shapes) -> list[Item]:
        x, depth, board = length / 2, 0.34, 0.03
        levels = max(3, round(height / 0.4))
        boards = [board + (height - 2 * board) * k / levels for k in range(levels + 1)]
        items: list[Item] = [
            ("walnut", shapes.box((-x, 0.0, 0.0), (-x + board, depth, height))),
            ("walnut", shapes.box((x - board, 0.0, 0.0), (x, depth, height))),
            ("walnut", shapes.box((-x + board, 0.0, 0.0), (x - board, 0.02, height))),
            *(("walnut", shapes.box((-x + board, 0.02, z - board), (x - board, depth, z))) for z in boards),
        ]
        colours = ("crimson", "ochre", "ultramarine", "fabric")
        for k, z in enumerate(boards[:-1]):
            # Rows of books that end where the next hand took one out.
            reach = x - board - 0.15 - 0.11 * ((3 * k) % 4)
            items.append((colours[k % 4], shapes.box((-x + board, 0.02, z), (reach, 0.24, z + 0.24))))
        return items

    return draw


def _display_case(shapes: Shapes) -> list[Item]:
    return [
        ("walnut", shapes.box((-0.6, -0.35, 0.0), (0.6, 0.35, 0.8))),
        ("bronze", shapes.ngon((-0.25, 0.0, 0.8), 0.1, 0.22)),
        ("ceramic", shapes.ngon((0.2, 0.0, 0.8), 0.14, 0.12, sides=10)),
        ("glass", shapes.box((-0.58, -0.33, 0.805), (0.58, 0.33, 1.25))),
    ]


def _sculpture(shapes: Shapes) -> list[Item]:
    return [
        ("concrete", shapes.box((-0.4, -0.4, 0.0), (0.4, 0.4, 0.7))),
        ("bronze", shapes.ngon((0.0, 0.0, 0.7), 0.14, 0.7, sides=6)),
        ("bronze", shapes.ngon((0.06, 0.02, 1.4), 0.24, 0.45, sides=7)),
        ("bronze", shapes.ngon((-0.05, 0.0, 1.85), 0.13, 0.4, sides=5)),
    ]


def _picture(colour: str, width: float) -> Callable[[Shapes], list[Item]]:
    def draw(shapes: Shapes) -> list[Item]:
        x = width / 2
        return [
            ("walnut", shapes.box((-x, 0.0, 1.15), (x, 0.03, 1.15 + 0.75 * width + 0.2))),
            (colour, shapes.box((-x + 0.06, 0.03, 1.21), (x - 0.06, 0.035, 1.15 + 0.75 * width + 0.14))),
        ]

    return draw


def _reception(shapes: Shapes) -> list[Item]:
    return [
        ("walnut", shapes.box((-1.2, 0.25, 0.0), (1.2, 0.35, 1.05))),
        ("oak", shapes.box((-1.25, 0.1, 1.05), (1.25, 0.4, 1.09))),
        ("walnut", shapes.box((-1.2, -0.35, 0.0), (-1.1, 0.25, 0.7))),
        ("walnut", shapes.box((1.1, -0.35, 0.0), (1.2, 0.25, 0.7))),
        ("oak", shapes.box((-1.2, -0.4, 0.7), (1.2, 0.25, 0.74))),
    ]


def _counter(shapes: Shapes) -> list[Item]:
    return [
        ("walnut", shapes.box((-1.3, -0.3, 0.0), (1.3, 0.3, 0.98))),
        ("concrete", shapes.box((-1.35, -0.33, 0.98), (1.35, 0.35, 1.03))),
        ("metal", shapes.box((0.5, -0.2, 1.03), (1.0, 0.15, 1.4))),
        ("glass", shapes.box((-1.0, -0.2, 1.035), (0.2, 0.25, 1.33))),
    ]


def _lockers(shapes: Shapes) -> list[Item]:
    doors = [
        ("ultramarine", shapes.box((-0.88 + 0.36 * k, 0.45, 0.12), (-0.56 + 0.36 * k, 0.47, 1.86))) for k in range(5)
    ]
    return [("metal", shapes.box((-0.92, 0.0, 0.0), (0.92, 0.45, 1.9))), *doors]


def _toilet(shapes: Shapes) -> list[Item]:
    return [
        ("ceramic", shapes.box((-0.19, 0.0, 0.0), (0.19, 0.16, 0.85))),
        ("ceramic", shapes.box((-0.15, 0.16, 0.0), (0.15, 0.45, 0.38))),
        ("ceramic", shapes.ngon((0.0, 0.4, 0.38), 0.21, 0.05, sides=14)),
    ]


def _basin(shapes: Shapes) -> list[Item]:
    return [
        ("ceramic", shapes.box((-0.27, 0.0, 0.72), (0.27, 0.42, 0.86))),
        ("glass", shapes.box((-0.27, 0.0, 1.15), (0.27, 0.01, 1.9))),
    ]


def _tree(shapes: Shapes) -> list[Item]:
    crown = ((2.1, 0.7, 0.4), (2.5, 1.25, 0.9), (3.4, 1.0, 0.7), (4.1, 0.55, 0.4))
    return [
        ("bark", shapes.ngon((0.0, 0.0, 0.0), 0.11, 2.2, sides=7)),
        *(("leaf", shapes.ngon((0.0, 0.0, z), radius, height, sides=9)) for z, radius, height in crown),
    ]


# Every piece: name, IFC class of one piece, what draws it. A class's type is called like it, with Type behind.
PIECES: dict[str, tuple[str, Callable[[Shapes], list[Item]]]] = {
    "Chair": ("IfcFurniture", _chair),
    "Stool": ("IfcFurniture", _stool),
    "Round table": ("IfcFurniture", _round_table),
    "Desk": ("IfcFurniture", _table(1.6, 0.8)),
    "Long table": ("IfcFurniture", _table(2.6, 1.1)),
    "Bench": ("IfcFurniture", _bench),
    "Armchair": ("IfcFurniture", _armchair),
    "Bookshelf": ("IfcFurniture", _shelf(1.8, 2.1)),
    "Low shelf": ("IfcFurniture", _shelf(1.4, 1.2)),
    "Display case": ("IfcFurniture", _display_case),
    "Sculpture": ("IfcFurniture", _sculpture),
    "Red picture": ("IfcFurniture", _picture("crimson", 1.0)),
    "Yellow picture": ("IfcFurniture", _picture("ochre", 0.8)),
    "Blue picture": ("IfcFurniture", _picture("ultramarine", 1.3)),
    "Reception desk": ("IfcFurniture", _reception),
    "Café counter": ("IfcFurniture", _counter),
    "Lockers": ("IfcFurniture", _lockers),
    "Toilet": ("IfcSanitaryTerminal", _toilet),
    "Wash basin": ("IfcSanitaryTerminal", _basin),
    "Tree": ("IfcGeographicElement", _tree),
}
