# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The walk as one binary glTF file: building, keypoints, path, and a camera that walks it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from walk_bag.exports.axes import camera_quat_xyzw, to_gltf
from walk_bag.exports.gltf_file import GltfFile
from walk_bag.exports.resample import PoseSamples, resample
from walk_bag.exports.ride import ExportConfig, Ride
from walk_bag.exports.shapes import sphere, tube
from walk_building.model import Model
from walk_building.progress import Progress, no_progress

KEYFRAME_STEP_S = 0.1
"""Longest time between two keyframes of the camera [s]."""

TUBE_RADIUS_M, TUBE_SPACING_M = 0.025, 0.15
SPHERE_RADIUS_M = 0.12

_COLOURS = {"building": (0.82, 0.82, 0.80, 1.0), "path": (0.84, 0.37, 0.0, 1.0), "keypoints": (0.0, 0.35, 0.65, 1.0)}


def write_glb(path: Path, ride: Ride, config: ExportConfig | None = None, progress: Progress = no_progress) -> None:
    """Writes building, keypoints, path tube and an animated camera as binary glTF, y up, in metres.

    Positions are near the origin, as single precision needs it; the scene's extras hold the offset that leads to
    the building file's own coordinates, z up. The building is left out where it is not known.
    """
    file = GltfFile()
    file.extras = {"building": ride.building_name, "hash": ride.building_hash,
                   "offset_m_z_up": [float(x) for x in ride.offset_m]}  # fmt: skip
    if ride.model is not None:
        _add_building(file, ride.model)
    colour = file.material("Path", _COLOURS["path"])
    line = _spaced(ride.positions)
    if len(line) > 1:
        vertices, faces = tube(line, TUBE_RADIUS_M)
        file.node("Path", mesh=file.mesh("Path", to_gltf(vertices), faces, colour))
    if len(ride.keypoints):
        colour = file.material("Keypoints", _COLOURS["keypoints"])
        ball = file.mesh("Keypoint", *sphere(SPHERE_RADIUS_M), colour)
        for number, position in enumerate(to_gltf(ride.keypoints), start=1):
            file.node(f"Keypoint {number}", mesh=ball, translation=position)
    _add_camera(file, resample(ride, KEYFRAME_STEP_S), (config or ExportConfig()).field_of_view_rad)
    path.write_bytes(file.to_bytes())
    progress("write", 1.0)


def _spaced(positions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the path at even spacing along it, ends included; one point where nobody moves."""
    walked = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(positions, axis=0), axis=1))])
    if walked[-1] < TUBE_RADIUS_M:
        return positions[:1]
    where = np.linspace(0.0, walked[-1], int(np.ceil(walked[-1] / TUBE_SPACING_M)) + 1)
    return np.column_stack([np.interp(where, walked, positions[:, i]) for i in range(3)])


def _add_building(file: GltfFile, model: Model) -> None:
    """Adds one mesh for each kind of part, so that a viewer can hide the ceilings and look in."""
    colour = file.material("Building", _COLOURS["building"])
    positions = file.positions(to_gltf(model.vertices))
    for name, triangles in kinds(model):
        file.node(name, mesh=file.mesh(name, positions, triangles, colour))


def kinds(model: Model) -> list[tuple[str, NDArray[np.int32]]]:
    """Returns the name and the triangles (F, 3) of each kind of part: Wall, Slab …; Building where there is none."""
    faces: dict[str, list[NDArray[np.int64]]] = {}
    for part in model.parts:
        faces.setdefault(part.kind, []).append(np.arange(part.first_face, part.first_face + part.n_faces))
    found = []
    for kind, indices in sorted(faces.items()):
        triangles = model.faces[np.concatenate(indices)]
        if len(triangles):
            found.append((kind.removeprefix("Ifc") if kind != "mesh" else "Building", triangles))
    return found


def _add_camera(file: GltfFile, samples: PoseSamples, field_of_view_rad: float) -> None:
    positions = to_gltf(samples.positions)
    turns = camera_quat_xyzw(samples.quat_xyzw)
    camera = file.camera("Walker's eye", field_of_view_rad)
    node = file.node("Walker's eye", camera=camera, translation=positions[0], rotation=turns[0])
    file.animation("Walk", node, samples.t_s - samples.t_s[0], positions, turns)
