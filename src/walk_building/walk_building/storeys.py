# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The storeys of a building: as declared, else the levels where much floor lies."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from walk_building.model import Storey

_BIN_M = 0.1
# Levels nearer to each other than this are one storey with steps in it.
_MIN_STOREY_HEIGHT_M = 2.2
# A level with less floor than this share of the largest is a landing or a platform.
_MIN_SHARE = 0.1
# A place a little below a storey's elevation still belongs to it: sunken floors, the top steps of a stair.
_TOLERANCE_M = 0.5


def find_storeys(z: NDArray[np.float64]) -> tuple[Storey, ...]:
    """Returns the levels at which most of the floor lies, lowest first.

    Args:
        z: (P,) heights of the indoor places; not empty [m].
    """
    low = np.floor(z.min() / _BIN_M) * _BIN_M
    area = np.bincount(((z - low) / _BIN_M).astype(int)).astype(float)
    # Ramps and sloped decks spread over bins: what counts is the floor within a step or so.
    window = np.convolve(area, np.ones(5), mode="same")
    levels: list[float] = []
    for k in np.argsort(-window, kind="stable"):
        if window[k] < _MIN_SHARE * window.max():
            break
        level = low + k * _BIN_M
        if all(abs(level - other) >= _MIN_STOREY_HEIGHT_M for other in levels):
            levels.append(float(level))
    # The elevation is where the level's floor lies, not the edge of a bin.
    exact = [float(np.median(z[np.abs(z - level) <= 0.3])) for level in sorted(levels)]
    return tuple(Storey(name=f"Level {i}", elevation_m=level) for i, level in enumerate(exact))


def storey_of(storeys: tuple[Storey, ...], z: NDArray[np.float64]) -> NDArray[np.int32]:
    """Returns the index of the highest storey whose floor is not above each height (P,), the lowest below all."""
    elevation = np.array([s.elevation_m for s in storeys])
    index = np.searchsorted(elevation, z + _TOLERANCE_M, side="right") - 1
    return np.maximum(index, 0).astype(np.int32)
