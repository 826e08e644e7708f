# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""How much of the building a walk shows: exact rays from the path to a sample of the free voxels."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_building.geometry import Geometry
from walk_importance.importance_map import ImportanceMap
from walk_plan.along import every

SAMPLES = 1500
"""Free voxels asked about: the share seen is known to about ±1.3 % (one standard error)."""

VIEW_SPACING_M = 1.0
"""Distance along the path between the places one looks from."""

ROOM_HEIGHT_M = 2.5
"""Free space counts up to this height above a floor that can be walked on."""

_AT_ONCE = 8  # viewpoints a batch: few enough that what an early batch saw spares the later ones many rays
_ASKED = 40  # voxels looked at for each one wanted, before a smaller sample is put up with
_SHORT_M = 1e-6  # rays stop this far before their target


def sample_free_space(building: Building, importance_map: ImportanceMap, seed: int = 1) -> NDArray[np.float64]:
    """Returns centres of free voxels over the reachable floors, drawn without replacement, (s, 3) [m].

    A voxel counts if the nearest reachable place is no farther to the side than the body and a cell, and below
    it by no more than a room's height. Space that belongs to what cannot be reached is nobody's to show.
    """
    free = np.random.default_rng(seed).permutation(np.flatnonzero(importance_map.obstacle.ravel() == 0.0))
    found: list[NDArray[np.float64]] = [np.zeros((0, 3))]
    # In handfuls, because most voxels stand outside and the nearest place costs time.
    for begin in range(0, min(len(free), _ASKED * SAMPLES), SAMPLES):
        voxels = np.column_stack(np.unravel_index(free[begin : begin + SAMPLES], importance_map.grid.shape))
        centres = importance_map.grid.centres(voxels)
        found.append(centres[_over_reachable_floor(building, centres)])
        if sum(map(len, found)) >= SAMPLES:
            break
    return np.vstack(found)[:SAMPLES]


def _over_reachable_floor(building: Building, points: NDArray[np.float64]) -> NDArray[np.bool_]:
    place = building.surface.nearest(points - [0.0, 0.0, ROOM_HEIGHT_M / 2])
    offset = points - building.surface.places[place]
    aside = np.hypot(offset[:, 0], offset[:, 1]) <= building.walker.radius_m + building.surface.cell_m
    within = (offset[:, 2] >= 0.0) & (offset[:, 2] <= ROOM_HEIGHT_M)
    return np.asarray(building.reachable[place] & aside & within)


def seen_share(geometry: Geometry, eye_path: NDArray[np.float64], targets: NDArray[np.float64]) -> float:
    """Returns the share of the targets with a free line of sight from somewhere on the path; nan without targets.

    Args:
        geometry: What blocks the view.
        eye_path: (n, 3) polyline of the eye [m]; one looks from every metre of it, all around.
        targets: (s, 3) [m].
    """
    if len(targets) == 0:
        return float("nan")
    hidden = np.ones(len(targets), bool)
    eyes = every(eye_path, VIEW_SPACING_M)
    # Far apart first: neighbours see much the same.
    eyes = eyes[np.argsort(np.arange(len(eyes)) * 0.6180339887498949 % 1.0)]
    for begin in range(0, len(eyes), _AT_ONCE):
        asked = np.flatnonzero(hidden)
        if len(asked) == 0:
            break
        some = eyes[begin : begin + _AT_ONCE]
        hidden[asked[_visible(geometry, some, targets[asked]).any(axis=0)]] = False
    return float(1.0 - hidden.mean())


def _visible(geometry: Geometry, eyes: NDArray[np.float64], targets: NDArray[np.float64]) -> NDArray[np.bool_]:
    rays = targets[None, :, :] - eyes[:, None, :]
    length = np.linalg.norm(rays, axis=2)
    flat = rays.reshape(-1, 3).copy()
    flat[length.ravel() < _SHORT_M] = [0.0, 0.0, 1.0]
    hits = geometry.raycast(np.repeat(eyes, len(targets), axis=0), flat, max_distance_m=float(length.max()))
    return np.asarray(hits.distance_m.reshape(length.shape) >= length - _SHORT_M)
