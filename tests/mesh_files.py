# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A hall of known sizes, and its files in every mesh format."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import trimesh

from walk_building.model import Model

# A hall of 8 x 5 x 3 m with thick walls, and a column of 0.5 m that stands 2 m and 1 m from a corner.
LOW, HIGH = np.array([-1.0, 2.0, -0.2]), np.array([7.0, 7.0, 2.8])
Y_UP_TO_Z_UP = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]], dtype=float)


def box(low: np.ndarray, high: np.ndarray) -> trimesh.Trimesh:
    return trimesh.creation.box(bounds=np.array([low, high], dtype=float))


def hall() -> trimesh.Scene:
    scene = trimesh.Scene()
    scene.add_geometry(box(LOW, [*HIGH[:2], 0.0]), node_name="floor", geom_name="floor")
    scene.add_geometry(box([LOW[0], LOW[1], 0], [LOW[0] + 0.2, HIGH[1], HIGH[2]]), node_name="wall", geom_name="wall")
    scene.add_geometry(box([1, 3, 0], [1.5, 3.5, 2.0]), node_name="column", geom_name="column")
    return scene


def write(scene: trimesh.Scene, path: Path, *, y_up: bool, scale: float = 1.0) -> Path:
    """Writes a z-up scene in metres, turned to y up and scaled where the format or the test wants it."""
    scene = scene.copy()
    turn = np.linalg.inv(Y_UP_TO_Z_UP) if y_up else np.eye(4)
    scene.apply_transform(np.diag([scale, scale, scale, 1.0]) @ turn)
    if path.suffix in (".ply", ".stl", ".dae"):
        scene.to_mesh().export(path)
    elif path.suffix == ".gltf":
        for name, data in trimesh.exchange.gltf.export_gltf(scene).items():
            (path.parent / (path.name if name == "model.gltf" else name)).write_bytes(data)
    else:
        scene.export(path)
    return path


def bounds(model: Model) -> np.ndarray:
    return np.array([model.vertices.min(axis=0), model.vertices.max(axis=0)])
