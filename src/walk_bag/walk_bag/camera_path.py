# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A camera path recorded in a bag as keypoints: the places by which it can be walked again."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from walk_bag.errors import BagError
from walk_bag.imports import load_ride, recorded_building
from walk_bag.keypoint_files import ImportedKeypoints, imported

BEND_M = 0.5
"""The walk between two neighbours stays this near to where the camera was, as the crow flies."""

APART_M = 0.5
"""Keypoints nearer than this are one: a walker's width."""


def camera_keypoints(bag: Path | str) -> ImportedKeypoints:
    """Returns keypoints along the camera path that was looked at while a bag was recorded, in its order.

    They are the ends, where it stood, and where it bends (Douglas and Peucker's rule), each with the look it had.

    Raises:
        BagError: The bag cannot be read, holds no viewpoint, or the camera went nowhere.
    """
    bag = Path(bag)
    ride = load_ride(bag, "viewpoint")
    chosen = _apart(ride.positions, _bends(ride.positions) | _middles(ride.stop))
    if len(chosen) < 2:
        raise BagError(bag, "holds a camera path that stays where it is")
    offset_m = recorded_building(bag).offset_m
    positions = ride.positions[chosen] + (0.0 if offset_m is None else offset_m)
    return imported(bag, positions, ride.quat_xyzw[chosen], of_building=offset_m is not None)


def _bends(points: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Returns which points (n, 3) a line must pass to stay within `BEND_M` of all."""
    kept = np.zeros(len(points), bool)
    kept[[0, -1]] = True
    pieces = [(0, len(points) - 1)]
    while pieces:
        first, last = pieces.pop()
        if last - first < 2:
            continue
        away = _distance(points[first + 1 : last], points[first], points[last])
        farthest = int(np.argmax(away))
        if away[farthest] > BEND_M:
            middle = first + 1 + farthest
            kept[middle] = True
            pieces += [(first, middle), (middle, last)]
    return kept


def _distance(points: NDArray[np.float64], a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the distance (n,) of points (n, 3) from the piece between a and b."""
    along = b - a
    share = np.clip((points - a) @ along / max(float(along @ along), 1e-12), 0.0, 1.0)
    return np.asarray(np.linalg.norm(points - a - share[:, None] * along, axis=1))


def _middles(stop: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Returns the middle sample of each time that the camera stood."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], stop.astype(np.int8), [0]])))
    found = np.zeros(len(stop), bool)
    found[(edges[::2] + edges[1::2] - 1) // 2] = True
    return found


def _apart(points: NDArray[np.float64], kept: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Returns the samples that are kept, without those too near to the one before."""
    chosen: list[int] = []
    for index in np.flatnonzero(kept).tolist():
        if not chosen or float(np.linalg.norm(points[index] - points[chosen[-1]])) >= APART_M:
            chosen.append(index)
    return np.array(chosen, dtype=np.int64)
