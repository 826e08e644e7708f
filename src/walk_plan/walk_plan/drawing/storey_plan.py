# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The plan of one storey: walls as the building is cut, rooms, keypoints in order, the planned and the final path."""

from __future__ import annotations

import dataclasses
import itertools

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from numpy.typing import NDArray

from walk_building.building import Building
from walk_plan.along import densified, walked_m
from walk_plan.drawing import style
from walk_plan.drawing.floor import away_from_floor, storey_bounds, tinted_floor
from walk_plan.drawing.labels import LabelBoard
from walk_plan.drawing.plan_foot import CLEARANCE_NORM, draw_foot
from walk_plan.drawing.plan_labels import label_keypoints, label_passages, label_rooms
from walk_plan.profile import storeys_along
from walk_plan.section import Section, cut
from walk_plan.walkthrough import Walkthrough

CUT_HEIGHT_M = 1.2
"""Height above its floor at which a storey is cut, as architects do: through doors and windows."""

FURNITURE_HEIGHT_M = 0.45
"""Height above the floor at which furniture is cut, drawn thin."""

_MAX_HEIGHT_IN = 8.0
_NARROW_IN = 5.1  # two plans of this width stand side by side
_FOOT_IN = 0.86  # room for legend, scale bar and colours below the plan
_SOLID = ("mesh", "IfcWall", "IfcColumn", "IfcSlab", "IfcBeam", "IfcFooting", "IfcBuildingElementProxy")


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class StoreyWalk:
    """What of the walk is on one storey, in map coordinates."""

    pieces: tuple[NDArray[np.float64], ...]  # (k, 2) each: the final path, cut where it leaves the storey
    clearance_m: tuple[NDArray[np.float64], ...]  # (k,) each
    planned: tuple[NDArray[np.float64], ...]  # (k, 2) each
    exits: tuple[tuple[NDArray[np.float64], int], ...]  # where the walk leaves, and to which storey


def draw_storey(walkthrough: Walkthrough, storey: int) -> Figure:
    """Returns the plan of a storey."""
    building = walkthrough.building
    low, high = storey_bounds(building, storey)
    width, height = high - low
    inches = min(style.WIDTH_IN / width, _MAX_HEIGHT_IN / height)
    # The picture may be wider than the building: the legend needs room, and two narrow plans share a line.
    wide = _NARROW_IN if width * inches <= _NARROW_IN else style.WIDTH_IN
    made = style.figure(wide, height * inches + _FOOT_IN)
    foot = _FOOT_IN / made.get_figheight()
    axes = made.add_axes((0.0, foot, 1.0, 1.0 - foot))
    aside = (wide / inches - width) / 2
    style.plain_map(axes, low - [aside, 0.0], high + [aside, 0.0])
    tinted_floor(axes, building, storey)
    low_cut, walls = cut_storey(building, storey)
    draw_cut(axes, low_cut, walls)
    walk = storey_walk(walkthrough, storey)
    _draw_walk(axes, walk)
    board = LabelBoard(axes)
    label_keypoints(board, walkthrough, storey)
    label_passages(board, building, storey, walk.exits)
    spacing = 3.0 / (72.0 * inches)
    drawn = [densified(line, spacing) for line in (*walls.lines, *walk.pieces) if len(line) > 1]
    label_rooms(board, building, storey, np.vstack([np.zeros((0, 2)), *drawn]))
    draw_foot(made, inches, bool(walk.pieces))
    return made


def storey_walk(walkthrough: Walkthrough, storey: int) -> StoreyWalk:
    """Returns the parts of the walk and of the planned tour that are on a storey."""
    profile = walkthrough.profile
    runs = _runs(profile.storey == storey)
    exits = tuple(
        (profile.positions[end - 1, :2], int(profile.storey[end])) for _, end in runs if end < len(profile.storey)
    )
    planned = walkthrough.tour.polyline
    fine = densified(planned, 0.25)
    planned_runs = _runs(storeys_along(walkthrough.building, fine) == storey)
    return StoreyWalk(
        pieces=tuple(profile.positions[a:b, :2] for a, b in runs),
        clearance_m=tuple(profile.clearance_m[a:b] for a, b in runs),
        planned=tuple(fine[a:b, :2] for a, b in planned_runs),
        exits=exits,
    )


def _runs(mask: NDArray[np.bool_]) -> list[tuple[int, int]]:
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(np.int8)))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]


def cut_storey(building: Building, storey: int) -> tuple[Section, Section]:
    """Returns what a storey's plan shows of the building: the section through furniture, and that through walls."""
    floor = building.storeys[storey].elevation_m
    solid = [part for part in building.model.parts if part.kind.startswith(_SOLID)]
    low = _near(building, storey, cut(building.geometry, floor + FURNITURE_HEIGHT_M))
    return low, _near(building, storey, cut(building.geometry, floor + CUT_HEIGHT_M, solid))


def draw_cut(axes: Axes, low: Section, walls: Section, width_pt: float = 0.6) -> None:
    """Draws a storey's sections, lines as wide as asked for."""
    _draw_lines(axes, low, style.HAIR, 0.8 * width_pt, 2)
    for area in walls.solids:
        rings = [Path(np.asarray(ring.coords), closed=True) for ring in (area.exterior, *area.interiors)]
        patch = PathPatch(Path.make_compound_path(*rings), facecolor=style.SOLID_INK, edgecolor="none", zorder=3)
        axes.add_patch(patch)
    _draw_lines(axes, walls, style.INK, width_pt, 3)


def _near(building: Building, storey: int, section: Section) -> Section:
    """Returns the section without what stands far from the floor."""
    if not section.lines:
        return section
    pieces = [densified(line, 0.5) for line in section.lines]
    away = away_from_floor(building, storey, np.vstack(pieces))
    ends = np.cumsum([len(piece) for piece in pieces])[:-1]
    near = [not mine.all() for mine in np.split(away, ends)]
    return dataclasses.replace(section, lines=tuple(itertools.compress(section.lines, near)))


def _draw_lines(axes: Axes, section: Section, colour: str, width_pt: float, order: int) -> None:
    if section.lines:
        # One compound path: a thousand separate lines make a picture that is slow to open.
        path = Path.make_compound_path(*(Path(line) for line in section.lines))
        axes.add_patch(PathPatch(path, facecolor="none", edgecolor=colour, linewidth=width_pt, zorder=order))


def _draw_walk(axes: Axes, walk: StoreyWalk) -> None:
    for line in walk.planned:
        axes.plot(line[:, 0], line[:, 1], color=style.PLANNED, linewidth=0.7, linestyle=(0, (4, 2)), zorder=5)
    for line, clearance in zip(walk.pieces, walk.clearance_m, strict=True):
        keep = _thinned(axes, line)
        points, values = line[keep], clearance[keep]
        axes.plot(points[:, 0], points[:, 1], color="white", linewidth=3.6, zorder=4, solid_capstyle="round")
        if len(points) > 1:
            segments = np.stack([points[:-1], points[1:]], axis=1)
            coloured = LineCollection(
                list(segments), cmap=style.CLEARANCE, norm=CLEARANCE_NORM, linewidths=2.2, capstyle="round", zorder=4.5
            )
            coloured.set_array(values[1:])
            axes.add_collection(coloured)
        _draw_arrows(axes, points)


def _thinned(axes: Axes, line: NDArray[np.float64], step_pt: float = 2.5) -> NDArray[np.int64]:
    walked = walked_m(axes.transData.transform(line) * 72.0 / axes.figure.dpi)
    keep = np.unique(np.floor(walked / step_pt), return_index=True)[1]
    return np.union1d(keep, [len(line) - 1])


def _draw_arrows(axes: Axes, line: NDArray[np.float64], spacing_pt: float = 90.0) -> None:
    pixels = axes.transData.transform(line) * 72.0 / axes.figure.dpi
    walked = walked_m(pixels)
    for at in np.arange(spacing_pt / 2, walked[-1], spacing_pt):
        i = int(np.clip(np.searchsorted(walked, at), 1, len(line) - 1))
        ahead, back = line[i], line[max(i - 2, 0)]
        arrow = {"arrowstyle": "-|>,head_length=0.32,head_width=0.2", "color": style.INK, "linewidth": 0.0}
        axes.annotate("", ahead, xytext=back, arrowprops=arrow | {"shrinkA": 0, "shrinkB": 0}, zorder=5.5)
