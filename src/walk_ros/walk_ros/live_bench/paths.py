# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Whether a path that came in is one: finite, stamped, complete; and, by a sweep of its own, free of the building."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_building.sweep import BodySweep
from walk_ros.conversions import path_from_msg
from walk_ros.errors import MessageError
from walk_ros.raw import from_bytes

MISSED_M = 0.75
"""A path that stays farther than this from a keypoint does not lead past it: its radius of 0.5 m, and half as much."""


def path_stamp_ns(data: bytes) -> int:
    """Returns the header stamp of a serialised path."""
    sec, nanosec = np.frombuffer(data, "<u4", 2, 4).tolist()
    return int(sec) * 1_000_000_000 + int(nanosec)


def flaw(data: bytes, keypoints: NDArray[np.float64], held: frozenset[int]) -> str:
    """Returns what is wrong with a serialised path, "" if nothing is.

    Args:
        data: As it came in; the conversion checks numbers, frames, orientations and that stamps never fall.
        keypoints: (K, 3) where the keypoints are, in the order of the tour.
        held: Indices of those in hands: where they are now nobody but trajopt knows.
    """
    try:
        path = path_from_msg(from_bytes(data, "nav_msgs/msg/Path"))
    except MessageError as error:
        return error.reason
    if len(path.positions) < 2:
        return f"{len(path.positions)} poses; expected a walk"
    if path.t_s[-1] <= 0.0:
        return "all poses carry one stamp; expected planned arrivals"
    away = distances(keypoints, path.positions)
    missed = [k for k in range(len(keypoints)) if k not in held and away[k] > MISSED_M]
    return f"keypoint {missed[0]} is {away[missed[0]]:.2f} m off the path" if missed else ""


def distances(points: NDArray[np.float64], polyline: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns how far each point (K, 3) is from a polyline (n, 3) [m]."""
    start, step = polyline[:-1], np.diff(polyline, axis=0)
    square = np.maximum(np.einsum("ij,ij->i", step, step), 1e-18)
    share = np.einsum("kij,ij->ki", points[:, None] - start, step) / square
    nearest = start + np.clip(share, 0.0, 1.0)[..., None] * step
    return np.asarray(np.linalg.norm(points[:, None] - nearest, axis=2).min(axis=1))


def colliding(building: Building, samples: list[bytes]) -> int:
    """Returns on how many of the paths a body swept along them touches the building."""
    sweep = BodySweep(building.geometry, building.walker)
    return sum(
        not sweep.segments_free(path_from_msg(from_bytes(data, "nav_msgs/msg/Path")).positions).all()
        for data in samples
    )
