# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of the building from inside, drawn without a display and without a graphics card."""

from __future__ import annotations

from collections.abc import Iterator
from types import TracebackType
from typing import Self

import numpy as np
import pyvista
from numpy.typing import NDArray
from vtkmodules.vtkCommonCore import vtkLogger

from walk_bag.exports.axes import ahead
from walk_bag.exports.glb import kinds
from walk_bag.exports.ride import ExportConfig
from walk_building.model import Model

# By what the name of a kind begins with; the first that fits.
_COLOURS = (
    ("Wall", (0.91, 0.90, 0.87)),
    ("Slab", (0.70, 0.66, 0.60)),
    ("Covering", (0.86, 0.85, 0.82)),
    ("Roof", (0.72, 0.58, 0.50)),
    ("Stair", (0.62, 0.60, 0.58)),
    ("Ramp", (0.62, 0.60, 0.58)),
    ("Railing", (0.45, 0.47, 0.50)),
    ("Column", (0.78, 0.77, 0.75)),
    ("Beam", (0.62, 0.50, 0.38)),
    ("Door", (0.60, 0.44, 0.30)),
    ("Window", (0.62, 0.76, 0.84)),
    ("CurtainWall", (0.62, 0.76, 0.84)),
    ("Plate", (0.62, 0.76, 0.84)),
    ("Furni", (0.66, 0.50, 0.36)),
    ("Sanitary", (0.93, 0.94, 0.95)),
)
_OTHER = (0.80, 0.79, 0.76)
_GLASS = ("Window", "CurtainWall", "Plate")
_SKY_LOW, _SKY_HIGH = (0.93, 0.95, 0.97), (0.60, 0.74, 0.88)
# Corners sharper than this are drawn as lines, which tell walls of one colour apart.
_EDGE_DEG = 35.0
_NEAR_M = 0.05


class Renderer:
    """Draws a building as an eye in it sees it; a context manager."""

    def __init__(self, model: Model, config: ExportConfig) -> None:
        """Sets the scene up; the first picture takes longer than the others."""
        # The libraries look for a display first and complain to stderr that there is none, before they do without.
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
        size = (config.width, config.height)
        self._plotter = pyvista.Plotter(off_screen=True, window_size=size, lighting="none")
        self._plotter.set_background(_SKY_LOW, top=_SKY_HIGH)
        self._plotter.add_light(pyvista.Light(light_type="headlight", intensity=0.62))
        for direction, intensity in (((0.4, 0.3, 1.0), 0.34), ((-0.5, -0.8, 0.3), 0.22), ((0.2, 0.1, -1.0), 0.5)):
            self._plotter.add_light(pyvista.Light(position=direction, light_type="scene light", intensity=intensity))
        for name, triangles in kinds(model):
            self._add(name, model.vertices, triangles)
        camera = self._plotter.camera
        camera.view_angle = float(np.rad2deg(config.field_of_view_rad))
        self._far_m = max(10.0, 2.0 * float(np.linalg.norm(np.ptp(model.vertices, axis=0))))

    def _add(self, name: str, vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> None:
        used, index = np.unique(triangles, return_inverse=True)
        mesh = pyvista.PolyData.from_regular_faces(vertices[used], index.reshape(-1, 3)).clean()
        colour = next((rgb for start, rgb in _COLOURS if name.startswith(start)), _OTHER)
        glass = name.startswith(_GLASS)
        self._plotter.add_mesh(mesh, color=colour, opacity=0.35 if glass else 1.0, ambient=0.18, specular=0.0)
        edges = mesh.extract_feature_edges(_EDGE_DEG, non_manifold_edges=False, manifold_edges=False)
        if edges.n_cells:
            self._plotter.add_mesh(edges, color=(0.25, 0.25, 0.27), line_width=1.0, lighting=False)

    def pictures(self, positions: NDArray[np.float64], quat_xyzw: NDArray[np.float64]) -> Iterator[NDArray[np.uint8]]:
        """Yields a picture (height, width, 3) for each eye position (n, 3) and orientation (n, 4)."""
        camera = self._plotter.camera
        for position, look in zip(positions, ahead(quat_xyzw), strict=True):
            camera.position = tuple(position)
            camera.focal_point = tuple(position + look)
            camera.up = (0.0, 0.0, 1.0)
            camera.clipping_range = (_NEAR_M, self._far_m)
            self._plotter.render()
            yield np.asarray(self._plotter.screenshot(return_img=True))

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._plotter.close()
