# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What happens along the walk, drawn over its length."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from walk_plan.clearance import LIMIT_M
from walk_plan.drawing import style
from walk_plan.profile import Profile
from walk_plan.walkthrough import Walkthrough

_LEFT_IN, _RIGHT_IN, _ROW_IN, _GAP_IN, _FOOT_IN, _HEAD_IN = 0.62, 0.12, 0.92, 0.24, 0.5, 0.34


def draw_profiles(walkthrough: Walkthrough) -> Figure:
    """Returns level, height above the floor, clearance, speed and turn rate over the metres walked."""
    profile, config = walkthrough.profile, walkthrough.config
    rows = 5
    height = _HEAD_IN + rows * _ROW_IN + (rows - 1) * _GAP_IN + _FOOT_IN
    made = style.figure(style.WIDTH_IN, height)
    wide = style.WIDTH_IN - _LEFT_IN - _RIGHT_IN
    axes: list[Axes] = []
    for r in range(rows):
        bottom = height - _HEAD_IN - (r + 1) * _ROW_IN - r * _GAP_IN
        box = (_LEFT_IN / style.WIDTH_IN, bottom / height, wide / style.WIDTH_IN, _ROW_IN / height)
        axes.append(made.add_axes(box, sharex=axes[0] if axes else None))
    walker = walkthrough.building.walker
    floor = profile.positions[:, 2] - walker.eye_height_m
    low, high = np.nanmin(floor), np.nanmax(floor)
    _curve(axes[0], profile, floor, "Floor level [m]", (low - 0.3, max(high + 0.3, low + 1.0)))
    tall = walker.eye_height_m
    top = max(tall + 0.3, float(np.nanmax(profile.height_m, initial=tall)) + 0.1)
    _curve(
        axes[1],
        profile,
        profile.height_m,
        "Eye above\nthe floor [m]",
        (max(tall - 0.5, 0.0), min(top, tall + 1.0)),
        tall,
    )
    _curve(axes[2], profile, profile.clearance_m, "Space beside\nthe body [m]", (0.0, LIMIT_M))
    _curve(
        axes[3],
        profile,
        profile.speed_mps,
        "Speed [m/s]",
        (0.0, 1.15 * max(profile.speed_mps.max(), 0.1)),
        config.timing.speed_mps,
    )
    turn = np.degrees(profile.turn_rate_radps)
    limit = float(np.degrees(config.timing.max_turn_rate_radps))
    _curve(axes[4], profile, turn, "Turn of the\nview [°/s]", (0.0, 1.15 * max(limit, turn.max())), limit)
    axes[4].set_xlabel("metres walked", fontsize=style.NORMAL_PT)
    for upper in axes[:-1]:
        upper.tick_params(labelbottom=False)
    _mark_keypoints(axes, walkthrough)
    return made


def _curve(
    axes: Axes,
    profile: Profile,
    values: NDArray[np.float64],
    label: str,
    limits: tuple[float, float],
    wished: float | None = None,
) -> None:
    if wished is not None:
        axes.axhline(wished, color=style.PLANNED, linewidth=0.8, linestyle=(0, (4, 2)), zorder=1)
    axes.plot(profile.walked_m, values, color=style.CLEARANCE(0.95), linewidth=0.9, zorder=2)
    axes.set_xlim(0.0, max(float(profile.walked_m[-1]), 1.0))
    axes.set_ylim(*limits)
    axes.set_ylabel(label, fontsize=style.SMALL_PT + 0.5)
    axes.yaxis.set_label_coords(-0.036, 0.5)
    axes.tick_params(labelsize=style.SMALL_PT, length=2, width=0.5)
    axes.grid(axis="y", color=style.HAIR, linewidth=0.4)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    for side in ("left", "bottom"):
        axes.spines[side].set_linewidth(0.5)


def _mark_keypoints(axes: list[Axes], walkthrough: Walkthrough) -> None:
    profile = walkthrough.profile
    at = keypoint_distances(walkthrough)
    for panel in axes:
        for x in at:
            panel.axvline(x, color=style.HAIR, linewidth=0.5, zorder=0)
    # Numbers only where there is room for them, else a long tour's would run into each other.
    room = 0.018 * max(float(profile.walked_m[-1]), 1.0)
    last = -np.inf
    for number, x in enumerate(at, start=1):
        if x - last >= room:
            axes[0].annotate(
                str(number), (x, 1.0), xycoords=("data", "axes fraction"), xytext=(0, 3), textcoords="offset points",
                ha="center", fontsize=6.0, color=style.FAINT,
            )  # fmt: skip
            last = x
    axes[0].annotate(
        "viewpoint", (0, 1.0), xycoords="axes fraction", xytext=(-6, 3), textcoords="offset points", ha="right",
        fontsize=6.0, color=style.FAINT,
    )  # fmt: skip


def keypoint_distances(walkthrough: Walkthrough) -> NDArray[np.float64]:
    """Returns how far one has walked at each keypoint of the tour, (M,) [m]."""
    steps = np.linalg.norm(np.diff(walkthrough.path.points, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])[walkthrough.path.keypoint_index]
