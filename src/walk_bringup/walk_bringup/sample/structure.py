# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Slabs, columns, roof and plaza of the sample building."""

from __future__ import annotations

from walk_bringup.sample import plan
from walk_bringup.sample.ifc_file import IfcFile, Item
from walk_bringup.sample.plan import rectangle
from walk_bringup.sample.shapes import Entity

COLUMN_RADIUS = 0.17
COPING = 0.05
FLOORING = 0.02  # the boards on the upper slab
SKYLIGHTS = (9.35, 12.1, 14.85)  # x of their middles, between the columns
SKYLIGHT_WIDTH, SKYLIGHT_SOUTH, SKYLIGHT_NORTH = 1.6, 7.6, 11.2


def add_structure(file: IfcFile) -> None:
    """Adds everything that carries: floors, columns, roof, canopy and the plaza outside."""
    _add_slabs(file)
    _add_columns(file)
    _add_roof(file)
    _add_canopy(file)


def _add_slabs(file: IfcFile) -> None:
    ground, upper = file.storeys
    base = file.shapes.box((0.0, 0.0, -0.3), (plan.LENGTH, plan.DEPTH, 0.0))
    file.element("IfcSlab", "Ground slab", ground, [("terrazzo", base)], predefined="BASESLAB")
    low = (plan.OUTER_WALL, plan.OUTER_WALL, plan.CEILING)
    seam = plan.RISE - FLOORING
    floor: list[Item] = [
        ("concrete", file.shapes.box(low, (plan.EAST, plan.NORTH, seam))),
        ("oak", file.shapes.box((*low[:2], seam), (plan.EAST, plan.NORTH, plan.RISE))),
    ]
    slab = file.element("IfcSlab", "Upper floor slab", upper, floor, predefined="FLOOR")
    for name, outline in (("hall and ramp", plan.HALL_VOID), ("stair", plan.STAIR_VOID)):
        _cut(file, slab, upper, f"Void of {name}", [file.shapes.prism(outline, plan.CEILING - 0.1, plan.RISE + 0.1)])
    paving = file.shapes.box((-5.0, -9.0, plan.PLAZA - 0.2), (plan.LENGTH + 5.0, plan.DEPTH + 4.0, plan.PLAZA))
    file.element("IfcSlab", "Paving of the plaza", file.site, [("paving", paving)], predefined="BASESLAB")


def _add_columns(file: IfcFile) -> None:
    for number, (x, y) in enumerate(plan.COLUMNS, start=1):
        shaft = file.shapes.cylinder((x, y, 0.0), COLUMN_RADIUS, plan.ROOF)
        plinth = file.shapes.ngon((x, y, 0.0), COLUMN_RADIUS + 0.06, 0.12, sides=16)
        items: list[Item] = [("concrete", shaft), ("concrete", plinth)]
        file.element("IfcColumn", f"Column {number}", file.storeys[0], items, predefined="COLUMN")


def _add_roof(file: IfcFile) -> None:
    upper = file.storeys[1]
    roof = file.element("IfcRoof", "Roof", upper, [], predefined="FLAT_ROOF")
    low = (plan.OUTER_WALL, plan.OUTER_WALL, plan.ROOF)
    solid = file.shapes.box(low, (plan.EAST, plan.NORTH, plan.ROOF + 0.3))
    slab = file.element("IfcSlab", "Roof slab", upper, [("concrete", solid)], predefined="ROOF", inside=False)
    file.part(roof, [slab])
    for number, x in enumerate(SKYLIGHTS, start=1):
        _add_skylight(file, slab, f"Skylight {number}", x)
    over, top = 0.06, plan.PARAPET + COPING
    inner = plan.OUTER_WALL + over
    strips = (
        rectangle(-over, -over, plan.LENGTH + over, inner),
        rectangle(-over, plan.DEPTH - inner, plan.LENGTH + over, plan.DEPTH + over),
        rectangle(-over, inner, inner, plan.DEPTH - inner),
        rectangle(plan.LENGTH - inner, inner, plan.LENGTH + over, plan.DEPTH - inner),
    )
    items: list[Item] = [("zinc", file.shapes.prism(outline, plan.PARAPET, top)) for outline in strips]
    file.element("IfcCovering", "Coping of the parapet", upper, items)


def _add_skylight(file: IfcFile, slab: Entity, name: str, x: float) -> None:
    upper = file.storeys[1]
    west, east = x - SKYLIGHT_WIDTH / 2, x + SKYLIGHT_WIDTH / 2
    south, north = SKYLIGHT_SOUTH, SKYLIGHT_NORTH
    foot, kerb, frame = plan.ROOF, plan.ROOF + 0.55, 0.08
    box = file.shapes.box
    items: list[Item] = [
        ("zinc", box((west, south, foot), (west + frame, north, kerb))),
        ("zinc", box((east - frame, south, foot), (east, north, kerb))),
        ("zinc", box((west + frame, south, foot), (east - frame, south + frame, kerb))),
        ("zinc", box((west + frame, north - frame, foot), (east - frame, north, kerb))),
        ("glass", box((west, south, kerb), (east, north, kerb + 0.03))),
    ]
    window = file.element("IfcWindow", name, upper, items, predefined="SKYLIGHT")
    window.OverallWidth, window.OverallHeight = SKYLIGHT_WIDTH, north - south
    hole = box((west, south, foot - 0.1), (east, north, foot + 0.4))
    _cut(file, slab, upper, f"Opening of {name}", [hole], window)


def _add_canopy(file: IfcFile) -> None:
    shapes, ground = file.shapes, file.storeys[0]
    slab = shapes.box((9.6, -2.6, 2.75), (14.6, 0.0, 2.93))
    file.element("IfcSlab", "Canopy of the entrance", ground, [("zinc", slab)], predefined="ROOF")
    for number, x in enumerate((10.0, 14.2), start=1):
        post = shapes.cylinder((x, -2.2, plan.PLAZA), 0.07, 2.75 - plan.PLAZA)
        file.element("IfcColumn", f"Canopy post {number}", ground, [("metal", post)], predefined="COLUMN")


def _cut(
    file: IfcFile, host: Entity, storey: Entity, name: str, solids: list[Entity], filling: Entity | None = None
) -> None:
    items: list[Item] = [("", solid) for solid in solids]
    hole = file.element("IfcOpeningElement", name, storey, items, predefined="OPENING", inside=False)
    file.cut(host, hole, filling)
