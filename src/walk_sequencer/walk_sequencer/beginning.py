# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Which keypoint a visitor comes to first. Our own: the source leaves the start free."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import dijkstra

from walk_building.building import Building

# Beyond this way from the entrance no keypoint counts as being at it, and the start is left free.
_NEAR_M = 30.0


def first_from_entrance(building: Building, eyes: NDArray[np.float64]) -> int:
    """Returns the row of `eyes` (M, 3) nearest on foot to the building's entrance, -1 where none is near."""
    if building.entrance < 0 or len(eyes) == 0:
        return -1
    surface = building.surface
    place = surface.nearest(eyes - [0.0, 0.0, building.walker.eye_height_m])
    way = dijkstra(surface.graph, directed=False, indices=building.entrance, limit=_NEAR_M)[place]
    first = int(np.argmin(way))
    return first if np.isfinite(way[first]) else -1
