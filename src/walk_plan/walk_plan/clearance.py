# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The space beside a walker's body: what is under the feet and over the head does not count."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from walk_building.body import standing_clearances
from walk_building.building import Building
from walk_building.geometry import Geometry, as_points, in_chunks

LIMIT_M = 2.0
"""Space beyond this is not measured: it is said to be this much."""

_UPRIGHT = 0.5  # faces with a smaller upward share of their normal stand or lean: walls, furniture, railings
_STRETCH = 20.0  # heights count this much more than sideways distances: 10 cm over the head are as good as free


class SideClearance:
    """Measures the horizontal distance from the standing body to everything upright at the body's heights. Our own.

    The body's distance to all geometry would not tell it: the floor is never farther away than a step. Among
    stretched heights, whatever is not level with the body is far, so the nearest triangle is the nearest to the side.
    The body's rounded lower end counts from half its height: on a stair the next two steps are no obstacles.
    """

    def __init__(self, building: Building) -> None:
        self._walker = building.walker
        geometry = building.geometry
        upright = geometry.faces[_upward_share(geometry) < _UPRIGHT]
        stretched = np.ascontiguousarray(geometry.vertices * [1.0, 1.0, _STRETCH])
        self._geometry = Geometry(stretched, upright) if len(upright) else None

    def at(self, eyes: NDArray[np.float64]) -> NDArray[np.float64]:
        """Returns the space at each eye position (N, 3), (N,) from 0 to `LIMIT_M` [m]."""
        if self._geometry is None:
            return np.full(len(eyes), LIMIT_M)
        walker = self._walker
        feet = as_points("eyes", (eyes - [0.0, 0.0, walker.eye_height_m]) * [1.0, 1.0, _STRETCH])
        squared = np.empty(len(feet))
        limit = (0.0, (LIMIT_M + walker.radius_m) ** 2)
        in_chunks(
            standing_clearances, len(feet), self._geometry.bvh, feet, _STRETCH * (walker.step_m + walker.radius_m / 2),
            _STRETCH * walker.height_m, limit, squared,
        )  # fmt: skip
        return np.asarray(np.maximum(np.sqrt(squared) - walker.radius_m, 0.0))


def _upward_share(geometry: Geometry) -> NDArray[np.float64]:
    a, b, c = np.moveaxis(geometry.vertices[geometry.faces], 1, 0)
    normal = np.cross(b - a, c - a)
    return np.asarray(np.abs(normal[:, 2]) / np.maximum(np.linalg.norm(normal, axis=1), 1e-300))
