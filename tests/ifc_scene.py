# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A tiny writer of IFC files, and a building of known sizes made with it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import ifcopenshell
import ifcopenshell.guid

UNIT_M = {"metre": 1.0, "millimetre": 0.001, "foot": 0.3048}


class IfcScene:
    """A tiny IFC writer: boxes given in metres, placed in storeys, written in the file's unit."""

    def __init__(
        self, schema: str = "IFC4", unit: str = "metre", origin: tuple[float, float, float] = (0, 0, 0)
    ) -> None:
        self.file = ifcopenshell.file(schema=schema)
        self.unit_m = UNIT_M[unit]
        self.context = self.make(
            "IfcGeometricRepresentationContext",
            ContextIdentifier="Body",
            ContextType="Model",
            CoordinateSpaceDimension=3,
            Precision=1e-5,
            WorldCoordinateSystem=self.axes((0, 0, 0)),
        )
        project = self.rooted("IfcProject", "project")
        project.RepresentationContexts = [self.context]
        project.UnitsInContext = self.make("IfcUnitAssignment", Units=[self._length(unit)])
        self.building = self.rooted("IfcBuilding", "building", ObjectPlacement=self.placement(None, origin))
        self.aggregate(project, self.building)

    def make(self, kind: str, **attributes: Any) -> Any:
        return self.file.create_entity(kind, **attributes)

    def rooted(self, kind: str, name: str, **attributes: Any) -> Any:
        return self.make(kind, GlobalId=ifcopenshell.guid.new(), Name=name, **attributes)

    def _length(self, unit: str) -> Any:
        prefix = "MILLI" if unit == "millimetre" else None
        metre = self.make("IfcSIUnit", UnitType="LENGTHUNIT", Prefix=prefix, Name="METRE")
        if unit != "foot":
            return metre
        value = self.file.create_entity("IfcLengthMeasure", 0.3048)
        factor = self.make("IfcMeasureWithUnit", ValueComponent=value, UnitComponent=metre)
        exponents = self.file.create_entity("IfcDimensionalExponents", 1, 0, 0, 0, 0, 0, 0)
        return self.make(
            "IfcConversionBasedUnit", Dimensions=exponents, UnitType="LENGTHUNIT", Name="FOOT", ConversionFactor=factor
        )

    def point(self, *coordinates: float) -> Any:
        return self.make("IfcCartesianPoint", Coordinates=[float(c) / self.unit_m for c in coordinates])

    def axes(self, origin: tuple[float, float, float]) -> Any:
        return self.make("IfcAxis2Placement3D", Location=self.point(*origin))

    def placement(self, parent: Any, origin: tuple[float, float, float]) -> Any:
        return self.make("IfcLocalPlacement", PlacementRelTo=parent, RelativePlacement=self.axes(origin))

    def aggregate(self, whole: Any, *parts: Any) -> None:
        self.rooted("IfcRelAggregates", "parts", RelatingObject=whole, RelatedObjects=list(parts))

    def storey(self, name: str, elevation_m: float) -> Any:
        storey = self.rooted(
            "IfcBuildingStorey",
            name,
            Elevation=elevation_m / self.unit_m,
            ObjectPlacement=self.placement(self.building.ObjectPlacement, (0, 0, elevation_m)),
        )
        self.aggregate(self.building, storey)
        return storey

    def box_shape(self, size: tuple[float, float, float]) -> Any:
        corner = self.make("IfcAxis2Placement2D", Location=self.point(size[0] / 2, size[1] / 2))
        profile = self.make(
            "IfcRectangleProfileDef",
            ProfileType="AREA",
            Position=corner,
            XDim=size[0] / self.unit_m,
            YDim=size[1] / self.unit_m,
        )
        up = self.make("IfcDirection", DirectionRatios=[0.0, 0.0, 1.0])
        solid = self.make(
            "IfcExtrudedAreaSolid",
            SweptArea=profile,
            Position=self.axes((0, 0, 0)),
            ExtrudedDirection=up,
            Depth=size[2] / self.unit_m,
        )
        return self.make(
            "IfcShapeRepresentation",
            ContextOfItems=self.context,
            RepresentationIdentifier="Body",
            RepresentationType="SweptSolid",
            Items=[solid],
        )

    def box(
        self,
        kind: str,
        name: str,
        storey: Any,
        low: tuple[float, float, float],
        size: tuple[float, float, float],
        **attributes: Any,
    ) -> Any:
        shape = self.make("IfcProductDefinitionShape", Representations=[self.box_shape(size)])
        product = self.rooted(
            kind,
            name,
            ObjectPlacement=self.placement(storey.ObjectPlacement, low),
            Representation=shape,
            **attributes,
        )
        if kind == "IfcSpace":
            self.aggregate(storey, product)
        elif kind != "IfcOpeningElement":
            self.rooted("IfcRelContainedInSpatialStructure", "in", RelatingStructure=storey, RelatedElements=[product])
        return product

    def write(self, path: Path) -> Path:
        self.file.write(str(path))
        return path


def two_storeys(**settings: Any) -> IfcScene:
    """6 x 4 m, floors 0.2 m thick at z 0 and 3, a wall with a door, a window, a chair and a space."""
    scene = IfcScene(**settings)
    ground, upper = scene.storey("Ground", 0.0), scene.storey("Upper", 3.0)
    scene.box("IfcSlab", "floor 0", ground, (0, 0, -0.2), (6, 4, 0.2))
    scene.box("IfcSlab", "floor 1", upper, (0, 0, -0.2), (6, 4, 0.2))
    wall = scene.box("IfcWall", "wall", ground, (0, 0, 0), (6, 0.2, 2.8))
    opening = scene.box("IfcOpeningElement", "hole", ground, (1, -0.5, 0), (0.9, 1.2, 2.1))
    scene.rooted("IfcRelVoidsElement", "voids", RelatingBuildingElement=wall, RelatedOpeningElement=opening)
    door = scene.box("IfcDoor", "front door", ground, (1, 0, 0), (0.9, 0.1, 2.1))
    scene.rooted("IfcRelFillsElement", "fills", RelatingOpeningElement=opening, RelatedBuildingElement=door)
    scene.box("IfcWindow", "window", ground, (4, 3.9, 1), (1, 0.1, 1))
    scene.box("IfcFurnishingElement", "chair", ground, (3, 2, 0), (0.5, 0.5, 0.9))
    scene.box("IfcSpace", "G01", ground, (0, 0.2, 0), (6, 3.8, 2.8), LongName="Hall")
    return scene
