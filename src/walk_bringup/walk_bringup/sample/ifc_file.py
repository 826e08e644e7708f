# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The IFC file of the sample building: project, storeys, elements, colours, and a byte-identical way to write it."""

from __future__ import annotations

import math
import uuid
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import ifcopenshell
import ifcopenshell.api.aggregate
import ifcopenshell.api.context
import ifcopenshell.api.feature
import ifcopenshell.api.project
import ifcopenshell.api.pset
import ifcopenshell.api.root
import ifcopenshell.api.spatial
import ifcopenshell.api.style
import ifcopenshell.api.type
import ifcopenshell.api.unit
import ifcopenshell.guid

from walk_bringup.sample.shapes import Entity, Point3, Shapes

Item = tuple[str, Entity]  # name of a colour, solid

COLOURS: dict[str, tuple[float, float, float, float]] = {  # red, green, blue, transparency
    "plaster": (0.94, 0.92, 0.88, 0.0),
    "brick": (0.80, 0.76, 0.70, 0.0),
    "larch": (0.68, 0.54, 0.40, 0.0),
    "concrete": (0.75, 0.74, 0.72, 0.0),
    "paving": (0.66, 0.64, 0.60, 0.0),
    "terrazzo": (0.84, 0.82, 0.78, 0.0),
    "zinc": (0.47, 0.50, 0.53, 0.0),
    "metal": (0.20, 0.21, 0.23, 0.0),
    "glass": (0.65, 0.80, 0.86, 0.7),
    "oak": (0.72, 0.53, 0.33, 0.0),
    "walnut": (0.42, 0.28, 0.19, 0.0),
    "fabric": (0.16, 0.38, 0.45, 0.0),
    "ceramic": (0.96, 0.96, 0.96, 0.0),
    "bark": (0.38, 0.29, 0.22, 0.0),
    "leaf": (0.38, 0.55, 0.30, 0.0),
    "bronze": (0.55, 0.40, 0.20, 0.0),
    "ochre": (0.85, 0.62, 0.20, 0.0),
    "crimson": (0.68, 0.20, 0.22, 0.0),
    "ultramarine": (0.18, 0.26, 0.58, 0.0),
}

# Names every GlobalId; any fixed value would do.
_NAMESPACE = uuid.UUID("6d1c4f0a-3b7e-5d52-9a41-2f8e7c90b315")
_TIME = "2024-01-01T00:00:00"


class IfcFile:
    """Collects the building's elements; `save` ties them to their storeys and writes the file.

    Attributes:
        shapes: Makes the solids of this file.
        storeys: The IfcBuildingStorey entities, lowest first.
        site: The IfcSite.
    """

    def __init__(self, name: str, elevations: dict[str, float]) -> None:
        self._ifc = ifcopenshell.api.project.create_file(version="IFC4")
        self.shapes = Shapes(self._ifc)
        project = ifcopenshell.api.root.create_entity(self._ifc, "IfcProject", name=name)
        metre = self._ifc.create_entity("IfcSIUnit", None, "LENGTHUNIT", None, "METRE")
        angle = self._ifc.create_entity("IfcSIUnit", None, "PLANEANGLEUNIT", None, "RADIAN")
        ifcopenshell.api.unit.assign_unit(self._ifc, units=[metre, angle])
        model = ifcopenshell.api.context.add_context(self._ifc, context_type="Model")
        self._body = ifcopenshell.api.context.add_context(
            self._ifc, context_type="Model", context_identifier="Body", target_view="MODEL_VIEW", parent=model
        )
        self._styles = {key: self._style(key, rgba) for key, rgba in COLOURS.items()}
        self._where: dict[int, tuple[Entity, Point3, float]] = {}
        self.site = self._spatial("IfcSite", "Plaza", project, None, 0.0)
        building = self._spatial("IfcBuilding", name, self.site, self.site, 0.0)
        self.storeys = tuple(
            self._spatial("IfcBuildingStorey", storey, building, building, elevation)
            for storey, elevation in elevations.items()
        )
        self._elevation = {storey.id(): storey.Elevation for storey in self.storeys} | {self.site.id(): 0.0}
        self._contained: dict[int, list[Entity]] = {}
        self._spaces: dict[int, list[Entity]] = {}
        self._typed: dict[int, list[Entity]] = {}

    def element(
        self,
        kind: str,
        name: str,
        place: Entity,
        items: Sequence[Item],
        *,
        predefined: str | None = None,
        inside: bool = True,
    ) -> Entity:
        """Returns a new element whose solids are given in the building's coordinates.

        Args:
            kind: IFC class.
            name: For the reader; GlobalIds follow from it.
            place: Storey, or the site, that the element stands on.
            items: Its coloured solids; none for an element made of parts.
            predefined: The class's PredefinedType.
            inside: Whether the storey contains it; a part of a whole and an opening belong to their host.
        """
        product = ifcopenshell.api.root.create_entity(self._ifc, kind, predefined_type=predefined, name=name)
        # Solids come with their heights in the building, so the placement takes the storey's elevation back.
        self._where[product.id()] = (place, (0.0, 0.0, -self._elevation[place.id()]), 0.0)
        if items:
            product.Representation = self._ifc.create_entity(
                "IfcProductDefinitionShape", None, None, [self._representation(items)]
            )
        if inside:
            self._contained.setdefault(place.id(), []).append(product)
        return product

    def space(self, number: str, name: str, storey: Entity, solids: Sequence[Entity]) -> Entity:
        """Returns a room: number in Name, what people call it in LongName."""
        items = [("", solid) for solid in solids]
        room = self.element("IfcSpace", number, storey, items, predefined="INTERNAL", inside=False)
        room.LongName = name
        room.CompositionType = "ELEMENT"
        self._spaces.setdefault(storey.id(), []).append(room)
        return room

    def part(self, whole: Entity, parts: Sequence[Entity]) -> None:
        """Makes elements the parts of another."""
        ifcopenshell.api.aggregate.assign_object(self._ifc, products=list(parts), relating_object=whole)
        for product in parts:
            self._where[product.id()] = (whole, (0.0, 0.0, 0.0), 0.0)

    def cut(self, host: Entity, opening: Entity, filling: Entity | None = None) -> None:
        """Cuts an opening into a wall or slab and says what fills it."""
        ifcopenshell.api.feature.add_feature(self._ifc, feature=opening, element=host)
        self._where[opening.id()] = (host, (0.0, 0.0, 0.0), 0.0)
        if filling is not None:
            ifcopenshell.api.feature.add_filling(self._ifc, opening=opening, element=filling)
            self._where[filling.id()] = (opening, (0.0, 0.0, 0.0), 0.0)

    def furniture_type(self, kind: str, name: str, items: Sequence[Item]) -> Entity:
        """Returns a piece of furniture that stands in many places; its solids are around its own origin."""
        described = ifcopenshell.api.root.create_entity(self._ifc, kind, name=name)
        if kind == "IfcFurnitureType":
            described.AssemblyPlace = "FACTORY"
        axes = self._ifc.create_entity("IfcAxis2Placement3D", self.shapes.point((0.0, 0.0, 0.0)), None, None)
        described.RepresentationMaps = [
            self._ifc.create_entity("IfcRepresentationMap", axes, self._representation(items))
        ]
        return described

    def place_furniture(self, described: Entity, kind: str, at: Point3, turn_deg: float, place: Entity) -> Entity:
        """Returns one piece of a type, at a point of the building, turned counter-clockwise seen from above."""
        product = ifcopenshell.api.root.create_entity(self._ifc, kind, name=described.Name)
        local = (at[0], at[1], at[2] - self._elevation[place.id()])
        self._where[product.id()] = (place, local, turn_deg)
        self._contained.setdefault(place.id(), []).append(product)
        self._typed.setdefault(described.id(), []).append(product)
        return product

    def properties(self, product: Entity, name: str, values: dict[str, Any]) -> None:
        """Gives an element a property set."""
        pset = ifcopenshell.api.pset.add_pset(self._ifc, product=product, name=name)
        ifcopenshell.api.pset.edit_pset(self._ifc, pset=pset, properties=values)

    def save(self, path: Path) -> None:
        """Writes the file; the same building gives the same bytes."""
        for type_id, products in self._typed.items():
            # One at a time: of several it makes the new entities in the order of a set, by where they lie in memory.
            for product in products:
                ifcopenshell.api.type.assign_type(
                    self._ifc, related_objects=[product], relating_type=self._ifc.by_id(type_id)
                )
        for place_id, products in self._contained.items():
            ifcopenshell.api.spatial.assign_container(
                self._ifc, products=products, relating_structure=self._ifc.by_id(place_id)
            )
        for storey_id, rooms in self._spaces.items():
            ifcopenshell.api.aggregate.assign_object(
                self._ifc, products=rooms, relating_object=self._ifc.by_id(storey_id)
            )
        self._place_everything()
        self._name_everything()
        self._order_everything()
        header = self._ifc.header
        header.file_description.description = ("ViewDefinition [DesignTransferView_V1.0]",)
        header.file_name.name = "sample.ifc"  # whatever the file is called, its content is the same
        header.file_name.time_stamp = _TIME
        header.file_name.author = ("The walkthrough planner's authors",)
        header.file_name.organization = ("",)
        header.file_name.preprocessor_version = "walk_bringup.sample"
        header.file_name.originating_system = "walk_bringup.sample"
        header.file_name.authorization = ""
        path.write_text(self._ifc.to_string(), encoding="ascii", newline="\n")

    def _place_everything(self) -> None:
        # Only now: the calls that relate elements rewrite placements, and drop points that others share.
        placed: dict[int, Entity] = {}

        def placement(product_id: int) -> Entity:
            if product_id not in placed:
                parent, at, turn = self._where[product_id]
                above = None if parent is None else placement(parent.id())
                placed[product_id] = self._placement(above, at, turn)
            return placed[product_id]

        for product_id in self._where:
            self._ifc.by_id(product_id).ObjectPlacement = placement(product_id)

    def _name_everything(self) -> None:
        # A GlobalId follows from class, name and count: random ones would make every file differ.
        count: Counter[str] = Counter()
        for root in sorted(self._ifc.by_type("IfcRoot"), key=lambda entity: int(entity.id())):
            key = f"{root.is_a()}/{root.Name or ''}"
            count[key] += 1
            root.GlobalId = ifcopenshell.guid.compress(uuid.uuid5(_NAMESPACE, f"{key}/{count[key]}").hex)

    def _order_everything(self) -> None:
        # The calls that relate elements keep them in sets, whose order follows from where they lie in memory.
        for kind, related in (
            ("IfcRelAggregates", "RelatedObjects"),
            ("IfcRelContainedInSpatialStructure", "RelatedElements"),
            ("IfcRelDefinesByType", "RelatedObjects"),
        ):
            for relation in self._ifc.by_type(kind):
                setattr(relation, related, sorted(getattr(relation, related), key=lambda entity: int(entity.id())))

    def _spatial(self, kind: str, name: str, whole: Entity, parent: Entity, elevation: float) -> Entity:
        entity = ifcopenshell.api.root.create_entity(self._ifc, kind, name=name)
        self._where[entity.id()] = (parent, (0.0, 0.0, elevation), 0.0)
        entity.CompositionType = "ELEMENT"
        if kind == "IfcBuildingStorey":
            entity.Elevation = elevation
        ifcopenshell.api.aggregate.assign_object(self._ifc, products=[entity], relating_object=whole)
        return entity

    def _placement(self, parent: Entity, at: Point3, turn_deg: float = 0.0) -> Entity:
        axis = ahead = None
        if turn_deg:
            turn = math.radians(turn_deg)
            axis = self.shapes.direction((0.0, 0.0, 1.0))
            ahead = self.shapes.direction((math.cos(turn), math.sin(turn), 0.0))
        axes = self._ifc.create_entity("IfcAxis2Placement3D", self.shapes.point(at), axis, ahead)
        return self._ifc.create_entity("IfcLocalPlacement", parent, axes)

    def _representation(self, items: Sequence[Item]) -> Entity:
        for colour, solid in items:
            if colour:
                self._ifc.create_entity("IfcStyledItem", solid, [self._styles[colour]], None)
        solids = [solid for _, solid in items]
        return self._ifc.create_entity("IfcShapeRepresentation", self._body, "Body", "SweptSolid", solids)

    def _style(self, name: str, rgba: tuple[float, float, float, float]) -> Entity:
        red, green, blue, transparency = rgba
        style = ifcopenshell.api.style.add_style(self._ifc, name=name)
        colour = {"Name": None, "Red": red, "Green": green, "Blue": blue}
        attributes = {"SurfaceColour": colour, "Transparency": transparency}
        ifcopenshell.api.style.add_surface_style(
            self._ifc, style=style, ifc_class="IfcSurfaceStyleShading", attributes=attributes
        )
        return style
