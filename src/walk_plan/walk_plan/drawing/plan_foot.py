# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Below a storey's plan: what its lines and colours mean, and its scale."""

from __future__ import annotations

from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from walk_plan.drawing import style

CLEARANCE_NORM = Normalize(0.0, style.CLEARANCE_FULL_M)


def draw_foot(made: Figure, inches_per_m: float, walked: bool) -> None:
    """Draws legend, scale bar and the scale of colours in the lowest 0.8 inches of a plan.

    Args:
        made: The picture.
        inches_per_m: Its scale.
        walked: Whether the walk comes to this storey.
    """
    width, height = made.get_figwidth(), made.get_figheight()
    axes = made.add_axes((0.0, 0.0, 1.0, 0.46 / height))
    axes.set_xlim(0.0, width / inches_per_m)
    axes.set_ylim(0.0, 0.46 / inches_per_m)
    axes.set_axis_off()
    style.scale_bar(axes, style.round_length(1.9 / inches_per_m), (0.12 / inches_per_m, 0.1 / inches_per_m))
    made.legend(
        handles=_marks(walked), loc="center", bbox_to_anchor=(0.5, 0.62 / height), ncols=4, frameon=False,
        fontsize=style.SMALL_PT, handlelength=1.6, columnspacing=1.4,
    )  # fmt: skip
    if not walked:
        made.text(
            1.0 - 0.12 / width, 0.2 / height, "The walk does not come to this level.", ha="right",
            fontsize=style.SMALL_PT + 1, color=style.FAINT,
        )  # fmt: skip
        return
    bar = made.add_axes((1.0 - 2.0 / width, 0.2 / height, 1.45 / width, 0.08 / height))
    colours = made.colorbar(ScalarMappable(CLEARANCE_NORM, style.CLEARANCE), cax=bar, orientation="horizontal")
    colours.set_ticks([0.0, 0.5, 1.0], labels=["0", "0.5", "1 m or more"])
    colours.outline.set_linewidth(0.4)
    bar.tick_params(labelsize=style.SMALL_PT, length=2, width=0.4, pad=1.5)
    bar.set_title("space beside the body", fontsize=style.SMALL_PT, pad=2.5)


def _marks(walked: bool) -> list[Line2D | Patch]:
    grey = Patch(facecolor=style.OPEN_FLOOR, edgecolor=style.HAIR, linewidth=0.5, label="not reachable on foot")
    if not walked:
        return [grey]
    return [
        Line2D([], [], color=style.CLEARANCE(0.7), linewidth=2.2, label="walk"),
        Line2D([], [], color=style.PLANNED, linewidth=0.8, linestyle=(0, (4, 2)), label="planned before smoothing"),
        Line2D(
            [], [], color="none", marker="o", markersize=6, markerfacecolor="white", markeredgecolor=style.INK,
            label="viewpoint, in order",
        ),
        grey,
    ]  # fmt: skip
