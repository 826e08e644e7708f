# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Corridors, galleries and ramps that open into a hall over their whole width. Our own."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

# Half the width of the widest corridor of a house.
_HALF_WIDTH_M = 1.1
# A hall is half as wide again as the widest corridor; where corridors cross or bend, there is less room.
_HALL_HALF_WIDTH_M = 1.5 * _HALF_WIDTH_M
# A corridor is at least so many times as long as it is open to halls; less is a bay of the hall.
_LENGTH_PER_OPENING = 3.0
_SQUARE = np.ones((3, 3))


def part_corridors(room: NDArray[np.int32], cell_m: float) -> NDArray[np.int32]:
    """Returns the rooms (nx, ny), -1 for none, with the corridors cut off that open into a wider part of their room.

    A room's halls are where a disc wider than a corridor fits. What is left of it is a corridor if it is long for
    the width over which it is open to the halls: an aisle between columns is open to its hall all along.
    """
    parted = room.copy()
    for label, where in enumerate(ndimage.find_objects(room + 1)):
        if where is None:
            continue
        inside = np.pad(room[where] == label, 1)
        piece = _pieces(inside, cell_m)[1:-1, 1:-1]
        # The largest piece keeps the room's number.
        parted[where][piece > 1] = parted.max() + piece[piece > 1] - 1
    return parted


def _pieces(inside: NDArray[np.bool_], cell_m: float) -> NDArray[np.int32]:
    """Returns the piece of each column of a room, 1 for the largest; 0 outside it."""
    hall = _halls(inside, cell_m)
    arm, n_arms = ndimage.label(inside & ~hall, _SQUARE)
    corridor = np.zeros_like(inside)
    if hall.any():
        beside = ndimage.binary_dilation(hall) & (arm > 0)
        numbers = np.arange(n_arms + 1)
        opening_m = ndimage.sum_labels(beside, arm, numbers) * cell_m
        area_m2 = ndimage.sum_labels(np.ones_like(arm), arm, numbers) * cell_m**2
        half_width_m = ndimage.maximum(ndimage.distance_transform_edt(inside), arm, numbers) * cell_m
        length_m = area_m2 / np.maximum(2 * half_width_m, cell_m)
        corridor = (length_m >= _LENGTH_PER_OPENING * opening_m)[arm] & (arm > 0)
    label = ndimage.label(inside & ~corridor, _SQUARE)[0]
    label[corridor] = label.max() + ndimage.label(corridor, _SQUARE)[0][corridor]
    rank = np.empty(label.max() + 1, np.int32)
    rank[np.argsort(-np.bincount(label.reshape(-1), weights=inside.reshape(-1)), kind="stable")] = np.arange(
        1, len(rank) + 1
    )
    rank[0] = 0
    return np.asarray(rank[label])


def _halls(inside: NDArray[np.bool_], cell_m: float) -> NDArray[np.bool_]:
    """Where a disc wider than a corridor fits into a room, in parts that are wide enough for a hall."""
    distance = ndimage.distance_transform_edt(inside) * cell_m
    core = distance > _HALF_WIDTH_M
    if not core.any():
        return core
    wide = inside & (ndimage.distance_transform_edt(~core) * cell_m <= _HALF_WIDTH_M)
    part, n_parts = ndimage.label(wide, _SQUARE)
    widest = np.append(0.0, ndimage.maximum(distance, part, np.arange(1, n_parts + 1)))
    return np.asarray((widest > _HALL_HALF_WIDTH_M)[part])
