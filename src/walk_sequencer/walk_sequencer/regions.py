# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Which milestone each place is nearest to on foot, and which milestones are neighbours that way."""

from __future__ import annotations

import dataclasses

import numba
import numpy as np
from numpy.typing import NDArray

from walk_building.floor_grid import FloorGrid, step_cost
from walk_building.heap import pop, push


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Regions:
    """The ground split among the milestones by walking cost (a Voronoi diagram on foot)."""

    owner: NDArray[np.int32]  # (N,) milestone, -1 where none can be reached
    cost: NDArray[np.float64]  # (N,) of the way to it
    toward: NDArray[np.int32]  # (N,) the next place on that way; a milestone's own place points at itself


def split_ground(ground: FloorGrid, milestones: NDArray[np.int64]) -> Regions:
    """Returns the regions of the milestones (places, all different), by Dijkstra from all of them at once."""
    owner, cost, toward = _spread(ground, milestones)
    return Regions(owner=owner, cost=cost, toward=toward)


def neighbouring_regions(ground: FloorGrid, regions: Regions) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Returns the cheapest crossing between every two regions that touch.

    If the ground is connected, the milestones with these crossings as edges are connected too.

    Returns:
        (B, 4) int: milestones m < n and places u in m's region, v in n's, one step apart; and the cost (B,) of the
        way from m over u and v to n.
    """
    crossing, cost = _borders(ground, regions.owner, regions.cost)
    best = np.lexsort((crossing[:, 2], cost, crossing[:, 1], crossing[:, 0]))
    crossing, cost = crossing[best], cost[best]
    first = np.ones(len(cost), dtype=bool)
    first[1:] = np.any(crossing[1:, :2] != crossing[:-1, :2], axis=1)
    return crossing[first], cost[first]


def way_home(regions: Regions, place: int) -> list[int]:
    """Returns the places from `place` to its milestone, both included."""
    way = [place]
    while regions.toward[way[-1]] != way[-1]:
        way.append(int(regions.toward[way[-1]]))
    return way


@numba.njit(cache=True, nogil=True)
def _spread(ground, sources):
    n = len(ground.xyz)
    owner = np.full(n, -1, dtype=np.int32)
    toward = np.full(n, -1, dtype=np.int32)
    cost = np.full(n, np.inf)
    keys, items, size = np.empty(8 * n + len(sources)), np.empty(8 * n + len(sources), dtype=np.int32), 0
    for m in range(len(sources)):
        p = sources[m]
        owner[p], toward[p], cost[p] = m, p, 0.0
        push(keys, items, size, 0.0, p)
        size += 1
    while size > 0:
        key, p = keys[0], items[0]
        pop(keys, items, size)
        size -= 1
        if key > cost[p]:
            continue
        for k in range(9):
            q = ground.step[p, k]
            if q < 0:
                continue
            new = key + step_cost(ground, p, q)
            if new < cost[q]:
                owner[q], toward[q], cost[q] = owner[p], p, new
                push(keys, items, size, new, q)
                size += 1
    return owner, cost, toward


@numba.njit(cache=True, nogil=True)
def _borders(ground, owner, cost):
    count = 0
    for p in range(len(owner)):
        for k in range(9):
            q = ground.step[p, k]
            if q >= 0 and owner[p] >= 0 and owner[p] < owner[q]:
                count += 1
    crossing, total, at = np.empty((count, 4), dtype=np.int64), np.empty(count), 0
    for p in range(len(owner)):
        for k in range(9):
            q = ground.step[p, k]
            if q >= 0 and owner[p] >= 0 and owner[p] < owner[q]:
                crossing[at, 0], crossing[at, 1], crossing[at, 2], crossing[at, 3] = owner[p], owner[q], p, q
                total[at] = cost[p] + step_cost(ground, p, q) + cost[q]
                at += 1
    return crossing, total
