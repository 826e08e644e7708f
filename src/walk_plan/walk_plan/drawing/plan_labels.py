# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What is written on a storey's plan: numbers of keypoints, names of rooms, where the walk goes up or down."""

from __future__ import annotations

import itertools

import matplotlib.patheffects as effects
import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_plan.drawing import style
from walk_plan.drawing.labels import LabelBoard, ring
from walk_plan.profile import storeys_along
from walk_plan.walkthrough import Walkthrough

_HALO = [effects.withStroke(linewidth=1.8, foreground="white")]
_ROOM_SIZES_PT = (style.SMALL_PT, 6.0, 5.0)


def label_keypoints(board: LabelBoard, walkthrough: Walkthrough, storey: int) -> None:
    """Draws each keypoint of the storey as a circle with its number; circles that would overlap move aside."""
    keypoints = walkthrough.keypoints
    here = np.flatnonzero(storeys_along(walkthrough.building, keypoints) == storey)
    diameter = 10.5 if len(keypoints) < 100 else 12.5
    box = (diameter * board.pixels_per_point,) * 2
    for i in here:
        exact = board.to_pixels(keypoints[i : i + 1, :2])[0]
        candidates = ring(exact, (1.05 * box[0], 1.5 * box[0], 2.1 * box[0]))
        found = board.place(candidates, box)
        centre = exact if found is None else found
        at, anchor = board.to_map(np.stack([centre, exact]))
        if np.any(centre != exact):
            board.axes.plot([at[0], anchor[0]], [at[1], anchor[1]], color=style.INK, linewidth=0.6, zorder=6)
            board.axes.plot(*anchor, marker="o", markersize=2.2, color=style.INK, zorder=6)
        edge = style.START if i == 0 else style.END if i == len(keypoints) - 1 else style.INK
        fill = edge if edge != style.INK else style.MARK
        board.axes.plot(
            *at, marker="o", markersize=diameter - 1.2, markerfacecolor=fill, markeredgecolor=edge,
            markeredgewidth=0.9, zorder=7,
        )  # fmt: skip
        ink = style.INK if fill == style.MARK else "white"
        board.axes.annotate(
            str(i + 1), at, ha="center", va="center_baseline", fontsize=5.6, weight="bold", color=ink, zorder=8
        )


def label_passages(
    board: LabelBoard, building: Building, storey: int, exits: tuple[tuple[NDArray[np.float64], int], ...]
) -> None:
    """Says at each place where the walk leaves the storey to which one it goes."""
    for position, target in exits:
        if target < 0 or target == storey:
            continue
        arrow = "\N{BLACK UP-POINTING TRIANGLE}" if target > storey else "\N{BLACK DOWN-POINTING TRIANGLE}"
        text = f"{arrow} {building.storeys[target].name}"
        width, height = board.text_size(text, style.SMALL_PT, "bold")
        exact = board.to_pixels(position[None, :])[0]
        found = board.place(ring(exact, (0.6 * width, 0.9 * width, 1.3 * width))[1:], (width + 4, height))
        if found is not None:
            at = board.to_map(found[None, :])[0]
            board.axes.annotate(
                text, tuple(position), xytext=tuple(at), ha="center", va="center", fontsize=style.SMALL_PT,
                weight="bold", color=style.INK, path_effects=_HALO, zorder=8,
                arrowprops={"arrowstyle": "-", "linewidth": 0.5, "color": style.INK, "shrinkA": 0, "shrinkB": 0},
            )  # fmt: skip


def label_rooms(board: LabelBoard, building: Building, storey: int, drawn: NDArray[np.float64]) -> None:
    """Writes each room's name where it covers nothing; what fits nowhere in small type is left to the table.

    Args:
        board: Where boxes are taken already.
        building: With the rooms.
        storey: Which ones.
        drawn: (k, 2) points of walls and of the path, which names should not cover [m].
    """
    avoid = board.to_pixels(drawn) if len(drawn) else np.zeros((0, 2))
    level = building.storeys[storey].name
    rooms = [room for room in building.rooms if room.storey == storey and len(room.places)]
    for room in sorted(rooms, key=lambda room: (not room.reachable, -room.area_m2)):
        centres = board.to_pixels(_roomiest(building, room.places)[:, :2])
        for size_pt, text in itertools.product(_ROOM_SIZES_PT, _wordings(short_name(room.name, level), room.area_m2)):
            width, height = board.text_size(text, size_pt)
            found = board.place(centres, (width + 2, height), avoid)
            if found is not None:
                _write_room(board, found, text, size_pt, style.INK if room.reachable else style.FAINT)
                break


def short_name(name: str, storey: str) -> str:
    """Returns a room's name without its storey's, which the plan's title tells."""
    rest = name.removeprefix(f"{storey}, ")
    return rest[:1].upper() + rest[1:] if rest != name else name


def _write_room(board: LabelBoard, at: NDArray[np.float64], text: str, size_pt: float, colour: str) -> None:
    board.axes.annotate(
        text, tuple(board.to_map(at[None, :])[0]), ha="center", va="center", fontsize=size_pt, color=colour,
        linespacing=1.1, path_effects=_HALO, zorder=6.5,
    )  # fmt: skip


def _wordings(name: str, area_m2: float) -> tuple[str, ...]:
    area = f"{area_m2:.0f} m²" if area_m2 >= 10 else f"{area_m2:.1f} m²"
    words = name.split()
    half = (len(words) + 1) // 2
    broken = "\n".join([" ".join(words[:half]), " ".join(words[half:])])
    return (f"{name}\n{area}", name, broken) if len(words) > 1 else (f"{name}\n{area}", name)


def _roomiest(building: Building, places: NDArray[np.int64], count: int = 80) -> NDArray[np.float64]:
    """Returns places of a room that are far from its edge and from each other, best first, (n, 3) [m]."""
    some = places[:: max(len(places) // 20_000, 1)]
    order = some[np.argsort(-building.surface.clearance_m[some], kind="stable")]
    positions = building.surface.places[order]
    cells = np.round(positions[:, :2] / 0.3)
    first = np.sort(np.unique(cells, axis=0, return_index=True)[1])
    return np.asarray(positions[first[:count]])
