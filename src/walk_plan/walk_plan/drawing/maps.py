# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The three maps and the importance, storey by storey (the source's figure 1)."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Colormap
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation, binary_fill_holes

from walk_building.building import Building
from walk_importance.grid import VoxelGrid
from walk_importance.importance_map import ImportanceMap
from walk_plan.drawing import style
from walk_plan.drawing.floor import storey_bounds
from walk_plan.profile import storeys_along
from walk_plan.walkthrough import Walkthrough

_COLUMNS = ("Obstacles", "Distance to the nearest obstacle", "Openness: share of the space in view", "Importance")
_GAP_IN, _HEAD_IN, _FOOT_IN, _NAME_IN = 0.1, 0.28, 0.5, 0.2
_PANEL_IN = (style.WIDTH_IN - 3 * _GAP_IN) / 4
_MAX_PANEL_IN = 3.4
_WALL_M = 0.6  # how far from where one can stand a wall or a corner may be to be shown


def draw_maps(walkthrough: Walkthrough, storeys: list[int]) -> Figure:
    """Returns one picture with a row for each of the storeys and a column for each map, at the height of the eye."""
    building, grid = walkthrough.building, walkthrough.importance_map.grid
    bounds = [storey_bounds(building, storey) for storey in storeys]
    low = np.min([b[0] for b in bounds], axis=0)
    high = np.max([b[1] for b in bounds], axis=0)
    tall = min(_PANEL_IN * (high - low)[1] / (high - low)[0], _MAX_PANEL_IN)
    row = tall + _NAME_IN
    height = _HEAD_IN + row * len(storeys) + _FOOT_IN
    made = style.figure(style.WIDTH_IN, height)
    layers = [_layers(walkthrough.importance_map, building, storey) for storey in storeys]
    scales = _scales(layers)
    for column, title in enumerate(_COLUMNS):
        left = column * (_PANEL_IN + _GAP_IN)
        _write(made, left + _PANEL_IN / 2, height - 0.14, title, ha="center", va="center")
        for r, storey in enumerate(storeys):
            bottom = height - _HEAD_IN - (r + 1) * row
            axes = _axes(made, left, bottom, _PANEL_IN, tall)
            image = _draw_map(axes, grid, layers[r], column, scales[column])
            style.plain_map(axes, low, high)
            if column == 0:
                _write(made, 0.0, bottom + tall + 0.04, building.storeys[storey].name, weight="bold")
            if column == len(_COLUMNS) - 1:
                _draw_keypoints(axes, walkthrough, storey)
        _draw_scale(made, image, column, left)
    return made


def _axes(made: Figure, left: float, bottom: float, width: float, height: float) -> Axes:
    """Adds axes at a place given in inches."""
    w, h = made.get_figwidth(), made.get_figheight()
    return made.add_axes((left / w, bottom / h, width / w, height / h))


def _write(made: Figure, left: float, bottom: float, text: str, **style_of: Any) -> None:
    made.text(
        left / made.get_figwidth(), bottom / made.get_figheight(), text, fontsize=style.NORMAL_PT, **style_of
    )  # fmt: skip


def slice_index(importance_map: ImportanceMap, z_m: float) -> int:
    """Returns the layer of voxels that holds the height, or the nearest one."""
    grid = importance_map.grid
    return int(np.clip(np.floor((z_m - grid.origin[2]) / grid.voxel_size_m), 0, grid.shape[2] - 1))


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class _Layers:
    """One storey's layer of each map, at the height of the eye; (nx, ny) each."""

    solid: NDArray[np.bool_]
    outside: NDArray[np.bool_]  # nothing to do with the storey's floor: left blank
    values: tuple[NDArray[np.float32], ...]  # distance, visibility, importance


def _layers(importance_map: ImportanceMap, building: Building, storey: int) -> _Layers:
    k = slice_index(importance_map, building.storeys[storey].elevation_m + building.walker.eye_height_m)
    values = (importance_map.distance, importance_map.visibility, importance_map.importance)
    return _Layers(
        solid=importance_map.obstacle[:, :, k] > 0.0,
        outside=~_over_floor(importance_map, building, storey),
        values=tuple(layer[:, :, k] for layer in values),
    )


def _over_floor(importance_map: ImportanceMap, building: Building, storey: int) -> NDArray[np.bool_]:
    """Which columns of voxels stand over the storey's floor, over its walls, or over furniture in its middle."""
    # Tops of furniture too, as long as they are indoors: the space above a bed belongs to its room.
    surface, grid = building.surface, importance_map.grid
    here = surface.places[(surface.storey == storey) & (surface.indoor | building.reachable)]
    inside = np.zeros(grid.shape[:2], bool)
    inside[tuple(grid.indices(here)[:, :2].T)] = True
    reach = int(np.ceil(_WALL_M / grid.voxel_size_m))
    return np.asarray(binary_fill_holes(binary_dilation(inside, iterations=reach)))


def _scales(layers: list[_Layers]) -> list[tuple[float, float]]:
    """Returns the range of each map over what is shown, obstacles left out: (0, 1) first, for the obstacles."""
    scales = [(0.0, 1.0)]
    for which in range(3):
        shown = np.concatenate([layer.values[which][~layer.solid & ~layer.outside] for layer in layers])
        # A few voxels on a balcony that look out over everything would leave the rooms all one colour.
        low, high = (float(shown.min()), float(np.percentile(shown, 98))) if len(shown) else (0.0, 1.0)
        low = low if which == 2 else 0.0
        scales.append((low, max(high, low + 1e-6)))
    return scales


def _draw_map(axes: Axes, grid: VoxelGrid, layers: _Layers, which: int, scale: tuple[float, float]) -> AxesImage:
    if which == 0:
        shown = np.ma.masked_where(layers.outside & ~layers.solid, layers.solid)
        colours: Colormap = style.SOLID
    else:
        shown = np.ma.masked_where(layers.outside | layers.solid, layers.values[which - 1])
        colours = style.MAP.with_extremes(bad=(1.0, 1.0, 1.0, 0.0))
        walls = np.ma.masked_where(~layers.solid, layers.solid)
        axes.imshow(walls.T, cmap=style.WALLS, origin="lower", extent=_extent(grid), interpolation="nearest")
    return axes.imshow(
        shown.T, cmap=colours, vmin=scale[0], vmax=scale[1], origin="lower", extent=_extent(grid),
        interpolation="nearest",
    )  # fmt: skip


def _extent(grid: VoxelGrid) -> tuple[float, float, float, float]:
    x, y = grid.origin[:2]
    return (x, x + grid.shape[0] * grid.voxel_size_m, y, y + grid.shape[1] * grid.voxel_size_m)


def _draw_keypoints(axes: Axes, walkthrough: Walkthrough, storey: int) -> None:
    keypoints = walkthrough.keypoints
    here = keypoints[storeys_along(walkthrough.building, keypoints) == storey]
    axes.plot(
        here[:, 0], here[:, 1], linestyle="none", marker="o", markersize=3.2, markerfacecolor="white",
        markeredgecolor=style.INK, markeredgewidth=0.6,
    )  # fmt: skip


def _draw_scale(made: Figure, image: AxesImage, column: int, left: float) -> None:
    bar = _axes(made, left + 0.2 * _PANEL_IN, 0.26, 0.6 * _PANEL_IN, 0.08)
    colours = made.colorbar(image, cax=bar, orientation="horizontal")
    low, high = image.get_clim()
    if column == 0:
        colours.set_ticks([0.25, 0.75], labels=["free", "solid"])
    elif column == 2:
        colours.set_ticks([low, high], labels=[f"{100 * low:.0f} %", f"{100 * high:.0f} % or more"])
    else:
        colours.set_ticks([low, high], labels=["none", "far"] if column == 1 else ["low", "high"])
    colours.outline.set_linewidth(0.4)
    bar.tick_params(labelsize=style.SMALL_PT, length=2, width=0.4, pad=1.5)
