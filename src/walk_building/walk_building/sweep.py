# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The guarantee: the walker's body swept along a path against the exact geometry, by python-fcl.

The body is a vertical capsule that hangs from the eye and does not turn, so while the eye moves a distance d no
point of the body moves farther than d. A body that is c away from the geometry can therefore move on by c without
touching it (`mirtich1996`, conservative advancement without rotation).
"""

from __future__ import annotations

import fcl
import numpy as np
from numpy.typing import ArrayLike, NDArray

from walk_building.geometry import Geometry, as_points
from walk_building.walker import Walker

# What counts as touching. Paths hug no wall this closely on purpose; it is far above the rounding of the distances.
CONTACT_M = 1e-4
# The distances of fcl are exact to about 1e-6; advancing by a little less keeps the sweep on the safe side.
_ADVANCE_SHARE = 0.999


class BodySweep:
    """Sweeps a walker's body through a geometry. Not safe to share between threads."""

    def __init__(self, geometry: Geometry, walker: Walker) -> None:
        mesh = fcl.BVHModel()
        mesh.beginModel(len(geometry.vertices), len(geometry.faces))
        mesh.addSubModel(geometry.vertices, geometry.faces)
        mesh.endModel()
        self._mesh = fcl.CollisionObject(mesh)
        # fcl's capsule is centred on its axis; lz is the length of the axis, without the caps.
        length = walker.axis_high_m - walker.axis_low_m
        self._body = fcl.CollisionObject(fcl.Capsule(walker.radius_m, length))
        self._eye_to_centre = np.array([0.0, 0.0, 0.5 * (walker.axis_low_m + walker.axis_high_m) - walker.eye_height_m])
        # fcl's answer is not to be trusted where shapes meet, so what touches is asked for separately.
        self._distance = fcl.DistanceRequest()
        self._collision = fcl.CollisionRequest()

    def standing_clearance(self, eyes: ArrayLike) -> NDArray[np.float64]:
        """Returns the distance from the body to the geometry for each eye position (N, 3) [m]; 0 where they meet."""
        return np.array([self._clearance(eye) for eye in as_points("eyes", eyes)])

    def segments_free(self, path: ArrayLike) -> NDArray[np.bool_]:
        """Returns for each segment of an eye path (n, 3) whether the body passes along it: (n - 1,)."""
        eyes = as_points("path", path)
        if len(eyes) < 2:
            return np.zeros(0, bool)
        free = np.zeros(len(eyes) - 1, bool)
        ahead = self._clearance(eyes[0])
        for i in range(len(eyes) - 1):
            behind, ahead = ahead, self._clearance(eyes[i + 1])
            free[i] = self._passes(eyes[i], eyes[i + 1], behind, ahead)
        return free

    def _clearance(self, eye: NDArray[np.float64]) -> float:
        self._body.setTranslation(eye + self._eye_to_centre)
        if fcl.collide(self._body, self._mesh, self._collision, fcl.CollisionResult()):
            return 0.0
        return max(float(fcl.distance(self._body, self._mesh, self._distance, fcl.DistanceResult())), 0.0)

    def _passes(self, start: NDArray[np.float64], end: NDArray[np.float64], behind: float, ahead: float) -> bool:
        """Whether the body passes from start to end, given its clearance at both."""
        if behind <= CONTACT_M or ahead <= CONTACT_M:
            return False
        length = float(np.linalg.norm(end - start))
        last = length - _ADVANCE_SHARE * ahead  # from here on the clearance at the end is enough
        at = _ADVANCE_SHARE * behind
        while at < last:
            clearance = self._clearance(start + (end - start) * (at / length))
            if clearance <= CONTACT_M:
                return False
            at += _ADVANCE_SHARE * clearance
        return True
