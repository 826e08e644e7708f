# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The few solids the sample building is made of, as IFC representation items.

Everything is an extrusion: the most widely read solid of IFC, and one that stays editable.
Lengths and positions are in metres; a point is `(x, y)` or `(x, y, z)`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

Entity = Any  # ifcopenshell.entity_instance, which carries no types of its attributes
Point2 = tuple[float, float]
Point3 = tuple[float, float, float]


class Shapes:
    """Makes solids in an IFC file and remembers shared points and directions."""

    def __init__(self, ifc: Any) -> None:
        self._ifc = ifc
        self._shared: dict[tuple[str, tuple[float, ...]], Entity] = {}

    def box(self, low: Point3, high: Point3) -> Entity:
        """Returns the box between two corners, its sides along the axes."""
        (x0, y0, z0), (x1, y1, z1) = low, high
        profile = self._ifc.create_entity(
            "IfcRectangleProfileDef", "AREA", None, None, _number(x1 - x0), _number(y1 - y0)
        )
        return self._extrude(profile, ((x0 + x1) / 2, (y0 + y1) / 2, z0), z1 - z0)

    def cylinder(self, centre: Point3, radius: float, height: float) -> Entity:
        """Returns an upright cylinder on the centre of its foot."""
        profile = self._ifc.create_entity("IfcCircleProfileDef", "AREA", None, None, _number(radius))
        return self._extrude(profile, centre, height)

    def ngon(self, centre: Point3, radius: float, height: float, sides: int = 8) -> Entity:
        """Returns an upright prism over a regular polygon: a cylinder of few triangles."""
        angles = [2 * math.pi * k / sides for k in range(sides)]
        points = [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles]
        return self.prism(points, centre[2], centre[2] + height)

    def prism(self, outline: Sequence[Point2], z0: float, z1: float) -> Entity:
        """Returns the upright prism over a polygon (counter-clockwise) of the plan between two heights."""
        return self._extrude(self._polygon(outline), (0.0, 0.0, z0), z1 - z0)

    def upright(self, outline: Sequence[Point2], start: Point2, direction: Point2, thickness: float) -> Entity:
        """Returns a plate that stands in a vertical plane.

        Args:
            outline: Polygon of (distance along `direction` from `start`, height), counter-clockwise.
            start: Where the distance is 0; in the middle of the plate's thickness.
            direction: Horizontal unit vector.
            thickness: Of the plate, across `direction`.
        """
        dx, dy = direction
        left = (-dy, dx)  # the solid is extruded to the right, so that the outline's second axis points up
        origin = (start[0] + left[0] * thickness / 2, start[1] + left[1] * thickness / 2, 0.0)
        position = self._ifc.create_entity(
            "IfcAxis2Placement3D", self.point(origin), self.direction((dy, -dx, 0.0)), self.direction((dx, dy, 0.0))
        )
        return self._ifc.create_entity(
            "IfcExtrudedAreaSolid",
            self._polygon(outline),
            position,
            self.direction((0.0, 0.0, 1.0)),
            _number(thickness),
        )

    def point(self, xyz: Sequence[float]) -> Entity:
        """Returns the IfcCartesianPoint, one for equal coordinates."""
        return self._share("IfcCartesianPoint", xyz)

    def direction(self, xyz: Sequence[float]) -> Entity:
        """Returns the IfcDirection, one for equal components."""
        return self._share("IfcDirection", xyz)

    def _share(self, kind: str, xyz: Sequence[float]) -> Entity:
        key = (kind, tuple(_number(value) for value in xyz))
        if key not in self._shared:
            self._shared[key] = self._ifc.create_entity(kind, key[1])
        return self._shared[key]

    def _polygon(self, outline: Sequence[Point2]) -> Entity:
        points = [self.point(point) for point in outline]
        line = self._ifc.create_entity("IfcPolyline", [*points, points[0]])
        return self._ifc.create_entity("IfcArbitraryClosedProfileDef", "AREA", None, line)

    def _extrude(self, profile: Entity, foot: Point3, height: float) -> Entity:
        position = self._ifc.create_entity("IfcAxis2Placement3D", self.point(foot), None, None)
        return self._ifc.create_entity(
            "IfcExtrudedAreaSolid", profile, position, self.direction((0.0, 0.0, 1.0)), _number(height)
        )


def _number(value: float) -> float:
    # A tenth of a millimetre keeps the file short; adding 0.0 turns -0.0 into 0.0.
    return round(float(value), 4) + 0.0
