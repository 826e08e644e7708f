# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Where the walker stands for each keypoint, or why it cannot get there."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from walk_building.building import Building
from walk_building.errors import ParameterError
from walk_sequencer.config import SequencerConfig
from walk_sequencer.pairs import stand_at
from walk_sequencer.roadmap import Roadmap
from walk_sequencer.tour import Stand, Unreachable


def floor_points(building: Building, keypoints: ArrayLike) -> NDArray[np.float64]:
    """Returns the points (K, 3) an eye height below the keypoints.

    Raises:
        ParameterError: The keypoints are not a (K, 3) array of finite numbers.
    """
    points = np.asarray(keypoints, dtype=np.float64)
    if points.size == 0:
        points = points.reshape(0, 3)
    if points.ndim != 2 or points.shape[1] != 3:
        raise ParameterError("keypoints", f"of shape {points.shape}", "shape (K, 3): x, y, z of each eye position in m")
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(bad):
        raise ParameterError("keypoints", points[bad[0]].tolist(), f"finite coordinates for keypoint {bad[0]}")
    return points - [0.0, 0.0, building.walker.eye_height_m]


def part_of_tour(building: Building, floor: NDArray[np.float64], config: SequencerConfig) -> NDArray[np.bool_]:
    """Returns the places (P,) of the part that the tour is in: the start keypoint's, else the building's own.

    A start keypoint that is nowhere near a floor, or not indoors, does not move the tour.
    """
    surface = building.surface
    if config.start >= 0:
        point = floor[config.start]
        place = int(surface.nearest(point[None])[0])
        near = float(np.linalg.norm(surface.places[place] - point)) <= config.snap_m
        if near and not building.reachable[place] and surface.component[place] >= 0:
            return np.asarray(surface.component == surface.component[place])
    return building.reachable


def place_keypoints(
    building: Building, roadmap: Roadmap, floor: NDArray[np.float64], config: SequencerConfig
) -> tuple[dict[int, Stand], tuple[Unreachable, ...]]:
    """Returns the stand of each keypoint that can be reached, and the reason for each that cannot.

    The nearest place counts; one of the tour's part that is a cell farther is preferred to a nearer one elsewhere,
    but no keypoint is drawn through a wall to the part beyond it.
    """
    own_gap, own = roadmap.floor_tree.query(floor)
    # Within a cell no other part can be preferred, and the search among all places can be spared.
    far = np.flatnonzero(own_gap > building.surface.cell_m)
    other, other_gap = np.full(len(floor), -1), np.zeros(len(floor))
    if len(far):
        other[far] = building.surface.nearest(floor[far])
        other_gap[far] = np.linalg.norm(building.surface.places[other[far]] - floor[far], axis=1)
    stands, unreachable = {}, []
    for k, point in enumerate(floor):
        if own_gap[k] <= min(config.snap_m, other_gap[k] + building.surface.cell_m):
            stands[k] = stand_at(roadmap, int(own[k]), point)
        elif other_gap[k] <= config.snap_m:
            unreachable.append(Unreachable(index=k, reason=_elsewhere(building, int(other[k]))))
        else:
            unreachable.append(Unreachable(index=k, reason=_no_floor(building, float(other_gap[k]), config)))
    return stands, tuple(unreachable)


def _elsewhere(building: Building, place: int) -> str:
    surface = building.surface
    part = int(surface.component[place])
    if part < 0:
        return "outdoors, where the tour does not go: allow outdoors to include it"
    area = float(np.count_nonzero(surface.component == part)) * surface.place_area_m2
    storey = building.storeys[int(surface.storey[place])].name if building.storeys else "?"
    return f"not connected on foot to the start: it is on a part of {area:.0f} m² on storey {storey}"


def _no_floor(building: Building, gap_m: float, config: SequencerConfig) -> str:
    eye = building.walker.eye_height_m
    where = f"within {config.snap_m:g} m of the point {eye:g} m below it"
    # Whoever writes a table by hand takes the floor's height for the eye's first of all.
    hint = "; z is the eye's height: is it the floor's here?" if abs(gap_m - eye) <= config.snap_m else ""
    return f"no floor to stand on {where}; the nearest is {gap_m:.2f} m away{hint}"
