# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The walkthrough as one binary glTF file: building, keypoints, path, and a camera that walks it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from walk_building.building import Building
from walk_plan.along import every
from walk_plan.gltf import GltfFile
from walk_plan.resample import PoseSamples, resample
from walk_plan.shapes import sphere, tube
from walk_plan.walkthrough import Walkthrough

KEYFRAME_STEP_S = 0.1
"""Longest time between two keyframes of the camera [s]."""

TUBE_RADIUS_M, TUBE_SPACING_M = 0.025, 0.15
SPHERE_RADIUS_M = 0.12

_FIELD_OF_VIEW_RAD = 1.2  # upright, about what a wide camera of a phone sees
_COLOURS = {"building": (0.82, 0.82, 0.80, 1.0), "path": (0.84, 0.37, 0.0, 1.0), "keypoints": (0.0, 0.35, 0.65, 1.0)}

# glTF is y-up: (x, y, z) of the map becomes (x, z, -y).
_MAP_TO_GLTF = Rotation.from_matrix([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
# A glTF camera looks along its -z with +y up; the walker's eye looks along its +x with +z up.
_CAMERA_IN_EYE = Rotation.from_matrix([[0, 0, -1], [-1, 0, 0], [0, 1, 0]])


def to_gltf(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns map positions (N, 3), z up, in glTF's axes, y up."""
    return np.column_stack([points[:, 0], points[:, 2], -points[:, 1]])


def camera_quat_xyzw(quat_xyzw: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the rotations (N, 4) of a glTF camera that looks where eyes of the given orientations look."""
    return np.asarray((_MAP_TO_GLTF * Rotation.from_quat(quat_xyzw) * _CAMERA_IN_EYE).as_quat())


def write_glb(path: Path, walkthrough: Walkthrough) -> None:
    """Writes building, keypoints, path tube and an animated camera as binary glTF, y up, in metres.

    Positions are near the origin, as single precision needs it; the scene's extras hold the offset that leads to
    the building file's own coordinates, z up.
    """
    building = walkthrough.building
    file = GltfFile()
    file.extras = {"building": building.model.source.name, "hash": building.hash,
                   "offset_m_z_up": [float(x) for x in building.model.offset_m]}  # fmt: skip
    _add_building(file, building)
    colour = file.material("Path", _COLOURS["path"])
    vertices, faces = tube(every(walkthrough.path.points, TUBE_SPACING_M), TUBE_RADIUS_M)
    file.node("Path", mesh=file.mesh("Path", to_gltf(vertices), faces, colour))
    colour = file.material("Keypoints", _COLOURS["keypoints"])
    ball = file.mesh("Keypoint", *sphere(SPHERE_RADIUS_M), colour)
    for number, position in enumerate(to_gltf(walkthrough.keypoints), start=1):
        file.node(f"Keypoint {number}", mesh=ball, translation=position)
    _add_camera(file, resample(walkthrough.trajectory, KEYFRAME_STEP_S))
    path.write_bytes(file.to_bytes())


def _add_building(file: GltfFile, building: Building) -> None:
    """Adds one mesh for each kind of part, so that a viewer can hide the ceilings and look in."""
    colour = file.material("Building", _COLOURS["building"])
    positions = file.positions(to_gltf(building.geometry.vertices))
    kinds: dict[str, list[NDArray[np.int64]]] = {}
    for part in building.model.parts:
        kinds.setdefault(part.kind, []).append(np.arange(part.first_face, part.first_face + part.n_faces))
    for kind, faces in sorted(kinds.items()):
        triangles = building.geometry.faces[np.concatenate(faces)]
        if len(triangles):
            name = kind.removeprefix("Ifc") if kind != "mesh" else "Building"
            file.node(name, mesh=file.mesh(name, positions, triangles, colour))


def _add_camera(file: GltfFile, samples: PoseSamples) -> None:
    positions = to_gltf(samples.positions)
    turns = camera_quat_xyzw(samples.quat_xyzw)
    camera = file.camera("Walker's eye", _FIELD_OF_VIEW_RAD)
    node = file.node("Walker's eye", camera=camera, translation=positions[0], rotation=turns[0])
    file.animation("Walk", node, samples.t_s - samples.t_s[0], positions, turns)
