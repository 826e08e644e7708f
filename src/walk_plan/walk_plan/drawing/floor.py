# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The floor of a storey as a tinted picture: each room in its own pale colour."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt, zoom

from walk_building.building import Building
from walk_building.narrow import usual_floor, usual_width
from walk_plan.drawing import style

_MARGIN_M = 1.2  # the body's radius, a wall and some paper
_FINER = 2  # a pixel of the tint is this much smaller than a cell of the surface


def shown_places(building: Building, storey: int | None = None) -> NDArray[np.bool_]:
    """Returns which places are floor to an architect (P,): what can be reached, and rooms that cannot.

    What is left out are the tops of furniture and walls.
    """
    surface = building.surface
    floor = building.reachable | (surface.indoor & (surface.room >= 0))
    return floor if storey is None else floor & (surface.storey == storey)


def storey_bounds(building: Building, storey: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns the lower left and the upper right corner of what a storey's plan shows, (2,) each [m]."""
    inside = _floor(building, storey)
    if len(inside) == 0:
        inside = building.geometry.bounds[:, :2]
    return inside.min(axis=0) - _MARGIN_M, inside.max(axis=0) + _MARGIN_M


def _floor(building: Building, storey: int) -> NDArray[np.float64]:
    """Returns where the storey's floor is (n, 2), also that on which the walker is too wide to stand."""
    own = building.surface.places[shown_places(building, storey), :2]
    return np.vstack([own, usual_floor(building, storey)[:, :2]])


def away_from_floor(building: Building, storey: int, points: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Returns which of the points (n, 2) are too far from the storey's floor to be part of its plan, such as trees."""
    surface = building.surface
    empty = np.ones(surface.columns.count, bool)
    empty[surface.columns.flat_of(_floor(building, storey))] = False
    away = distance_transform_edt(empty.reshape(surface.columns.shape)).ravel() * surface.cell_m
    column = surface.columns.flat_of(points)
    return np.asarray((column < 0) | (away[column] > _MARGIN_M))


def tinted_floor(axes: Axes, building: Building, storey: int) -> None:
    """Draws where one can stand, room by room, widened to the walls; what cannot be reached is grey."""
    surface = building.surface
    nx, ny = surface.columns.shape
    room = np.full(nx * ny, -2)
    here = shown_places(building, storey)
    # Only what can be reached has a colour of its own.
    shown = np.where(building.reachable[here], surface.room[here], -1)
    room[surface.columns.flat_of(surface.places[here, :2])] = shown
    narrow = np.zeros(nx * ny, bool)
    narrow[surface.columns.flat_of(usual_floor(building, storey)[:, :2])] = True
    if not (room > -2).any() and not narrow.any():
        return
    labels = zoom(room.reshape(nx, ny), _FINER, order=0, grid_mode=True, mode="nearest")
    # A body's radius from the walls nobody can stand; the tint reaches them all the same.
    away, nearest = distance_transform_edt(labels == -2, return_indices=True)
    reach = (building.walker.radius_m + surface.cell_m) / surface.cell_m * _FINER
    wide = np.where(away <= reach, labels[tuple(nearest)], -2)
    if narrow.any():
        finer = zoom(narrow.reshape(nx, ny), _FINER, order=0, grid_mode=True, mode="nearest")
        beside = (usual_width(building.walker).radius_m + surface.cell_m) / surface.cell_m * _FINER
        wide = np.where((wide == -2) & (distance_transform_edt(~finer) <= beside), -1, wide)
    palette = np.array([to_rgba("white", 0.0), to_rgba(style.OPEN_FLOOR)] + [to_rgba(c) for c in style.ROOM_TINTS])
    index = np.where(wide >= 0, 2 + wide % len(style.ROOM_TINTS), wide + 2)
    low = surface.columns.origin - surface.cell_m / 2
    high = low + np.array([nx, ny]) * surface.cell_m
    extent = (low[0], high[0], low[1], high[1])
    axes.imshow(
        (palette[index] * 255).astype(np.uint8).swapaxes(0, 1), extent=extent, origin="lower", interpolation="nearest",
        zorder=1, aspect="equal",
    )  # fmt: skip
