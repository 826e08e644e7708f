# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The places that may become keypoints: where a walker can stand and get to, one a voxel."""

from __future__ import annotations

import dataclasses

import numba
import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_importance.errors import NoPlaceError
from walk_importance.importance_map import ImportanceMap

# The cone reaches this far up and down: over the steps of a stair, but not through a floor.
STOREY_REACH_M = 1.5
ROOM_AROUND_M = 0.4  # a keypoint has this far to where standing ends, or half of the most its room offers


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Candidates:
    """Eye positions that may become keypoints.

    Attributes:
        place: (C,) indices into the surface's places.
        eyes: (C, 3) [m].
        score: (C,) importance at the eye's voxel.
        room: (C,) index into the building's rooms, -1 for none.
        square: (C,) index of the square of its room's floor that it stands for.
        squares: (S, 3) an eye position in each square [m].
    """

    place: NDArray[np.int64]
    eyes: NDArray[np.float64]
    score: NDArray[np.float64]
    room: NDArray[np.int64]
    square: NDArray[np.int64]
    squares: NDArray[np.float64]


_SQUARE_M = 0.5  # floor is looked at in squares of this side when asking how much of a room is seen
_SQUARES = 4000  # about as many at most, in larger squares: each is a ray for every keypoint (our own)


def find_candidates(building: Building, importance_map: ImportanceMap) -> Candidates:
    """Returns, for each voxel a walker's eye can be in, the place in it with the most room around.

    Raises:
        NoPlaceError: There is no place the walker can reach.
    """
    surface = building.surface
    places = np.flatnonzero(building.reachable)
    if len(places) == 0:
        raise NoPlaceError
    places = places[_roomy(surface.clearance_m[places], surface.room[places])]
    eyes = building.eyes(places)
    shape = importance_map.grid.shape
    voxel = np.ravel_multi_index(tuple(importance_map.grid.indices(eyes).T), shape)
    # Rooms that share a voxel keep a place each.
    key = voxel * (len(building.rooms) + 1) + surface.room[places] + 1
    order = np.lexsort((-surface.clearance_m[places], key))
    _, first = np.unique(key[order], return_index=True)
    best = np.sort(order[first])
    eyes, room = eyes[best], surface.room[places[best]].astype(np.int64)
    floor_m2 = len(eyes) * importance_map.grid.voxel_size_m**2
    square, shown = _squares(eyes, room, max(_SQUARE_M, (floor_m2 / _SQUARES) ** 0.5))
    return Candidates(
        place=places[best],
        eyes=eyes,
        score=importance_map.at(eyes).astype(np.float64),
        room=room,
        square=square,
        squares=eyes[shown],
    )


def _squares(
    eyes: NDArray[np.float64], room: NDArray[np.int64], side_m: float
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Returns the square of each candidate (C,), and the first candidate in each square (S,); squares go by rooms."""
    key = np.column_stack([room, np.floor(eyes / side_m).astype(np.int64)])
    _, first, square = np.unique(key, axis=0, return_index=True, return_inverse=True)
    return square.reshape(-1), first


def rescored(candidates: Candidates, importance_map: ImportanceMap) -> Candidates:
    """Returns the same candidates scored by a map of other weights over the same grid."""
    score = importance_map.at(candidates.eyes).astype(np.float64)
    return dataclasses.replace(candidates, score=score)


def _roomy(clearance_m: NDArray[np.float64], room: NDArray[np.int32]) -> NDArray[np.bool_]:
    """Leaves out the nooks between furniture: places with less around than a room has to offer elsewhere."""
    widest = np.zeros(room.max() + 2)
    np.maximum.at(widest, room, clearance_m)  # -1, no room, is the last
    return np.asarray(clearance_m >= np.minimum(ROOM_AROUND_M, 0.5 * widest[room]))


@numba.njit(cache=True, nogil=True)
def best_candidate(score, allowed):
    """Returns the allowed candidate with the highest score, the first of several; -1 where none is allowed."""
    best = -1
    for i in range(len(score)):
        if allowed[i] and (best < 0 or score[i] > score[best]):
            best = i
    return best


@numba.njit(cache=True, nogil=True)
def lower_by_cone(eyes, score, tip, radius, depth, reach):
    """Lowers scores (C,) in place by depth (1 - distance / radius) around `tip` (`schmidiger`).

    Only up to `reach` above and below, because the source's Euclidean cone would also lower the storeys above.
    """
    for i in range(len(score)):
        if abs(eyes[i, 0] - tip[0]) < radius and abs(eyes[i, 2] - tip[2]) <= reach:
            distance = _distance(eyes, i, tip)
            if distance < radius:
                score[i] -= depth * (1.0 - distance / radius)


@numba.njit(cache=True, nogil=True)
def rule_out_near(eyes, apart, tip, width):
    """Clears `apart` (C,) for the candidates nearer than `width` to `tip`."""
    for i in range(len(apart)):
        if abs(eyes[i, 0] - tip[0]) < width and _distance(eyes, i, tip) < width:
            apart[i] = False


@numba.njit(cache=True, nogil=True)
def _distance(eyes, i, tip):
    return np.sqrt((eyes[i, 0] - tip[0]) ** 2 + (eyes[i, 1] - tip[1]) ** 2 + (eyes[i, 2] - tip[2]) ** 2)
