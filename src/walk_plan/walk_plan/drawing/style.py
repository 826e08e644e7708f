# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""One look for all pictures: sizes, and colours that stay apart for colour-blind readers and in print."""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib
import matplotlib.patches
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import LinearSegmentedColormap, ListedColormap
from matplotlib.figure import Figure

INK = "#1f2933"  # text and cut walls
SOLID_INK = "#56606b"  # inside of cut walls
FAINT = "#6b7580"  # notes, axes
HAIR = "#c3cad1"  # furniture, grids
PLANNED = "#8a4f9e"  # the planned tour
MARK = "#ffffff"  # inside of a keypoint's circle
START, END = "#00795c", "#b3243b"
ROOM_TINTS = ("#e6eef6", "#f6efdf", "#e7f1e6", "#f4e8ea", "#ebe9f4", "#e3f0f0", "#f3ecd9", "#eceff1")
OPEN_FLOOR = "#e9ebee"

# Vermillion to blue of Okabe and Ito's palette: apart in hue and in lightness for every kind of colour vision.
CLEARANCE = LinearSegmentedColormap.from_list("clearance", ["#d55e00", "#e8963c", "#56a0d3", "#0a3d7a"])
CLEARANCE_FULL_M = 1.0
MAP = matplotlib.colormaps["cividis"]
SOLID = ListedColormap(["#f0f2f4", "#384048"])
WALLS = ListedColormap(["#aab2ba"])

SMALL_PT, NORMAL_PT = 7.0, 8.5
WIDTH_IN = 10.4  # of a full-width picture


def figure(width_in: float, height_in: float) -> Figure:
    """Returns an empty figure in the house style."""
    made = Figure(figsize=(width_in, height_in))
    # A canvas of its own measures texts without a window system or a global state.
    FigureCanvasAgg(made)
    return made


def plain_map(axes: Axes, low: Sequence[float] | np.ndarray, high: Sequence[float] | np.ndarray) -> None:
    """Turns axes into a map: same scale both ways, no frame."""
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal")
    axes.set_axis_off()


def scale_bar(axes: Axes, length_m: float, at: tuple[float, float], size_pt: float = SMALL_PT) -> None:
    """Draws a bar of two halves, black and white, with its length in metres; `at` is its lower left end [m]."""
    height = 0.055 * length_m
    for half, colour in enumerate((INK, "white")):
        corner = (at[0] + half * length_m / 2, at[1])
        axes.add_patch(
            matplotlib.patches.Rectangle(corner, length_m / 2, height, facecolor=colour, edgecolor=INK, linewidth=0.6)
        )
    for share in (0.0, 0.5, 1.0):
        text = f"{share * length_m:g}" + (" m" if share == 1.0 else "")
        axes.annotate(
            text,
            (at[0] + share * length_m, at[1] + height),
            xytext=(0, 2),
            textcoords="offset points",
            ha="center",
            va="bottom",
            fontsize=size_pt,
            color=INK,
        )


def round_length(length: float) -> float:
    """Returns the largest of 1, 2, 5, 10, 20, … that is not above `length`."""
    power = 10.0 ** np.floor(np.log10(length))
    return float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= length * (1 + 1e-9)))
