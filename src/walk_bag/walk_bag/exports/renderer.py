# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of the building from inside, drawn without a display and without a graphics card."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from types import TracebackType
from typing import Self

import numpy as np
import pyvista
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLogger, vtkUnsignedCharArray

from walk_bag.exports.axes import ahead
from walk_bag.exports.glb import kinds
from walk_bag.exports.look import GLASS_OPACITY, SKY_HIGH, SKY_LOW, Coloured, coloured
from walk_bag.exports.ride import ExportConfig
from walk_building.model import Model

# Corners sharper than this are drawn as lines, which tell walls of one colour apart.
_EDGE_DEG = 35.0
_EDGE_COLOUR = (0.25, 0.25, 0.27)
_NEAR_M = 0.05


class Renderer:
    """Draws a building as an eye in it sees it; a context manager.

    The scene is three bodies (what is solid, what is glass, the edges) that do not change; between two pictures only
    the camera moves, and each is drawn once and read from where it was drawn.
    """

    def __init__(self, model: Model, config: ExportConfig) -> None:
        """Sets the scene up; the first picture takes longer than the others."""
        self._size = (config.width, config.height)
        with _without_a_display():
            self._plotter = pyvista.Plotter(off_screen=True, window_size=self._size, lighting="none")
        self._window = self._plotter.render_window
        self._window.SetMultiSamples(config.samples if config.samples > 1 else 0)
        self._plotter.set_background(SKY_LOW, top=SKY_HIGH)
        solid, glass = coloured(model)
        self._add(solid, 1.0)
        self._add(glass, GLASS_OPACITY)
        self._add_edges(model)
        self._plotter.camera.view_angle = float(np.rad2deg(config.field_of_view_rad))
        self._far_m = max(10.0, 2.0 * float(np.linalg.norm(np.ptp(model.vertices, axis=0))))
        self._pixels = vtkUnsignedCharArray()

    def _add(self, body: Coloured, opacity: float) -> None:
        if len(body.corners):
            mesh = pyvista.PolyData.from_regular_faces(body.corners, np.arange(len(body.corners)).reshape(-1, 3))
            mesh["rgb"] = body.rgb
            self._plotter.add_mesh(mesh, scalars="rgb", rgb=True, opacity=opacity, lighting=False)

    def _add_edges(self, model: Model) -> None:
        # Kind by kind: where a wall stands on a slab, an edge of four faces would count as none.
        found = [_edges(model.vertices, triangles) for _, triangles in kinds(model)]
        found = [edges for edges in found if edges.n_cells]
        if found:
            edges = pyvista.merge(found, merge_points=False)
            self._plotter.add_mesh(edges, color=_EDGE_COLOUR, line_width=1.0, lighting=False)

    def pictures(self, positions: NDArray[np.float64], quat_xyzw: NDArray[np.float64]) -> Iterator[NDArray[np.uint8]]:
        """Yields a picture (height, width, 3) for each eye position (n, 3) and orientation (n, 4)."""
        camera = self._plotter.camera
        for number, (position, look) in enumerate(zip(positions, ahead(quat_xyzw), strict=True)):
            camera.position = tuple(position)
            camera.focal_point = tuple(position + look)
            camera.up = (0.0, 0.0, 1.0)
            camera.clipping_range = (_NEAR_M, self._far_m)
            with _without_a_display() if number == 0 else contextlib.nullcontext():
                self._window.Render()
            yield self._picture()

    def _picture(self) -> NDArray[np.uint8]:
        width, height = self._size
        self._window.GetPixelData(0, 0, width - 1, height - 1, 0, self._pixels, 0)
        # The library counts rows from below.
        return np.ascontiguousarray(vtk_to_numpy(self._pixels).reshape(height, width, 3)[::-1])

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._plotter.close()


def _edges(vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> pyvista.PolyData:
    used, index = np.unique(triangles, return_inverse=True)
    mesh = pyvista.PolyData.from_regular_faces(vertices[used], index.reshape(-1, 3)).clean()
    return mesh.extract_feature_edges(_EDGE_DEG, non_manifold_edges=False, manifold_edges=False)


@contextlib.contextmanager
def _without_a_display() -> Iterator[None]:
    """Keeps the library from complaining, while it opens a window, that there is no display; it does without one."""
    before = vtkLogger.GetCurrentVerbosityCutoff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    try:
        yield
    finally:
        vtkLogger.SetStderrVerbosity(before)
