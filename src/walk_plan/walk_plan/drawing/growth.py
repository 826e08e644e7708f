# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""How the time of the visibility map grows with the voxels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from walk_plan.drawing import style

_LINES = (
    ("exact_s", "exact", style.CLEARANCE(0.0), "s"),
    ("error_0.1_s", "progressive, to the default error of 0.1", style.CLEARANCE(0.9), "o"),
    ("first_map_s", "progressive, first map", style.CLEARANCE(0.6), "^"),
)


def draw_growth(rows: Sequence[Mapping[str, Any]]) -> Figure:
    """Returns the seconds over the voxels, both in powers of ten; points that are extrapolated are hollow.

    Args:
        rows: What `walk_importance.bench.growth` returns.
    """
    made = style.figure(style.WIDTH_IN * 0.7, 4.4)
    axes = made.add_axes((0.1, 0.12, 0.87, 0.84))
    voxels = np.array([row["voxels"] for row in rows], float)
    for key, name, colour, marker in _LINES:
        seconds = np.array([row[key] for row in rows], float)
        measured = np.array([key != "exact_s" or row["exact_measured"] for row in rows])
        known = max(int(measured.sum()), 1)
        axes.plot(voxels[:known], seconds[:known], color=colour, linewidth=1.4, label=name)
        axes.plot(voxels[known - 1 :], seconds[known - 1 :], color=colour, linewidth=1.2, linestyle=(0, (3, 2)))
        for x, y, filled in zip(voxels, seconds, measured, strict=True):
            face = colour if filled else "white"
            axes.plot(x, y, marker=marker, markersize=5.5, markeredgecolor=colour, markerfacecolor=face, linestyle="")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("voxels", fontsize=style.NORMAL_PT)
    axes.set_ylabel("seconds (hollow: extrapolated)", fontsize=style.NORMAL_PT)
    axes.tick_params(labelsize=style.SMALL_PT + 0.5)
    axes.grid(color=style.HAIR, linewidth=0.4)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.legend(loc="upper left", frameon=False, fontsize=style.NORMAL_PT)
    return made
