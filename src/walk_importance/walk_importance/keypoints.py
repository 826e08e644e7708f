# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Keypoints: the most important places to stand, cone by cone, every room first."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_importance.candidates import (
    STOREY_REACH_M,
    Candidates,
    best_candidate,
    find_candidates,
    lower_by_cone,
    rule_out_near,
)
from walk_importance.config import KeypointConfig
from walk_importance.errors import NoPlaceNearError, TooManyKeypointsError
from walk_importance.importance_map import ImportanceMap
from walk_importance.view import quat_xyzw_from_yaw, sees, view_yaws

_KNEE_M = 0.5  # floor counts as seen where this far above it is: over a doorstep, but not over a table
_ROOM_LIMIT = 60  # keypoints in one room; a hall that large is better served by a count of the user's


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class SkippedRoom:
    """A room without a keypoint, and why."""

    room: int  # index into the building's rooms
    reason: str


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Suggestion:
    """Keypoints, best first. Arrays are read-only.

    Attributes:
        positions: (K, 3) eye positions, each over a place where the walker can stand [m].
        quat_xyzw: (K, 4) the x axis looks where most is seen.
        score: (K,) importance when it was chosen, lowered by the cones of those before.
        room: (K,) index into the building's rooms, -1 for none.
        place: (K,) index into the surface's places.
        skipped: Rooms that got none.
    """

    positions: NDArray[np.float64]
    quat_xyzw: NDArray[np.float64]
    score: NDArray[np.float64]
    room: NDArray[np.int64]
    place: NDArray[np.int64]
    skipped: tuple[SkippedRoom, ...]


def suggest_keypoints(
    building: Building,
    importance_map: ImportanceMap,
    config: KeypointConfig | None = None,
    candidates: Candidates | None = None,
) -> Suggestion:
    """Chooses keypoints: first one for every reachable room, then more by cone suppression.

    Rooms come in order of their best candidate. With a `count`, rooms beyond it are skipped and what is left over
    goes to the most important places anywhere. With count 0 each room gets keypoints, always the most important
    place among those not seen yet, until `room_coverage` of its floor is seen; a building of which one keypoint sees
    enough gets a second one where there is room, since a walk leads from one to another.

    Args:
        building: The building.
        importance_map: Its maps.
        config: How many, and their cones.
        candidates: Of the same building and map, from `find_candidates`, to choose again from them with another
            config at once.

    Raises:
        NoPlaceError: There is no place the walker can reach.
        TooManyKeypointsError: `count` is more than fit a body's width apart.
    """
    config = config or KeypointConfig()
    candidates = candidates or find_candidates(building, importance_map)
    choice = _Choice(building, candidates, config)
    rooms = _rooms_by_importance(building, candidates)
    for room in rooms[: config.count or None]:
        choice.take(candidates.room == room)
    if config.count:
        _fill(choice, config.count)
    else:
        for room in rooms:
            _cover_room(building, choice, candidates.room == room, config)
        if not rooms:
            _cover_room(building, choice, np.ones(len(candidates.place), bool), config)
        if len(choice.chosen) == 1:
            choice.take(_away_from(candidates, choice.chosen[0], config.cone_radius_m / 2))
    return _suggestion(building, importance_map, choice, _skipped(building, rooms, config.count))


class _Choice:
    """Candidates with the cones of those chosen so far."""

    def __init__(self, building: Building, candidates: Candidates, config: KeypointConfig) -> None:
        self.candidates = candidates
        self.score = candidates.score.copy()
        self.apart = np.ones(len(candidates.place), bool)
        self.chosen: list[int] = []
        self.scores: list[float] = []
        self._config = config
        self._width_m = 2 * building.walker.radius_m

    def take(self, allowed: NDArray[np.bool_]) -> int:
        """Chooses the best allowed candidate a body's width from the others; -1 if there is none."""
        best = int(best_candidate(self.score, allowed & self.apart))
        if best < 0:
            return -1
        self.chosen.append(best)
        self.scores.append(float(self.score[best]))
        self.suppress(self.candidates.eyes[best])
        return best

    def suppress(self, tip: NDArray[np.float64]) -> None:
        """Lowers the scores by the cone around a keypoint (3,) and rules out what is too near to it."""
        radius, depth = self._config.cone_radius_m, self._config.cone_depth
        lower_by_cone(self.candidates.eyes, self.score, tip, radius, depth, STOREY_REACH_M)
        rule_out_near(self.candidates.eyes, self.apart, tip, self._width_m)


def _rooms_by_importance(building: Building, candidates: Candidates) -> list[int]:
    best = np.full(len(building.rooms) + 1, -np.inf)
    np.maximum.at(best, candidates.room, candidates.score)  # -1 is the last, which is cut off
    order = np.argsort(-best[:-1], kind="stable")
    return [int(room) for room in order if np.isfinite(best[room])]


def _fill(choice: _Choice, count: int) -> None:
    everywhere = np.ones(len(choice.score), bool)
    while len(choice.chosen) < count:
        if choice.take(everywhere) < 0:
            raise TooManyKeypointsError(count, len(choice.chosen))


def _cover_room(building: Building, choice: _Choice, in_room: NDArray[np.bool_], config: KeypointConfig) -> None:
    """Adds keypoints until enough of the room's floor is seen from those it has."""
    members = np.flatnonzero(in_room)
    candidates = choice.candidates
    # The squares of a room follow each other, or those of a building without rooms are all there are.
    first, last = candidates.square[members].min(), candidates.square[members].max() + 1
    square = candidates.square[members] - first
    knees = candidates.squares[first:last] + np.array([0.0, 0.0, _KNEE_M - building.walker.eye_height_m])
    weight = np.bincount(square, minlength=len(knees)) / len(members)
    seen = np.zeros(len(knees), bool)
    unseen = np.zeros_like(in_room)
    new = [i for i in choice.chosen if in_room[i]]
    for _ in range(_ROOM_LIMIT):
        for i in new:
            ask = np.flatnonzero(~seen)
            seen[ask] = sees(building.geometry, candidates.eyes[i], knees[ask], config.view_distance_m)
        if weight[seen].sum() >= config.room_coverage:
            return
        unseen[members] = ~seen[square]
        best = choice.take(unseen)
        if best < 0:
            return
        # Its own square counts as seen even where the sample of it does not.
        seen[candidates.square[best] - first] = True
        new = [best]


def _away_from(candidates: Candidates, chosen: int, distance_m: float) -> NDArray[np.bool_]:
    """Returns the candidates that are farther than the distance from a chosen one; all where none is."""
    far = np.linalg.norm(candidates.eyes - candidates.eyes[chosen], axis=1) > distance_m
    return far if far.any() else np.ones_like(far)


def _skipped(building: Building, served: list[int], count: int) -> tuple[SkippedRoom, ...]:
    found = []
    for index, room in enumerate(building.rooms):
        if index not in served:
            reason = room.reason or "there is no place in it where the walker can stand"
            found.append(SkippedRoom(room=index, reason=reason))
        elif count and index in served[count:]:
            found.append(SkippedRoom(room=index, reason=f"{count} keypoints asked for, {len(served)} rooms"))
    return tuple(found)


def _suggestion(
    building: Building, importance_map: ImportanceMap, choice: _Choice, skipped: tuple[SkippedRoom, ...]
) -> Suggestion:
    chosen = np.array(choice.chosen, dtype=np.int64)
    eyes = choice.candidates.eyes[chosen]
    arrays = {
        "positions": eyes,
        "quat_xyzw": quat_xyzw_from_yaw(view_yaws(building.geometry, importance_map, eyes)),
        "score": np.array(choice.scores),
        "room": choice.candidates.room[chosen],
        "place": choice.candidates.place[chosen],
    }
    for array in arrays.values():
        array.setflags(write=False)
    return Suggestion(**arrays, skipped=skipped)


def snap_keypoint(
    building: Building,
    importance_map: ImportanceMap,
    near: NDArray[np.float64],
    config: KeypointConfig | None = None,
    candidates: Candidates | None = None,
    taken: NDArray[np.float64] | None = None,
) -> Suggestion:
    """Returns the one keypoint to take where the user asks for one "near here".

    The best place within `snap_radius_m`, measured level, on the same storey: importance, lowered by the cones of the
    keypoints that there are, and the farther off the more, by the cone's depth at the radius (our own).

    Args:
        building: The building.
        importance_map: Its maps.
        near: (3,) eye position [m].
        config: `snap_radius_m` and the cone are used.
        candidates: Of the same building and map, from `find_candidates`.
        taken: (K, 3) the keypoints that there are, eye positions [m]; the new one keeps a body's width from them.

    Raises:
        NoPlaceError: There is no place the walker can reach.
        NoPlaceNearError: There is none within the radius, or all there are taken, or the height is no storey's.
    """
    config = config or KeypointConfig()
    candidates = candidates or find_candidates(building, importance_map)
    choice = _Choice(building, candidates, config)
    for tip in np.empty((0, 3)) if taken is None else taken:
        choice.suppress(tip)
    away = candidates.eyes - np.asarray(near, dtype=np.float64)
    distance = np.hypot(away[:, 0], away[:, 1])
    level = np.abs(away[:, 2]) <= STOREY_REACH_M
    free = level & choice.apart
    worth = choice.score - config.cone_depth * distance / config.snap_radius_m
    best = best_candidate(worth, free & (distance <= config.snap_radius_m))
    if best < 0:
        nearest_m = float(distance[free].min()) if free.any() else np.inf
        raise NoPlaceNearError(config.snap_radius_m, nearest_m, on_storey=bool(level.any()))
    choice.take(np.arange(len(distance)) == best)
    return _suggestion(building, importance_map, choice, ())
