# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The plan of one storey: walls as the building is cut, rooms, keypoints in order, the planned and the final path."""

from __future__ import annotations

import dataclasses

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from numpy.typing import NDArray

from walk_building.building import Building
from walk_plan.drawing import style
from walk_plan.drawing.floor import storey_bounds, tinted_floor
from walk_plan.drawing.plan_labels import label_keypoints, label_passages, label_rooms
from walk_plan.drawing.labels import LabelBoard
from walk_plan.profile import storeys_along
from walk_plan.section import Section, cut
from walk_plan.walkthrough import Walkthrough

CUT_HEIGHT_M = 1.2
"""Height above its floor at which a storey is cut, as architects do: through doors and windows."""

FURNITURE_HEIGHT_M = 0.45
"""Height above the floor at which furniture is cut, drawn thin."""

_MAX_HEIGHT_IN = 8.0
_FOOT_IN = 0.62  # room for scale bar and legend below the plan


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
    made = style.figure(style.WIDTH_IN, height * inches + _FOOT_IN)
    axes = made.add_axes((0.0, _FOOT_IN / made.get_figheight(), 1.0, 1.0 - _FOOT_IN / made.get_figheight()))
    # The axes take the whole width, so that labels may stand beside a narrow building.
    aside = (style.WIDTH_IN / inches - width) / 2
    style.plain_map(axes, low - [aside, 0.0], high + [aside, 0.0])
    tinted_floor(axes, building, storey)
    _draw_walls(axes, building, storey)
    walk = storey_walk(walkthrough, storey)
    _draw_walk(axes, walk)
    board = LabelBoard(axes)
    drawn = np.vstack([np.zeros((0, 2)), *walk.pieces])
    label_keypoints(board, walkthrough, storey)
    label_passages(board, building, storey, walk.exits)
    label_rooms(board, building, storey, drawn)
    _draw_foot(made, inches, walk)
    return made


def storey_walk(walkthrough: Walkthrough, storey: int) -> StoreyWalk:
    """Returns the parts of the walk and of the planned tour that are on a storey."""
    profile = walkthrough.profile
    runs = _runs(profile.storey == storey)
    exits = tuple(
        (profile.positions[end - 1, :2], int(profile.storey[end])) for _, end in runs if end < len(profile.storey)
    )
    planned = walkthrough.tour.polyline
    fine = _densified(planned)
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


def _densified(points: NDArray[np.float64], step_m: float = 0.25) -> NDArray[np.float64]:
    pieces = [points[:1]]
    for a, b in zip(points[:-1], points[1:], strict=True):
        count = max(int(np.ceil(np.linalg.norm(b - a) / step_m)), 1)
        pieces.append(a + (b - a) * (np.arange(1, count + 1) / count)[:, None])
    return np.vstack(pieces)


def _draw_walls(axes: Axes, building: Building, storey: int) -> None:
    floor = building.storeys[storey].elevation_m
    low = cut(building.geometry, floor + FURNITURE_HEIGHT_M)
    walls = cut(building.geometry, floor + CUT_HEIGHT_M)
    _draw_lines(axes, low, style.HAIR, 0.5, 2)
    for solid in walls.solids:
        rings = [Path(np.asarray(ring.coords), closed=True) for ring in (solid.exterior, *solid.interiors)]
        patch = PathPatch(Path.make_compound_path(*rings), facecolor="#56606b", edgecolor="none", zorder=3)
        axes.add_patch(patch)
    _draw_lines(axes, walls, style.INK, 0.6, 3)


def _draw_lines(axes: Axes, section: Section, colour: str, width_pt: float, order: int) -> None:
    if section.lines:
        # One compound path: a thousand separate lines make a picture that is slow to open.
        path = Path.make_compound_path(*(Path(line) for line in section.lines))
        axes.add_patch(PathPatch(path, facecolor="none", edgecolor=colour, linewidth=width_pt, zorder=order))


def _draw_walk(axes: Axes, walk: StoreyWalk) -> None:
    for line in walk.planned:
        axes.plot(line[:, 0], line[:, 1], color=style.PLANNED, linewidth=0.7, linestyle=(0, (4, 2)), zorder=5)
    for line, clearance in zip(walk.pieces, walk.clearance_m, strict=True):
        keep = _thinned(line)
        points, values = line[keep], clearance[keep]
        axes.plot(points[:, 0], points[:, 1], color="white", linewidth=3.6, zorder=4, solid_capstyle="round")
        if len(points) > 1:
            segments = np.stack([points[:-1], points[1:]], axis=1)
            coloured = LineCollection(
                list(segments), cmap=style.CLEARANCE, norm=_norm(), linewidths=2.2, capstyle="round", zorder=4.5
            )
            coloured.set_array(values[1:])
            axes.add_collection(coloured)
        _draw_arrows(axes, points)


def _thinned(line: NDArray[np.float64], step_m: float = 0.12) -> NDArray[np.int64]:
    walked = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    keep = np.unique(np.floor(walked / step_m), return_index=True)[1]
    return np.union1d(keep, [len(line) - 1])


def _draw_arrows(axes: Axes, line: NDArray[np.float64], spacing_pt: float = 90.0) -> None:
    pixels = axes.transData.transform(line) * 72.0 / axes.figure.dpi
    walked = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(pixels, axis=0), axis=1))])
    for at in np.arange(spacing_pt / 2, walked[-1], spacing_pt):
        i = int(np.clip(np.searchsorted(walked, at), 1, len(line) - 1))
        ahead, back = line[i], line[max(i - 2, 0)]
        arrow = {"arrowstyle": "-|>,head_length=0.32,head_width=0.2", "color": style.INK, "linewidth": 0.0}
        axes.annotate("", ahead, xytext=back, arrowprops=arrow | {"shrinkA": 0, "shrinkB": 0}, zorder=5.5)


def _norm() -> Normalize:
    return Normalize(0.0, style.CLEARANCE_FULL_M)


def _draw_foot(made: Figure, inches_per_m: float, walk: StoreyWalk) -> None:
    height = made.get_figheight()
    axes = made.add_axes((0.0, 0.0, 1.0, _FOOT_IN / height))
    axes.set_xlim(0.0, made.get_figwidth() / inches_per_m)
    axes.set_ylim(0.0, _FOOT_IN / inches_per_m)
    axes.set_axis_off()
    style.scale_bar(axes, style.round_length(1.9 / inches_per_m), (0.15 / inches_per_m, 0.2 / inches_per_m))
    if not walk.pieces:
        axes.text(
            0.97, 0.5, "The walk does not come to this level.", transform=axes.transAxes, ha="right", color=style.FAINT
        )
        return
    marks = [
        Line2D([], [], color=style.CLEARANCE(0.7), linewidth=2.2, label="walk"),
        Line2D([], [], color=style.PLANNED, linewidth=0.8, linestyle=(0, (4, 2)), label="planned before smoothing"),
        Line2D([], [], color="none", marker="o", markersize=7, markerfacecolor="white", markeredgecolor=style.INK,
               label="viewpoint, in order"),
    ]  # fmt: skip
    axes.legend(
        handles=marks, loc="center", bbox_to_anchor=(0.5, 0.5), ncols=3, frameon=False, fontsize=style.SMALL_PT + 0.5
    )
    bar = made.add_axes((0.76, 0.30 / height, 0.2, 0.09 / height))
    colours = made.colorbar(ScalarMappable(_norm(), style.CLEARANCE), cax=bar, orientation="horizontal")
    colours.set_ticks([0.0, 0.5, 1.0], labels=["0", "0.5", "1 m and more"])
    colours.outline.set_linewidth(0.4)  # type: ignore[operator]
    bar.tick_params(labelsize=style.SMALL_PT, length=2, width=0.4, pad=1.5)
    bar.set_title("space beside the body", fontsize=style.SMALL_PT, pad=2.5)
