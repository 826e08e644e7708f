# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Where one comes into the building. Our own.

The widest way in from the ground outside on the lowest floor; where no ground is drawn, the widest door of the lowest
floor with the building on one side of it only.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from walk_building.model import Door

# An entrance is at most this far above the lowest floor: not a roof terrace, but one may go up some steps to it.
_ABOVE_LOWEST_M = 1.5
# Whoever comes in stands on at least this much ground outside.
_MIN_GROUND_M2 = 3.0
# A walker stands this near to the middle of a door, on the one side of it or the other.
_BESIDE_DOOR_M = 1.0


def find_entrance(
    places: NDArray[np.float64],
    indptr: NDArray[np.int64],
    neighbours: NDArray[np.int32],
    component: NDArray[np.int32],
    reachable: NDArray[np.bool_],
    *,
    place_area_m2: float,
    doors: tuple[Door, ...] = (),
) -> int:
    """Returns the reachable place (index) in the middle of the main way in, -1 where none is seen.

    A way in is a group of reachable places beside places outdoors. Of several on the lowest floor the one with the
    most places side by side is taken, that is the widest. Where there is none, an outer door is, see _outer_door.
    """
    source = np.repeat(np.arange(len(places)), np.diff(indptr))
    crossing = reachable[source] & ~reachable[neighbours]
    ground = np.bincount(component, minlength=int(component.max()) + 1) * place_area_m2
    crossing &= ground[component[neighbours]] >= _MIN_GROUND_M2
    sill = np.unique(source[crossing])
    if len(sill):
        sill = sill[places[sill, 2] <= places[reachable, 2].min() + _ABOVE_LOWEST_M]
    if len(sill) == 0:
        return _outer_door(places, reachable, doors)
    at_sill = np.zeros(len(places), bool)
    at_sill[sill] = True
    along = at_sill[source] & at_sill[neighbours]
    shape = (len(places), len(places))
    graph = csr_array((np.ones(int(along.sum()), np.int8), (source[along], neighbours[along])), shape=shape)
    group = connected_components(graph[sill][:, sill], directed=False)[1]
    widest = sill[group == np.bincount(group).argmax()]
    middle = places[widest].mean(axis=0)
    return int(widest[np.argmin(np.linalg.norm(places[widest] - middle, axis=1))])


def _outer_door(places: NDArray[np.float64], reachable: NDArray[np.bool_], doors: tuple[Door, ...]) -> int:
    """Returns the reachable place at the widest door of the lowest floor with places on one side only, else -1.

    A door's sides are told by the thin side of its box, so doors askew to the axes are not looked at.
    """
    inside = np.flatnonzero(reachable)
    if len(inside) == 0 or not doors:
        return -1
    lowest, tree, reached = places[inside, 2].min(), cKDTree(places), cKDTree(places[inside])
    best, widest = -1, 0.0
    for door in doors:
        across = int(np.argmin(door.size[:2]))
        width = float(door.size[1 - across])
        floor = door.centre - [0.0, 0.0, door.size[2] / 2]
        if width <= widest or 2 * door.size[across] > width or floor[2] > lowest + _ABOVE_LOWEST_M:
            continue
        step = np.zeros(3)
        step[across] = _BESIDE_DOOR_M / 2 + door.size[across] / 2
        sides = np.array([floor - step, floor + step])
        within = _BESIDE_DOOR_M / 2
        taken = tree.query(sides, distance_upper_bound=within)[0] < within
        away, nearest = reached.query(sides, distance_upper_bound=within)
        if taken.sum() == 1 and away.min() < within:
            best, widest = int(inside[nearest[away.argmin()]]), width
    return best
