# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Many walks through the same storey, a small plan each, so that the eye can go from one to the next."""

from __future__ import annotations

import dataclasses

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from walk_building.building import Building
from walk_plan.along import densified
from walk_plan.drawing import style
from walk_plan.drawing.floor import storey_bounds, tinted_floor
from walk_plan.drawing.storey_plan import cut_storey, draw_cut
from walk_plan.profile import storeys_along

_GAP_IN, _HEAD_IN, _FOOT_IN = 0.18, 0.42, 0.34
_MAX_PANEL_IN = 3.6
_COLUMNS = 4
_STEP_M = 0.1  # pieces of a line that are on one storey each
_LINE, _TOUCHING, _REFERENCE = style.CLEARANCE(0.9), style.END, "#8d97a1"


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Panel:
    """One of the walks."""

    title: str
    note: str  # its figures, in a line
    points: NDArray[np.float64]  # (n, 3) [m]
    free: NDArray[np.bool_]  # (n - 1,) where the body passes


def draw_panels(building: Building, storey: int, panels: list[Panel], keypoints: NDArray[np.float64]) -> Figure:
    """Returns a small plan of a storey for each walk; the first is drawn thin and grey in all others.

    Args:
        building: Whose storey it is.
        storey: Its index.
        panels: The walks.
        keypoints: (M, 3) drawn as small circles [m].
    """
    low, high = storey_bounds(building, storey)
    width, height = high - low
    columns = min(_COLUMNS, len(panels))
    rows = -(-len(panels) // columns)
    wide = (style.WIDTH_IN - (columns - 1) * _GAP_IN) / columns
    tall = min(wide * height / width, _MAX_PANEL_IN)
    total = rows * (tall + _HEAD_IN) + (rows - 1) * _GAP_IN + _FOOT_IN
    made = style.figure(style.WIDTH_IN, total)
    section = cut_storey(building, storey)
    marks = keypoints[storeys_along(building, keypoints) == storey]
    for k, panel in enumerate(panels):
        left = (k % columns) * (wide + _GAP_IN)
        top = total - (k // columns) * (tall + _HEAD_IN + _GAP_IN)
        box = (left / style.WIDTH_IN, (top - _HEAD_IN - tall) / total, wide / style.WIDTH_IN, tall / total)
        axes = made.add_axes(box)
        style.plain_map(axes, low, high)
        tinted_floor(axes, building, storey)
        draw_cut(axes, *section, width_pt=0.35)
        if k:
            _draw_line(axes, building, storey, panels[0], reference=True)
        _draw_line(axes, building, storey, panel)
        axes.plot(marks[:, 0], marks[:, 1], "o", markersize=2.6, markerfacecolor="white", markeredgecolor=style.INK,
                  markeredgewidth=0.5, zorder=6)  # fmt: skip
        x = left / style.WIDTH_IN
        made.text(x, (top - 0.14) / total, panel.title, fontsize=style.NORMAL_PT, fontweight="bold", color=style.INK)
        made.text(x, (top - 0.31) / total, panel.note, fontsize=style.SMALL_PT, color=style.FAINT)
    made.legend(
        handles=_marks(), loc="lower center", bbox_to_anchor=(0.5, 0.0), ncols=4, frameon=False,
        fontsize=style.SMALL_PT, handlelength=1.6, columnspacing=1.6,
    )  # fmt: skip
    return made


def _draw_line(axes: Axes, building: Building, storey: int, panel: Panel, *, reference: bool = False) -> None:
    line = densified(panel.points, _STEP_M)
    # Each fine piece belongs to the segment its middle lies on, which says whether the body passes.
    lengths = np.maximum(np.linalg.norm(np.diff(panel.points, axis=0), axis=1), 1e-12)
    pieces = np.maximum(np.ceil(lengths / _STEP_M).astype(int), 1)
    free = np.repeat(panel.free, pieces)
    here = storeys_along(building, 0.5 * (line[1:] + line[:-1])) == storey
    segments = np.stack([line[:-1, :2], line[1:, :2]], axis=1)
    for mask, colour, width, order in (
        (
            here & (free | reference),
            _REFERENCE if reference else _LINE,
            0.8 if reference else 1.5,
            4 if reference else 5,
        ),
        (here & ~free & (not reference), _TOUCHING, 2.0, 5.5),
    ):
        if mask.any():
            axes.add_collection(
                LineCollection(list(segments[mask]), colors=[colour], linewidths=width, capstyle="round", zorder=order)
            )


def _marks() -> list[Line2D]:
    return [
        Line2D([], [], color=_LINE, linewidth=1.5, label="walk"),
        Line2D([], [], color=_TOUCHING, linewidth=2.0, label="the body meets the building here"),
        Line2D([], [], color=_REFERENCE, linewidth=0.8, label="the first walk, for comparison"),
        Line2D([], [], color="none", marker="o", markersize=3.5, markerfacecolor="white", markeredgecolor=style.INK,
               label="viewpoint"),
    ]  # fmt: skip
