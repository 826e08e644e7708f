# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a COLLADA file says about its unit and its up axis, which the mesh engine does not apply."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path
from xml.etree import ElementTree

from walk_building.errors import BuildingError


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class ColladaAsset:
    """The file's own `<asset>`; the format's defaults are metres and y up."""

    units_m: float
    up: str


def read_asset(path: Path) -> ColladaAsset:
    """Returns the unit [m] and the up axis of a COLLADA file.

    Raises:
        BuildingError: The file is no XML or no COLLADA, or its unit is no length.
    """
    units_m, up = 1.0, "y"
    try:
        for _, element in ElementTree.iterparse(path):
            tag = element.tag.rpartition("}")[2]
            if tag == "unit":
                units_m = float(element.get("meter", "1"))
            elif tag == "up_axis":
                up = (element.text or "").strip().lower()[:1]
            elif tag == "asset":
                break
    except ElementTree.ParseError as error:
        raise BuildingError(path, f"is not a COLLADA file ({error})") from error
    except ValueError as error:
        raise BuildingError(path, f"its unit is no number ({error}); give it with --units") from error
    if up not in ("x", "y", "z"):
        up = "y"
    if not (math.isfinite(units_m) and units_m > 0.0):
        raise BuildingError(path, f"its unit is {units_m} m; give it with --units")
    return ColladaAsset(units_m=units_m, up=up)
