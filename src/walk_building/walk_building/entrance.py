# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Where one comes into the building: the widest way in from outdoors on the lowest floor. Our own."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

# An entrance is at most this far above the lowest floor: not a roof terrace, but one may go up some steps to it.
_ABOVE_LOWEST_M = 1.5
# Whoever comes in stands on at least this much ground outside.
_MIN_GROUND_M2 = 3.0


def find_entrance(
    places: NDArray[np.float64],
    indptr: NDArray[np.int64],
    neighbours: NDArray[np.int32],
    component: NDArray[np.int32],
    reachable: NDArray[np.bool_],
    *,
    place_area_m2: float,
) -> int:
    """Returns the reachable place (index) in the middle of the main way in, -1 where none leads in.

    A way in is a group of reachable places beside places outdoors. Of several on the lowest floor the one with the
    most places side by side is taken, that is the widest.
    """
    source = np.repeat(np.arange(len(places)), np.diff(indptr))
    crossing = reachable[source] & ~reachable[neighbours]
    ground = np.bincount(component, minlength=int(component.max()) + 1) * place_area_m2
    crossing &= ground[component[neighbours]] >= _MIN_GROUND_M2
    sill = np.unique(source[crossing])
    if len(sill):
        sill = sill[places[sill, 2] <= places[reachable, 2].min() + _ABOVE_LOWEST_M]
    if len(sill) == 0:
        return -1
    at_sill = np.zeros(len(places), bool)
    at_sill[sill] = True
    along = at_sill[source] & at_sill[neighbours]
    shape = (len(places), len(places))
    graph = csr_array((np.ones(int(along.sum()), np.int8), (source[along], neighbours[along])), shape=shape)
    group = connected_components(graph[sill][:, sill], directed=False)[1]
    widest = sill[group == np.bincount(group).argmax()]
    middle = places[widest].mean(axis=0)
    return int(widest[np.argmin(np.linalg.norm(places[widest] - middle, axis=1))])
