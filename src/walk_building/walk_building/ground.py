# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What is known of a building's floor before it is divided into parts and rooms."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from walk_building.geometry import Geometry
from walk_building.model import Model, Storey
from walk_building.raster import Columns, Hits


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Ground:
    """The places where a walker can stand, and what is around them. P places, E directed neighbour pairs."""

    model: Model
    geometry: Geometry
    columns: Columns
    hits: Hits  # what the columns' lines meet
    storeys: tuple[Storey, ...]
    places: NDArray[np.float64]  # (P, 3) [m]
    column: NDArray[np.int64]  # (P,) flat column index
    indptr: NDArray[np.int64]  # (P + 1,)
    neighbours: NDArray[np.int32]  # (E,)
    clearance_m: NDArray[np.float64]  # (P,) horizontal distance to where standing ends
    space: NDArray[np.int32]  # (P,) index of the declared space, -1 for none
    step_m: float
