# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What the loader of one format hands over: the file's content in the file's own units and axes."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from walk_building.errors import ParameterError
from walk_building.model import LoadOptions
from walk_building.progress import Progress


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class RawMesh:
    """A named mesh in the file's units and axes: a part, a space or a door."""

    name: str
    kind: str
    vertices: NDArray[np.float64]  # (V, 3)
    faces: NDArray[np.int32]  # (F, 3)
    storey: str = ""
    long_name: str = ""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class RawModel:
    """A file's content before it is scaled, turned, moved near the origin and checked."""

    parts: tuple[RawMesh, ...]
    spaces: tuple[RawMesh, ...] = ()
    doors: tuple[RawMesh, ...] = ()
    storeys: tuple[tuple[str, float], ...] = ()  # name, elevation in the file's units
    units_m: float | None = None  # None: the format does not say
    up: str | None = None  # "x", "y" or "z"; None: the format does not say
    references: tuple[bytes, ...] = ()  # content of the other files that were read, in a fixed order
    warnings: tuple[str, ...] = ()


class PartFilter:
    """Decides by the `ignore` pattern which parts are left out, and remembers whether it hit anything."""

    def __init__(self, pattern: str) -> None:
        try:
            self._regex = re.compile(pattern) if pattern else None
        except re.error as error:
            raise ParameterError("ignore", pattern, f"a regular expression ({error})") from error
        self.pattern = pattern
        self.dropped = 0

    def drops(self, name: str, kind: str) -> bool:
        """Says whether the pattern finds the part's name or class, and counts it."""
        hit = self._regex is not None and bool(self._regex.search(name) or self._regex.search(kind))
        self.dropped += hit
        return hit


Loader = Callable[[Path, LoadOptions, PartFilter, Progress], RawModel]
"""Reads one format. Raises BuildingError for what it cannot read."""
