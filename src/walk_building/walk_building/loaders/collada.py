# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a COLLADA file says about unit, up axis and names, which the mesh engine does not apply."""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Mapping
from pathlib import Path
from xml.etree import ElementTree

from walk_building.errors import BuildingError

# As C libraries print them: nan, inf, 1.#IND, 1.#QNAN.
_NOT_FINITE = re.compile(r"nan|inf|#", re.IGNORECASE)


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class ColladaFacts:
    """The file's `<asset>`, by default in metres and y up, and readable names of its geometries."""

    units_m: float
    up: str  # "x", "y" or "z"
    names: Mapping[str, str]  # geometry id -> its name, or the name of the node that places it


def read_collada(path: Path) -> ColladaFacts:
    """Returns what a COLLADA file says about itself.

    Raises:
        BuildingError: The file is no XML or no COLLADA, has no scene, or its unit is no length.
    """
    try:
        root = ElementTree.parse(path).getroot()
    except (ElementTree.ParseError, LookupError, ValueError) as error:
        raise BuildingError(path, f"is not a COLLADA file ({error})") from error
    if _tag(root) != "COLLADA":
        raise BuildingError(path, f"is not a COLLADA file (its root is <{_tag(root)}>)")
    if root.find("{*}scene") is None:
        raise BuildingError(path, "has no <scene>, so nothing in it is placed; export it again")
    _check_positions(root, path)
    up = (root.findtext("{*}asset/{*}up_axis") or "Y_UP").strip().lower()[:1]
    return ColladaFacts(units_m=_unit_m(root, path), up=up if up in ("x", "y", "z") else "y", names=_names(root))


def _unit_m(root: ElementTree.Element, path: Path) -> float:
    unit = root.find("{*}asset/{*}unit")
    text = "1" if unit is None else unit.get("meter", "1")
    try:
        units_m = float(text)
    except ValueError:
        units_m = math.nan
    if not (math.isfinite(units_m) and units_m > 0.0):
        raise BuildingError(path, f"its unit is {text!r} metres, which is no length; correct its <unit meter=…>")
    return units_m


def _check_positions(root: ElementTree.Element, path: Path) -> None:
    """Refuses positions that are no finite numbers: the engine would put those vertices at the origin."""
    keys = {use.get("source") for use in root.iterfind(".//{*}vertices/{*}input[@semantic='POSITION']")}
    for source in root.iterfind(".//{*}mesh/{*}source"):
        if f"#{source.get('id')}" in keys and _NOT_FINITE.search(source.findtext("{*}float_array") or ""):
            raise BuildingError(path, f"positions in {source.get('id')!r} are no finite numbers; export it again")


def _names(root: ElementTree.Element) -> dict[str, str]:
    names: dict[str, str] = {}
    for node in root.iter():
        if _tag(node) == "node":
            for instance in node.findall("{*}instance_geometry"):
                key = instance.get("url", "").removeprefix("#")
                names.setdefault(key, node.get("name") or node.get("id") or key)
    for geometry in root.iterfind("{*}library_geometries/{*}geometry"):
        if geometry.get("name"):
            names[geometry.get("id", "")] = geometry.get("name", "")
    return names


def _tag(element: ElementTree.Element) -> str:
    return element.tag.rpartition("}")[2] if isinstance(element.tag, str) else ""
