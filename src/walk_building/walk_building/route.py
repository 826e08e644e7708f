# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""One way on foot, searched afresh in a millisecond or two: no roadmap, nothing kept but the floor itself."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_building.floor_grid import lay_floor, step_cost
from walk_building.heap import pop, push
from walk_building.surface_kernels import nearest_place
from walk_building.tighten import follow_floor, tighten

_SNAP_M = 0.5  # farthest that an end may be from a place to stand on
_MOST_PLACES = 40_000  # looked at in one search: some 400 m² of floor, three milliseconds
_FLOOR_M = 0.02  # largest height by which the way's straight pieces leave the floor
# A metre along a wall costs as much as two with room, which is so much beyond the body: a way then has some to both
# sides. Whoever smooths it wants it there; the sequencer's legs have prices of their own.
_COMFORT_M, _COMFORT_WEIGHT = 0.2, 1.0


class Router:
    """Finds ways over the part of the surface that a tour may use. Not safe to share between threads."""

    def __init__(self, building: Building) -> None:
        """Lays the floor out; takes tenths of a second in a large building."""
        self._surface = building.surface
        self._walker = building.walker
        self._ground, kept = lay_floor(
            building.surface, building.reachable, building.walker.eye_height_m, _COMFORT_M, _COMFORT_WEIGHT
        )
        self._local = np.full(len(building.surface.places), -1, dtype=np.int64)
        self._local[kept] = np.arange(len(kept))
        # Kept from search to search: what a search has not written counts as never seen.
        self._seen = np.zeros(len(kept), dtype=np.int64)
        self._cost = np.empty(len(kept))
        self._came = np.empty(len(kept), dtype=np.int32)
        self._searches = 0

    def way(self, start: NDArray[np.float64], end: NDArray[np.float64]) -> NDArray[np.float64] | None:
        """Returns the eye positions (L, 3) of a short way between two eye positions, which are its ends.

        None where an end is nowhere near the floor, or the way is none or a long one.
        """
        a, b = self._place(start), self._place(end)
        if a < 0 or b < 0:
            return None
        self._searches += 1
        places = _search(self._ground, a, b, self._seen, self._cost, self._came, self._searches, _MOST_PLACES)
        if len(places) < 2:
            return None
        steps = np.column_stack([places, self._ground.xyz[places, :2]])
        points = follow_floor(self._ground, tighten(self._ground, steps), _FLOOR_M).copy()
        eye = self._walker.eye_height_m
        points[:, 2] += eye
        floor = self._surface.floor_z(points, eye)
        points[:, 2] = np.where(np.isfinite(floor), floor + eye, points[:, 2])
        points[0], points[-1] = start, end
        return points

    def _place(self, eye: NDArray[np.float64]) -> int:
        """Returns the place of the floor grid nearest to where an eye stands, -1 for none."""
        surface = self._surface
        reach = 2 * surface.step_m
        place = nearest_place(surface.grid, eye[0], eye[1], eye[2] - self._walker.eye_height_m, reach, _SNAP_M)
        return int(self._local[place]) if place >= 0 else -1


@numba.njit(cache=True, nogil=True)
def _search(ground, start, goal, seen, cost, came, number, most):
    """Returns the places (n,) of the cheapest way from start to goal, none where there is none or it is far (A*)."""
    keys, items, size = np.empty(8 * most), np.empty(8 * most, np.int32), 0
    seen[start], cost[start], came[start] = number, 0.0, -1
    push(keys, items, size, _ahead(ground, start, goal), start)
    size += 1
    for _ in range(most):
        if size == 0:
            break
        key, p = keys[0], items[0]
        pop(keys, items, size)
        size -= 1
        if p == goal:
            return _back(came, goal)
        if key > cost[p] + _ahead(ground, p, goal) + 1e-9:
            continue
        for k in range(9):
            q = ground.step[p, k]
            if q < 0:
                continue
            new = cost[p] + step_cost(ground, p, q)
            if seen[q] != number or new < cost[q]:
                seen[q], cost[q], came[q] = number, new, p
                push(keys, items, size, new + _ahead(ground, q, goal), q)
                size += 1
    return np.empty(0, np.int64)


@numba.njit(cache=True, nogil=True)
def _ahead(ground, p, goal):
    """What is left at least: a metre costs one or more."""
    x = ground.xyz[goal, 0] - ground.xyz[p, 0]
    y = ground.xyz[goal, 1] - ground.xyz[p, 1]
    z = ground.xyz[goal, 2] - ground.xyz[p, 2]
    return np.sqrt(x * x + y * y + z * z)


@numba.njit(cache=True, nogil=True)
def _back(came, goal):
    count, p = 1, goal
    while came[p] >= 0:
        p = came[p]
        count += 1
    out, p = np.empty(count, np.int64), goal
    for i in range(count - 1, -1, -1):
        out[i] = p
        p = came[p]
    return out
