# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""IFC by ifcopenshell; the only file that imports it for reading."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from walk_building.errors import BuildingError
from walk_building.loaders.ifc_header import read_step
from walk_building.loaders.ifc_probe import check_survives
from walk_building.loaders.raw import PartFilter, RawMesh, RawModel
from walk_building.model import LoadOptions
from walk_building.progress import Progress

# Solids that are cut out of or added to others, and drawings: nothing a walker can touch.
_NO_GEOMETRY = (
    "IfcFeatureElement",
    "IfcVirtualElement",
    "IfcAnnotation",
    "IfcGrid",
    "IfcPort",
    "IfcStructuralActivity",
    "IfcStructuralItem",
    "IfcSpatialZone",
    "IfcExternalSpatialElement",
)
_THREADS = 2
# Warnings name this many products and count the others.
_NAMED = 3


def load_ifc(path: Path, options: LoadOptions, part_filter: PartFilter, progress: Progress) -> RawModel:
    """Returns the products of an IFC file, its spaces, its doors (which stand open) and its storeys.

    Raises:
        BuildingError: The file is not IFC, is cut short, or is of a schema the engine does not know.
    """
    text = _text(path)
    try:
        file, dangling = _parse(text)
        if dangling:
            check_survives(path)
        raw = _content(file, options, part_filter, progress)
    except BuildingError:
        raise
    except Exception as error:  # the engine's errors share no base, and in a damaged file any attribute may be any type
        raise BuildingError(path, f"is damaged and cannot be read as IFC ({error})") from error
    if dangling:
        raw = dataclasses.replace(raw, warnings=(*raw.warnings, "The file names instances that are not in it."))
    return raw


def tessellates(path: str) -> bool:
    """Says that the engine got through all products of the file; what it crashes on, never returns."""
    file, _ = _parse(_text(Path(path)))
    return all(True for _ in _shapes(file, list(_with_shape(file, LoadOptions()))))


def _text(path: Path) -> str:
    import ifcopenshell  # half a second of imports that a mesh file does not need

    known = {str(name).upper() for name in ifcopenshell.ifcopenshell_wrapper.schema_names()}
    return read_step(path, {name for name in known if name.startswith("IFC")})


def _parse(text: str) -> tuple[Any, bool]:
    """Returns the file, and whether instances refer to others that are not there."""
    import ifcopenshell

    ifcopenshell.get_log()  # reading the log empties it
    file = ifcopenshell.file.from_string(text)
    return file, "Instance reference" in ifcopenshell.get_log()


def _content(file: Any, options: LoadOptions, part_filter: PartFilter, progress: Progress) -> RawModel:
    unit_m = _length_unit(file)
    products = [product for product in _with_shape(file, options) if not _ignored(product, part_filter)]
    meshes = _tessellate(file, products, unit_m or 1.0, progress)
    spaces, parts = [], []
    leaves: dict[int, list[RawMesh]] = {}
    for product in products:
        mesh = meshes.get(product.id())
        if mesh is None:
            continue
        door = _door_of(product)
        if door is not None:
            leaves.setdefault(door.id(), []).append(mesh)
        elif product.is_a("IfcSpace"):
            spaces.append(mesh)
        else:
            parts.append(mesh)
    return RawModel(
        parts=tuple(parts),
        spaces=tuple(spaces),
        doors=tuple(_whole_door(file.by_id(door), pieces) for door, pieces in leaves.items()),
        storeys=_storeys(file),
        units_m=unit_m,
        up="z",
        warnings=tuple(_lost(products, meshes)),
    )


def _length_unit(file: Any) -> float | None:
    """Returns the file's unit [m], or None where it declares none (the engine then takes metres)."""
    import ifcopenshell.util.unit

    units = [unit for assignment in file.by_type("IfcUnitAssignment") for unit in assignment.Units]
    if not any(getattr(unit, "UnitType", None) == "LENGTHUNIT" for unit in units):
        return None
    scale = float(ifcopenshell.util.unit.calculate_unit_scale(file))
    if not (math.isfinite(scale) and scale > 0.0):
        raise ValueError(f"its length unit is {scale} m")
    return scale


def _with_shape(file: Any, options: LoadOptions) -> Iterator[Any]:
    """Yields the products that may be walls, floors, doors or spaces, in the order of the file."""
    without = _NO_GEOMETRY if options.furniture else (*_NO_GEOMETRY, "IfcFurnishingElement")
    for product in file.by_type("IfcProduct"):
        if product.Representation is not None and not _is_any(product, without):
            yield product


def _is_any(product: Any, classes: Iterable[str]) -> bool:
    # A class the schema does not have is simply not the product's.
    return any(product.is_a(name) for name in classes)


def _ignored(product: Any, part_filter: PartFilter) -> bool:
    return part_filter.drops(_name(product), product.is_a())


def _name(product: Any) -> str:
    return str(product.Name or f"{product.is_a()} #{product.id()}")


def _tessellate(file: Any, products: list[Any], unit_m: float, progress: Progress) -> dict[int, RawMesh]:
    """Returns each product's mesh in the file's unit by its id; what the engine cannot tessellate is missing."""
    meshes = {}
    for shape, share_done in _shapes(file, products):
        geometry = shape.geometry
        # The placement is applied here, in double precision, so that far coordinates keep their millimetres.
        placement = np.array(shape.transformation.matrix, dtype=np.float64).reshape(4, 4, order="F")
        local = np.frombuffer(geometry.verts_buffer, dtype=np.float64).reshape(-1, 3)
        product = file.by_id(shape.id)
        meshes[product.id()] = RawMesh(
            name=_name(product),
            long_name=str(getattr(product, "LongName", None) or ""),
            kind=product.is_a(),
            storey=_storey_name(product),
            vertices=(local @ placement[:3, :3].T + placement[:3, 3]) / unit_m,
            faces=np.frombuffer(geometry.faces_buffer, dtype=np.int32).reshape(-1, 3).copy(),
        )
        progress("load", share_done)
    return {key: mesh for key, mesh in meshes.items() if len(mesh.faces)}


def _shapes(file: Any, products: list[Any]) -> Iterator[tuple[Any, float]]:
    """Yields the engine's shapes, in metres relative to their placements, and the share of them done."""
    import ifcopenshell.geom

    if not products:
        return
    settings = ifcopenshell.geom.settings()
    settings.set("no-normals", True)
    settings.set("apply-default-materials", False)
    iterator = ifcopenshell.geom.iterator(settings, file, _THREADS, include=products)
    more = iterator.initialize()
    while more:
        yield iterator.get(), iterator.progress() / 100.0
        more = iterator.next()


def _parent(product: Any) -> Any | None:
    """Returns what holds the product: the container, the whole, or the wall its opening is cut into."""
    for relations, attribute in (
        ("ContainedInStructure", "RelatingStructure"),
        ("Decomposes", "RelatingObject"),
        ("Nests", "RelatingObject"),
        ("FillsVoids", "RelatingOpeningElement"),
        ("VoidsElements", "RelatingBuildingElement"),
    ):
        for relation in getattr(product, relations, None) or ():
            parent = getattr(relation, attribute, None)
            if parent is not None:
                return parent
    return None


def _ancestors(product: Any) -> Iterator[Any]:
    """Yields the product and what holds it, up to the project; a file may be circular, hence the limit."""
    for _ in range(32):
        if product is None:
            return
        yield product
        product = _parent(product)


def _storey_name(product: Any) -> str:
    for ancestor in _ancestors(product):
        if ancestor.is_a("IfcBuildingStorey"):
            return str(ancestor.Name or "")
    return ""


def _door_of(product: Any) -> Any | None:
    """Returns the door that the product is or is a piece of (leaf, frame, panel)."""
    return next((ancestor for ancestor in _ancestors(product) if ancestor.is_a("IfcDoor")), None)


def _whole_door(door: Any, pieces: list[RawMesh]) -> RawMesh:
    """Returns the door with the vertices of all its pieces; its faces matter to nobody."""
    return RawMesh(
        name=_name(door),
        kind=door.is_a(),
        storey=_storey_name(door),
        vertices=np.concatenate([piece.vertices for piece in pieces]),
        faces=np.empty((0, 3), dtype=np.int32),
    )


def _storeys(file: Any) -> tuple[tuple[str, float], ...]:
    """Returns names and elevations, in the file's unit, of the storeys as placed.

    The placement is where the geometry is; the attribute `Elevation` is used where all placements agree although
    the elevations do not, which some exporters write.
    """
    import ifcopenshell.util.placement

    storeys = file.by_type("IfcBuildingStorey")
    placed = [
        float(ifcopenshell.util.placement.get_local_placement(storey.ObjectPlacement)[2, 3])
        if storey.ObjectPlacement is not None
        else 0.0
        for storey in storeys
    ]
    declared = [float(storey.Elevation or 0.0) for storey in storeys]
    if len(set(placed)) <= 1 < len(set(declared)):
        placed = [z + elevation for z, elevation in zip(placed, declared, strict=True)]
    return tuple((str(storey.Name or ""), z) for storey, z in zip(storeys, placed, strict=True))


def _lost(products: list[Any], meshes: dict[int, RawMesh]) -> list[str]:
    """Returns a warning that names the products whose body the engine could not turn into triangles."""
    lost = [_name(product) for product in products if product.id() not in meshes and _has_body(product)]
    if not lost:
        return []
    named = ", ".join(repr(name) for name in lost[:_NAMED])
    others = f" and {len(lost) - _NAMED} more" if len(lost) > _NAMED else ""
    return [f"The geometry of {named}{others} could not be read and is left out."]


def _has_body(product: Any) -> bool:
    return any(shape.RepresentationIdentifier == "Body" for shape in product.Representation.Representations)
