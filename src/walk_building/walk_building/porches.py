# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Porches: what is under a roof and yet outdoors. Our own."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Room
from walk_building.indoors import surface_distance

# A porch is open to the ground outside along more than this share of its edge; a hall with its gates open is not.
_OPEN_SHARE = 0.5
# Nowhere in it is one farther from the open than this; under a deck on columns one is.
_DEEPEST_M = 4.0


def porch_places(
    rooms: Sequence[Room],
    places: NDArray[np.float64],
    indptr: NDArray[np.int64],
    neighbours: NDArray[np.int32],
    indoor: NDArray[np.bool_],
) -> NDArray[np.bool_]:
    """Returns the places (P,) of the rooms that are porches: shallow, and open to the ground along most of their edge.

    Args:
        rooms: Found ones; a space that the file declares is what the file says.
        places: (P, 3).
        indptr: (P + 1,) of the neighbour graph.
        neighbours: (E,) of the neighbour graph.
        indoor: (P,) whether there is something above the place.
    """
    source = np.repeat(np.arange(len(places)), np.diff(indptr))
    at_ground = np.zeros(len(places), bool)
    at_ground[source[indoor[source] & ~indoor[neighbours]]] = True
    porch = np.zeros(len(places), bool)
    inside = np.zeros(len(places), bool)
    for room in rooms:
        if not at_ground[room.places].any():
            continue
        inside[room.places] = True
        to_inside = np.add.reduceat(np.append(inside[neighbours], False), indptr[:-1])[room.places]
        inside[room.places] = False
        edge = room.places[to_inside < 8]
        if at_ground[edge].mean() > _OPEN_SHARE:
            away = surface_distance(indptr, neighbours, places, at_ground)
            porch[room.places] = away[room.places].max() <= _DEEPEST_M
    return porch
