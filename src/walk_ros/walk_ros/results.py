# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The messages that each node publishes for its result; recordings made without a graph hold the same ones."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from walk_ros.conversions.cdr import path_to_bytes
from walk_ros.conversions.importance import ImportanceMapLike, importance_map_to_bytes, importance_map_to_msg
from walk_ros.conversions.legs import LegLike, pairwise_paths_to_msg
from walk_ros.conversions.legs_cdr import pairwise_paths_to_bytes
from walk_ros.conversions.markers import cleared, keypoint_markers_to_msg
from walk_ros.conversions.paths import headings, path_to_msg, tour_to_msg
from walk_ros.conversions.poses import keypoints_to_msg, viewpoint_to_msg
from walk_ros.conversions.stamps import NS
from walk_ros.conversions.storeys import storey_grid, storey_grid_to_msg
from walk_ros.conversions.trajectories import TrajectoryLike, trajectory_to_msg

TopicMessages = list[tuple[str, Any]]
"""Relative topic names and messages, in the order they are published."""

NO_POINTS = np.empty((0, 3))
NO_TURNS = np.empty((0, 4))


class UnreachableLike(Protocol):
    """A keypoint that the tour leaves out."""

    @property
    def index(self) -> int:
        """Into the keypoints."""

    @property
    def reason(self) -> str:
        """In words."""


class TourLike(Protocol):
    """What a tour has."""

    @property
    def order(self) -> NDArray[np.int64]:
        """(M,) indices into the keypoints."""

    @property
    def unreachable(self) -> Sequence[UnreachableLike]:
        """What it leaves out."""

    @property
    def pairs(self) -> Sequence[LegLike]:
        """All planned pairs."""

    @property
    def lengths_m(self) -> NDArray[np.float64]:
        """(K, K) walkable lengths, inf where there is no way."""

    @property
    def stands(self) -> NDArray[np.float64]:
        """(K, 3) where the walker's eye is at each keypoint, nan where it cannot stand."""

    @property
    def polyline(self) -> NDArray[np.float64]:
        """(L, 3) eye positions."""


def map_messages(
    importance_map: ImportanceMapLike | None, floors_z: Sequence[float], eye_height_m: float, stamp_ns: int
) -> TopicMessages:
    """Returns the importance map and a grid per storey; None gives empty ones."""
    if importance_map is None:
        return [
            ("importance_map", importance_map_to_msg(None, stamp_ns)),
            ("importance_map/storeys", storey_grid_to_msg(None, stamp_ns)),
        ]
    storeys = _storey_messages(importance_map, floors_z, eye_height_m, stamp_ns)
    return [("importance_map", importance_map_to_msg(importance_map, stamp_ns)), *storeys]


def map_bytes(
    importance_map: ImportanceMapLike, floors_z: Sequence[float], eye_height_m: float, stamp_ns: int
) -> TopicMessages:
    """Returns what `map_messages` returns, the map serialised: a million voxels are 28 MB."""
    storeys = _storey_messages(importance_map, floors_z, eye_height_m, stamp_ns)
    return [("importance_map", importance_map_to_bytes(importance_map, stamp_ns)), *storeys]


def _storey_messages(
    importance_map: ImportanceMapLike, floors_z: Sequence[float], eye_height_m: float, stamp_ns: int
) -> TopicMessages:
    grids = [storey_grid(importance_map, floor_z, eye_height_m) for floor_z in floors_z]
    return [("importance_map/storeys", storey_grid_to_msg(grid, stamp_ns)) for grid in grids]


def suggestion_messages(positions: NDArray[np.float64], quat_xyzw: NDArray[np.float64], stamp_ns: int) -> TopicMessages:
    """Returns the suggested keypoints (K, 3), (K, 4), best first."""
    return [("suggested_keypoints", keypoints_to_msg(positions, quat_xyzw, stamp_ns))]


def tour_messages(
    tour: TourLike | None,
    positions: NDArray[np.float64],
    quat_xyzw: NDArray[np.float64],
    ids: Sequence[int],
    labels: Sequence[str],
    stamp_ns: int,
    removed: Iterable[int] = (),
) -> TopicMessages:
    """Returns keypoints, markers, legs and the tour; None gives empty ones.

    Args:
        tour: Through the keypoints below.
        positions: (K, 3) where the keypoints are wished, in their own order; what is told is where the walker stands.
        quat_xyzw: (K, 4) view directions.
        ids: (K,) stable identities.
        labels: (K,) what a viewer writes beside them.
        stamp_ns: The revision.
        removed: Identities shown before and gone now.
    """
    if tour is None:
        gone = keypoint_markers_to_msg(NO_POINTS, NO_TURNS, (), (), stamp_ns, removed=removed)
        return [
            ("keypoints", keypoints_to_msg(NO_POINTS, NO_TURNS, stamp_ns)),
            ("keypoint_markers", gone),
            ("pairwise_paths", cleared(stamp_ns)),
            ("tour", tour_to_msg(NO_POINTS, stamp_ns)),
        ]
    keypoints, markers, path = stand_messages(tour, positions, quat_xyzw, ids, labels, stamp_ns, removed)
    return [keypoints, markers, leg_messages(tour, ids, stamp_ns), path]


def stand_messages(
    tour: TourLike,
    positions: NDArray[np.float64],
    quat_xyzw: NDArray[np.float64],
    ids: Sequence[int],
    labels: Sequence[str],
    stamp_ns: int,
    removed: Iterable[int] = (),
) -> TopicMessages:
    """Returns what `tour_messages` does without the legs of all pairs: those are many, and no edit waits for them."""
    stands = _stand_messages(tour, positions, quat_xyzw, ids, labels, stamp_ns, removed)
    return [*stands, ("tour", tour_to_msg(tour.polyline, stamp_ns))]


def stand_bytes(
    tour: TourLike,
    positions: NDArray[np.float64],
    quat_xyzw: NDArray[np.float64],
    ids: Sequence[int],
    labels: Sequence[str],
    stamp_ns: int,
    removed: Iterable[int] = (),
) -> TopicMessages:
    """Returns what `stand_messages` does, the tour serialised: a release waits for it."""
    line = np.asarray(tour.polyline, dtype=np.float64).reshape(-1, 3)
    data = path_to_bytes(np.zeros(len(line)), line, headings(line), stamp_ns)
    return [*_stand_messages(tour, positions, quat_xyzw, ids, labels, stamp_ns, removed), ("tour", data)]


def _stand_messages(
    tour: TourLike,
    positions: NDArray[np.float64],
    quat_xyzw: NDArray[np.float64],
    ids: Sequence[int],
    labels: Sequence[str],
    stamp_ns: int,
    removed: Iterable[int],
) -> TopicMessages:
    order = [int(i) for i in tour.order]
    eyes = tour.stands[order]
    markers = keypoint_markers_to_msg(
        eyes,
        quat_xyzw[order],
        [ids[i] for i in order],
        [labels[i] for i in order],
        stamp_ns,
        left_out=[(ids[u.index], positions[u.index], u.reason) for u in tour.unreachable],
        removed=removed,
    )
    return [("keypoints", keypoints_to_msg(eyes, quat_xyzw[order], stamp_ns)), ("keypoint_markers", markers)]


def leg_messages(tour: TourLike, ids: Sequence[int], stamp_ns: int) -> tuple[str, Any]:
    """Returns topic and message of the legs of all pairs."""
    return "pairwise_paths", pairwise_paths_to_msg(tour.pairs, ids, stamp_ns, _no_way(tour))


def leg_bytes(tour: TourLike, ids: Sequence[int], stamp_ns: int) -> tuple[str, bytes]:
    """Returns what `leg_messages` returns, serialised: 1770 legs in a tenth of the time."""
    return "pairwise_paths", pairwise_paths_to_bytes(tour.pairs, ids, stamp_ns, _no_way(tour))


def _no_way(tour: TourLike) -> list[tuple[int, int, str]]:
    """Returns the pairs between which nobody can walk, with the reason."""
    left_out = {int(u.index): u.reason for u in tour.unreachable}
    upper = np.triu(np.isinf(tour.lengths_m), 1)
    pairs = [(int(a), int(b)) for a, b in np.argwhere(upper)]
    return [(a, b, left_out.get(a) or left_out.get(b) or "no way between them") for a, b in pairs]


def path_messages(trajectory: TrajectoryLike | None, stamp_ns: int) -> TopicMessages:
    """Returns the path with planned arrival times and the trajectory; None gives empty ones."""
    walk = trajectory or _Nothing()
    return [
        ("path", path_to_msg(walk.t_s, walk.positions, walk.quat_xyzw, stamp_ns)),
        ("trajectory", trajectory_to_msg(walk, stamp_ns)),
    ]


def viewpoint_messages(trajectory: TrajectoryLike, stamp_ns: int) -> list[tuple[int, Any]]:
    """Returns where the eye is at each time [ns] of the trajectory: what playback publishes on `viewpoint`."""
    times = (stamp_ns + np.rint(trajectory.t_s * NS).astype(np.int64)).tolist()
    rows = zip(times, trajectory.positions, trajectory.quat_xyzw, strict=True)
    return [(at, viewpoint_to_msg(position, quat, at)) for at, position, quat in rows]


class _Nothing:
    """A trajectory without a row."""

    t_s = np.empty(0)
    positions = velocities = accelerations = NO_POINTS
    quat_xyzw = NO_TURNS
