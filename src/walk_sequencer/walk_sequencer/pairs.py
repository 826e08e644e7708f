# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Legs between stands: the cheapest ways over the roadmap, each made short and laid on the floor."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

from walk_building.progress import Progress, no_progress
from walk_building.tighten import follow_floor, tighten
from walk_sequencer.roadmap import Roadmap
from walk_sequencer.tour import Leg, Stand, polyline_length_m
from walk_sequencer.ways import centre, straight_cost, way, ways_from

_THREADS = 2
_PIECE = 32  # legs that a thread takes at once; handing over a single one costs as much as planning it


def stand_at(roadmap: Roadmap, place: int, point: NDArray[np.float64]) -> Stand:
    """Returns where to stand for a floor point (3,) next to a place of the ground.

    That is the point itself if all around it is ground, else the centre of the place.
    """
    middle = centre(roadmap, place)
    stand = Stand(place, float(point[0]), float(point[1]))
    return stand if straight_cost(roadmap, middle, stand) < np.inf else middle


def plan_pairs(
    roadmap: Roadmap,
    stands: Sequence[Stand],
    pairs: Sequence[tuple[int, int]],
    progress: Progress = no_progress,
) -> list[Leg]:
    """Returns a leg for each pair of indices into `stands`.

    The stands are joined to the roadmap, the cheapest ways are searched on its graph from every stand, then each way
    is tightened by itself. All stands of a roadmap can reach one another, so no leg is missing. No way leads over a
    third stand, so a leg depends on its own two ends only: planned alone it is the same.
    """
    if not pairs:
        return []
    ways = ways_from(roadmap, stands)
    progress("legs", 0.3)

    def lay(piece: Sequence[tuple[int, int]]) -> list[NDArray[np.float64]]:
        short = (tighten(roadmap.ground, way(roadmap, ways[i], ways[j])) for i, j in piece)
        return [follow_floor(roadmap.ground, points, roadmap.config.slope_break_m) for points in short]

    pieces = [pairs[at : at + _PIECE] for at in range(0, len(pairs), _PIECE)]
    with ThreadPoolExecutor(_THREADS) as pool:
        floors = [floor for piece in pool.map(lay, pieces) for floor in piece]
    progress("legs", 0.8)
    eyes = _raise_to_eyes(roadmap, floors)
    progress("legs", 1.0)
    return [
        Leg(start=i, goal=j, points=points, length_m=polyline_length_m(points))
        for (i, j), points in zip(pairs, eyes, strict=True)
    ]


def _raise_to_eyes(roadmap: Roadmap, floors: list[NDArray[np.float64]]) -> list[NDArray[np.float64]]:
    """Returns the eye positions above floor points, for all legs in one query of the floor."""
    eye = roadmap.walker.eye_height_m
    points = np.vstack(floors)
    points[:, 2] += eye
    floor = roadmap.surface.floor_z(points, eye)
    points[:, 2] = np.where(np.isfinite(floor), floor + eye, points[:, 2])
    points.setflags(write=False)
    return np.split(points, np.cumsum([len(f) for f in floors])[:-1])
