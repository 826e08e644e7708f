# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From the map's axes, z up and the eye's x axis ahead, to those of other programs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

# glTF is y-up: (x, y, z) of the map becomes (x, z, -y).
_MAP_TO_GLTF = Rotation.from_matrix([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
# A camera of glTF, USD or Blender looks along its -z with +y up; the walker's eye looks along its +x with +z up.
_CAMERA_IN_EYE = Rotation.from_matrix([[0, 0, -1], [-1, 0, 0], [0, 1, 0]])


def to_gltf(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns map positions (N, 3), z up, in glTF's axes, y up."""
    return np.column_stack([points[:, 0], points[:, 2], -points[:, 1]])


def camera_quat_xyzw(quat_xyzw: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the rotations (N, 4) of a glTF camera, y up, that looks where eyes of the given orientations look."""
    return np.asarray((_MAP_TO_GLTF * Rotation.from_quat(quat_xyzw) * _CAMERA_IN_EYE).as_quat())


def z_up_camera_quat_xyzw(quat_xyzw: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the rotations (N, 4) of a camera that looks along its -z, in a scene that is z up as the map is."""
    return np.asarray((Rotation.from_quat(quat_xyzw) * _CAMERA_IN_EYE).as_quat())


def ahead(quat_xyzw: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the unit vectors (N, 3) along which eyes of the given orientations look."""
    return np.asarray(Rotation.from_quat(quat_xyzw).apply([1.0, 0.0, 0.0]))
