# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The rooms of a building: its declared spaces, and pieces of the surface where none are declared."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from walk_building.building import Room
from walk_building.floor_plan import floor_plan
from walk_building.ground import Ground
from walk_building.model import Model, Storey
from walk_building.raster import Columns
from walk_building.segmentation import drop_small, segment_plan, spread
from walk_building.storeys import storey_of

_OUTDOORS = "it is outdoors: there is nothing above it"
# What a walker can stand on in the smallest closet; less is a doorstep.
_MIN_ROOM_M2 = 0.4
# A found part that nobody reaches and that is smaller than this is the top of a cupboard, not worth a line.
_MIN_UNREACHED_ROOM_M2 = 10.0
# A body that stands beside a podium is so far from whoever stands at its edge.
_BESIDE_M = 0.7
# Higher is another storey, not a podium.
_RAISED_M = 2.0


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class _Floor:
    """What is known of the places when rooms are looked for; all (P,) but places, (P, 3)."""

    places: NDArray[np.float64]
    clearance_m: NDArray[np.float64]
    component: NDArray[np.int32]
    reachable: NDArray[np.bool_]
    place_area_m2: float
    storeys: tuple[Storey, ...]
    step_m: float


def find_rooms(
    ground: Ground,
    indoor: NDArray[np.bool_],
    component: NDArray[np.int32],
    reachable: NDArray[np.bool_],
) -> tuple[tuple[Room, ...], NDArray[np.int32]]:
    """Returns the rooms, declared ones first, and the room of each place (P,), -1 for none.

    Indoor places on storeys without spaces, or of models without, are segmented.
    """
    model, places, space = ground.model, ground.places, ground.space
    floor = _Floor(
        places=places, clearance_m=ground.clearance_m, component=component, reachable=reachable,
        place_area_m2=ground.columns.cell_m**2, storeys=ground.storeys, step_m=ground.step_m,
    )  # fmt: skip
    rooms = [_declared_room(index, space, indoor, model, floor) for index in range(len(model.spaces))]
    left = indoor & (space < 0) & _without_spaces(model, ground.storeys, places[:, 2])
    large = _large(component, left, ground.columns)
    divided = left & (reachable | ((not model.spaces) & large))
    label = _segment(ground, divided, indoor)
    # What nobody reaches, if it is small or beside declared spaces, is not looked into: each part is one entry.
    rest = left & (label < 0)
    label[rest] = label.max() + 1 + np.unique(component[rest], return_inverse=True)[1]
    # A stair that breaks leaves its room in two: the piece that is reached must not hide the one that is not.
    label = np.where(label >= 0, 2 * label + reachable, -1).astype(np.int32)
    rooms += _found_rooms(label, large, floor)
    room = np.full(len(places), -1, np.int32)
    for index, found in enumerate(rooms):
        room[found.places] = index
    return tuple(rooms), room


def _declared_room(
    index: int, space: NDArray[np.int32], indoor: NDArray[np.bool_], model: Model, floor: _Floor
) -> Room:
    """The room of a space that the file declares."""
    declared, standable = model.spaces[index], space == index
    members = np.flatnonzero(standable & indoor)
    storey = next((i for i, s in enumerate(floor.storeys) if s.name == declared.storey), None)
    if storey is None:
        base = np.array([declared.vertices[:, 2].min()])
        storey = int(storey_of(floor.storeys, base)[0])
    room = _room(declared.label, storey, members, declared.vertices.mean(axis=0), floor)
    under_the_sky = len(members) == 0 and bool(standable.any())
    return dataclasses.replace(room, reason=_OUTDOORS) if under_the_sky else room


def _segment(ground: Ground, divided: NDArray[np.bool_], indoor: NDArray[np.bool_]) -> NDArray[np.int32]:
    """The piece of each place (P,) of `divided`, storey by storey; -1 for the others."""
    places, columns, indptr, neighbours = ground.places, ground.columns, ground.indptr, ground.neighbours
    level = storey_of(ground.storeys, places[:, 2])
    label = np.full(len(places), -1, np.int32)
    for storey in np.unique(level[divided]):
        here = level == storey
        plan = floor_plan(
            ground.geometry, columns, ground.hits, ground.column, places, divided & here, here & ~indoor, ground.step_m
        )
        piece = segment_plan(plan, columns.cell_m)
        at = (plan.place >= 0) & (piece >= 0)
        label[plan.place[at]] = piece[at] + label.max() + 1
    spread(indptr, neighbours, divided, level, label)
    drop_small(label, int(np.ceil(_MIN_ROOM_M2 / columns.cell_m**2)))
    spread(indptr, neighbours, divided, level, label)
    # Parts too small for a room: one with the storey beside them, or by themselves.
    spread(indptr, neighbours, divided, np.zeros_like(level), label)
    return label


def _large(component: NDArray[np.int32], left: NDArray[np.bool_], columns: Columns) -> NDArray[np.bool_]:
    """Whether each place (P,) is of a part that is worth a line of its own where nobody reaches it."""
    area = np.bincount(component, weights=left) * columns.cell_m**2
    return np.asarray(area[component] >= _MIN_UNREACHED_ROOM_M2)


def _without_spaces(model: Model, storeys: tuple[Storey, ...], z: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether each height (P,) lies on a storey for which the file declares no space."""
    if not model.spaces:
        return np.ones(len(z), bool)
    with_spaces = {space.storey for space in model.spaces}
    bare = np.array([bool(model.storeys) and storey.name not in with_spaces for storey in storeys])
    return np.asarray(bare[storey_of(storeys, z)])


def _found_rooms(label: NDArray[np.int32], large: NDArray[np.bool_], floor: _Floor) -> list[Room]:
    """The segmented pieces as rooms, named by storey and size."""
    inside = np.flatnonzero(label >= 0)
    if len(inside) == 0:
        return []
    inside = inside[np.argsort(label[inside], kind="stable")]
    pieces = np.split(inside, np.flatnonzero(np.diff(label[inside])) + 1)
    found = []
    for members in sorted(pieces, key=len, reverse=True):
        if not (floor.reachable[members].any() or large[members].any()):
            continue
        height = np.array([np.median(floor.places[members, 2])])
        storey = int(storey_of(floor.storeys, height)[0])
        found.append(_room("", storey, members, floor.places[members].mean(axis=0), floor))
    found.sort(key=lambda r: (r.storey, not r.reachable))
    count = dict.fromkeys(range(len(floor.storeys)), 0)
    named = []
    for piece in found:
        count[piece.storey] += 1
        kind = "room" if piece.reachable else "separate part"
        name = f"{floor.storeys[piece.storey].name}, {kind} {count[piece.storey]}"
        named.append(dataclasses.replace(piece, name=name))
    return named


def _room(name: str, storey: int, members: NDArray[np.int64], middle: NDArray[np.float64], floor: _Floor) -> Room:
    """A room of the given places, less the tops of its furniture: what is cut off from its largest part."""
    reached = members[floor.reachable[members]]
    best = reached
    if len(reached) == 0 and len(members) > 0:
        part = floor.component[members]
        best = members[part == np.bincount(part).argmax()]
    centre = floor.places[best[np.argmax(floor.clearance_m[best])]] if len(best) else middle
    return Room(
        name=name,
        storey=storey,
        area_m2=len(best) * floor.place_area_m2,
        centre=centre,
        places=best,
        reachable=len(reached) > 0,
        reason="" if len(reached) else _reason(best, floor),
    )


def _reason(members: NDArray[np.int64], floor: _Floor) -> str:
    """Why a room without a reachable place has none; its places are of one part."""
    if len(members) == 0:
        return "nowhere in it is there room for the walker to stand"
    part = floor.component == floor.component[members[0]]
    z = floor.places[part, 2]
    return (
        f"no way on foot leads there from where the tour starts: it lies in a separate part of "
        f"{part.sum() * floor.place_area_m2:.0f} m² at heights {z.min():.1f} to {z.max():.1f} m"
        f"{_raised(floor.places[part], floor)}"
    )


def _raised(part: NDArray[np.float64], floor: _Floor) -> str:
    """By how much a part, its places (n, 3), stands above reached floor beside it: a podium, a stage, a table."""
    beside = floor.reachable.copy()
    low, high = part.min(axis=0), part.max(axis=0)
    low, high = low - [_BESIDE_M, _BESIDE_M, _RAISED_M], high + [_BESIDE_M, _BESIDE_M, 0.0]
    beside[beside] = ((floor.places[beside] >= low) & (floor.places[beside] <= high)).all(axis=1)
    if not beside.any():
        return ""
    below = floor.places[beside]
    distance, nearest = cKDTree(below[:, :2]).query(part[:, :2], distance_upper_bound=_BESIDE_M)
    rise = part[np.isfinite(distance), 2] - below[nearest[np.isfinite(distance)], 2]
    rise = rise[(rise > floor.step_m) & (rise <= _RAISED_M)]
    if len(rise) == 0:
        return ""
    return f", raised by {rise.min():.2f} m above the floor beside it; a step is at most {floor.step_m:g} m"
