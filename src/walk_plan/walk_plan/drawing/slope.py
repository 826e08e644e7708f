# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The eye over a stair or a ramp, with the height objective and without, seen from the side."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from walk_plan.compare.slope import SlopeComparison
from walk_plan.drawing import style

_COLOURS = {"with": style.CLEARANCE(0.9), "without": style.CLEARANCE(0.0)}
_NAMES = {"with": "with the height objective", "without": "without it"}


def draw_slope(slope: SlopeComparison) -> Figure:
    """Returns the side view of the slope with both eyes above it, and below it their heights over the floor."""
    made = style.figure(style.WIDTH_IN, 4.9)
    side = made.add_axes((0.06, 0.42, 0.925, 0.55))
    over = made.add_axes((0.06, 0.1, 0.925, 0.24), sharex=side)
    base = np.nanmin(np.where(np.isfinite(slope.surface_z), slope.surface_z, slope.floor_z))
    ground = np.where(np.isfinite(slope.surface_z), slope.surface_z, slope.floor_z) - base
    side.fill_between(slope.way_m, -0.15, ground, color=style.SOLID_INK, linewidth=0, step="mid")
    wished = slope.floor_z + slope.eye_height_m - base
    side.plot(slope.way_m, wished, color=style.PLANNED, linewidth=1.0, linestyle=(0, (4, 2)), label="wished height")
    over.axhline(slope.eye_height_m, color=style.PLANNED, linewidth=1.0, linestyle=(0, (4, 2)))
    for eye in slope.eyes:
        side.plot(slope.way_m, eye.eye_z - base, color=_COLOURS[eye.name], linewidth=1.6, label=_NAMES[eye.name])
        over.plot(slope.way_m, eye.height_m, color=_COLOURS[eye.name], linewidth=1.4)
    side.set_xlim(slope.way_m[0], slope.way_m[-1])
    side.set_ylim(-0.15, None)
    side.legend(loc="upper left", frameon=False, fontsize=style.SMALL_PT + 0.5)
    _plain(side, "Height over the\nlowest floor [m]")
    _plain(over, "Eye above the\nfloor [m]")
    over.set_xlabel("metres walked on the level, from where the slope begins", fontsize=style.NORMAL_PT)
    return made


def _plain(axes: Axes, label: str) -> None:
    axes.set_ylabel(label, fontsize=style.SMALL_PT + 0.5)
    axes.tick_params(labelsize=style.SMALL_PT, length=2, width=0.5)
    axes.grid(axis="y", color=style.HAIR, linewidth=0.4)
    for name in ("top", "right"):
        axes.spines[name].set_visible(False)
