# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a loader returns: triangles in metres, z up, and whatever the file says about them."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from walk_building.config import Config, param


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class LoadOptions(Config):
    """How to read a building file; the defaults ask the file itself."""

    units_m: float = param(
        0.0, "length of one unit of the file in metres; 0 takes what the file says", unit="m", low=0.0, high=1e4
    )
    up: str = param("auto", "the axis that points up in the file", choices=("auto", "y", "z"))
    ignore: str = param("", "regular expression; parts whose name or class it finds are left out")
    doors: str = param(
        r"(?i)^(?!.*(frame|way|mat|bell|stop|lintel|handle|knob|rahmen|zarge|griff))"
        r".*((?<!in)(?<!out)door|t(ü|ue)re?(?![a-z])|(?<![a-z])porte|puerta|(?<!gran)deur)",
        "regular expression; in a file without doors by class, parts of a door's size whose name it finds are doors "
        "and stand open; empty for none",
    )
    furniture: bool = param(True, "keep furniture as obstacles")
    outdoors: bool = param(False, "let the walker out of the building and onto its roofs")


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """A named piece of the building; its triangles are `faces[first_face:first_face + n_faces]`."""

    name: str
    kind: str  # IFC class such as "IfcWall", or "mesh" where the file has no classes
    first_face: int
    n_faces: int


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Space:
    """A room as the file declares it: a closed mesh that is no obstacle."""

    name: str  # its number, such as "A102"
    long_name: str = ""  # what it is for, such as "Living Room"
    storey: str
    vertices: NDArray[np.float64]  # (V, 3) [m]
    faces: NDArray[np.int32]  # (F, 3)

    @property
    def label(self) -> str:
        """What a person would call it: what it is for, and its number."""
        return f"{self.long_name} {self.name}".strip() or "unnamed space"


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Door:
    """A door by its class or, in files without classes, by its name; it stands open, so its leaf is no obstacle."""

    name: str
    storey: str
    centre: NDArray[np.float64]  # (3,) middle of the bounding box [m]
    size: NDArray[np.float64]  # (3,) of the bounding box [m]


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Storey:
    """A level of the building."""

    name: str
    elevation_m: float  # of its floor, in the model's coordinates


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Model:
    """A building file as triangles in metres, z up, near the origin. Arrays are read-only.

    A point of the file's own coordinates, in metres and z up, is `offset_m + p` for a point `p` of the model.
    """

    source: Path
    content_hash: str  # sha256 of the file and the load options, hex
    vertices: NDArray[np.float64]  # (V, 3) [m]
    faces: NDArray[np.int32]  # (F, 3)
    parts: tuple[Part, ...]
    spaces: tuple[Space, ...]
    doors: tuple[Door, ...]
    storeys: tuple[Storey, ...]  # as declared, lowest first; empty where the format has none
    offset_m: NDArray[np.float64]  # (3,)
    units_m: float  # what one unit of the file was taken to be
    warnings: tuple[str, ...]  # sentences for the user: assumed units, suspected axes, dropped parts …
