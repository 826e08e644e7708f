# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Walls with what is cut into them: doors that are closed, windows with frame and pane, passages."""

from __future__ import annotations

from walk_bringup.sample.ifc_file import IfcFile, Item
from walk_bringup.sample.plan import OUTER_WALL, Opening, Wall
from walk_bringup.sample.shapes import Entity, Point3, Shapes

FRAME = 0.06
LEAF = 0.05
PANE = 0.02
LINING = 0.1  # of the outer walls, inside of the facade


def add_wall(file: IfcFile, wall: Wall) -> Entity:
    """Adds a wall, cuts its openings and fills them; returns the wall."""
    storey = file.storeys[wall.storey]
    entity = file.element("IfcWall", wall.name, storey, _layers(file.shapes, wall))
    entity.PredefinedType = "SOLIDWALL"
    file.properties(entity, "Pset_WallCommon", {"IsExternal": wall.outer, "LoadBearing": wall.outer})
    where = wall.name[0].lower() + wall.name[1:]
    for number, opening in enumerate(wall.openings, start=1):
        _add_opening(file, wall, entity, opening, f"{opening.kind.capitalize()} {number} in {where}")
    return entity


def _layers(shapes: Shapes, wall: Wall) -> list[Item]:
    """One solid of plaster, or for an outer wall the lining inside and the facade outside."""
    frame = Frame(shapes, wall)
    half, heights = frame.thickness / 2, (wall.foot, wall.top)
    if not wall.outer:
        return [("plaster", frame.box(frame.ends, (-half, half), heights))]
    facade = "brick" if wall.storey == 0 else "larch"
    # At a corner the facades of both walls meet, so that no lining shows outside.
    ends = facade_ends = lining_ends = frame.ends
    if ends[0] == 0.0:
        lining_ends = (ends[0] + frame.thickness - LINING, ends[1] - frame.thickness + LINING)
    else:
        facade_ends = (ends[0] - LINING, ends[1] + LINING)
    faces_low = wall.low[0] == 0.0 and wall.low[1] in (0.0, OUTER_WALL)  # to the south or the west
    seam = half - LINING
    outside, inside = ((-half, seam), (seam, half)) if faces_low else ((-seam, half), (-half, -seam))
    return [
        (facade, frame.box(facade_ends, outside, heights)),
        ("plaster", frame.box(lining_ends, inside, heights)),
    ]


class Frame:
    """Boxes in a wall, given along it (s), across it (t, 0 in the middle) and up (z)."""

    def __init__(self, shapes: Shapes, wall: Wall) -> None:
        self._shapes = shapes
        self._along_x = wall.high[0] - wall.low[0] >= wall.high[1] - wall.low[1]
        across = 1 if self._along_x else 0
        self._middle = (wall.low[across] + wall.high[across]) / 2
        self.thickness = wall.high[across] - wall.low[across]
        self.ends = (wall.low[1 - across], wall.high[1 - across])

    def box(self, s: tuple[float, float], t: tuple[float, float], z: tuple[float, float]) -> Entity:
        """Returns the box between two coordinates along the wall, across it and up."""
        low, high = (self._corner(s[k], t[k], z[k]) for k in (0, 1))
        return self._shapes.box(low, high)

    def _corner(self, s: float, t: float, z: float) -> Point3:
        return (s, self._middle + t, z) if self._along_x else (self._middle + t, s, z)


def _add_opening(file: IfcFile, wall: Wall, host: Entity, opening: Opening, name: str) -> None:
    frame = Frame(file.shapes, wall)
    storey = file.storeys[wall.storey]
    s = (opening.at - opening.width / 2, opening.at + opening.width / 2)
    z = (wall.foot + opening.sill, wall.foot + opening.sill + opening.height)
    # A little deeper than the wall: faces that coincide are where boolean engines fail.
    depth = frame.thickness / 2 + 0.02
    hole = file.element(
        "IfcOpeningElement",
        f"Opening of {name}",
        storey,
        [("", frame.box(s, (-depth, depth), z))],
        predefined="OPENING",
        inside=False,
    )
    if opening.kind == "passage":
        file.cut(host, hole)
        return
    items = _door(frame, opening, s, z) if opening.kind == "door" else _window(frame, s, z)
    kind = "IfcDoor" if opening.kind == "door" else "IfcWindow"
    filling = file.element(kind, name, storey, items, predefined=opening.kind.upper())
    filling.OverallWidth, filling.OverallHeight = opening.width, opening.height
    if kind == "IfcDoor":
        filling.OperationType = "DOUBLE_DOOR_SINGLE_SWING" if opening.width >= 1.6 else "SINGLE_SWING_LEFT"
    file.cut(host, hole, filling)


def _door(frame: Frame, opening: Opening, s: tuple[float, float], z: tuple[float, float]) -> list[Item]:
    """A lining on three sides and one or two closed leaves with handles."""
    half = frame.thickness / 2
    lining, leaf = (-half, half), (-LEAF / 2, LEAF / 2)
    items: list[Item] = [
        ("walnut", frame.box((s[0], s[0] + FRAME / 2), lining, z)),
        ("walnut", frame.box((s[1] - FRAME / 2, s[1]), lining, z)),
        ("walnut", frame.box((s[0] + FRAME / 2, s[1] - FRAME / 2), lining, (z[1] - FRAME / 2, z[1]))),
    ]
    low, high = s[0] + FRAME / 2, s[1] - FRAME / 2
    middle = (low + high) / 2
    leaves = [(low, middle - 0.005), (middle + 0.005, high)] if opening.width >= 1.6 else [(low, high)]
    top = z[1] - FRAME / 2
    for number, (left, right) in enumerate(leaves):
        items.append(("glass" if opening.glazed else "oak", frame.box((left, right), leaf, (z[0] + 0.01, top))))
        handle = right - 0.12 if number == 0 else left + 0.12
        items.append(("metal", frame.box((handle - 0.015, handle + 0.015), (-0.07, 0.07), (z[0] + 0.95, z[0] + 1.15))))
    return items


def _window(frame: Frame, s: tuple[float, float], z: tuple[float, float]) -> list[Item]:
    """A frame on four sides, a mullion where it is wide, and the pane."""
    depth = (-0.05, 0.05)
    items: list[Item] = [
        ("metal", frame.box((s[0], s[0] + FRAME), depth, z)),
        ("metal", frame.box((s[1] - FRAME, s[1]), depth, z)),
        ("metal", frame.box((s[0] + FRAME, s[1] - FRAME), depth, (z[0], z[0] + FRAME))),
        ("metal", frame.box((s[0] + FRAME, s[1] - FRAME), depth, (z[1] - FRAME, z[1]))),
    ]
    if s[1] - s[0] > 1.5:
        middle = (s[0] + s[1]) / 2
        items.append(("metal", frame.box((middle - 0.025, middle + 0.025), depth, (z[0] + FRAME, z[1] - FRAME))))
    pane = (-PANE / 2, PANE / 2)
    items.append(("glass", frame.box((s[0] + FRAME, s[1] - FRAME), pane, (z[0] + FRAME, z[1] - FRAME))))
    return items
