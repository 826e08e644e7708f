# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Figures as a client reads them: units, rounding, and sentences."""

from __future__ import annotations

import math
from collections.abc import Callable

from walk_plan.quality import PathQuality
from walk_plan.walkthrough import Walkthrough

TITLES = {
    "ours": "This walk",
    "spline": "Curve through the viewpoints, not optimised",
    "mst_dfs": "Order by spanning tree, optimised",
    "rooms_and_doors": "Rooms and doors, straight lines",
}
"""What the report calls the walks that are compared."""

_LONGEST_SETTING = 40  # letters of an option's value beside its name


def metres(value: float, digits: int = 2) -> str:
    """Returns a length with its unit, a dash for nan."""
    return "–" if math.isnan(value) else f"{value:.{digits}f} m"


def centimetres(value: float) -> str:
    """Returns a short length in centimetres, a longer one in metres, a dash for nan."""
    if math.isnan(value) or value >= 2.0:
        return metres(value, 1)
    return f"{100 * value:.1f} cm" if value < 0.1 else f"{100 * value:.0f} cm"


def setting(value: bool | float | str, default: bool | float | str, unit: str = "") -> str:
    """Returns the value of an option as a client reads it: long patterns are for programs and stand in report.json."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if not isinstance(value, str):
        return f"{value:g}°" if unit == "deg" else f"{value:g} {unit}".rstrip()
    if len(value) > _LONGEST_SETTING:
        return "usual names" if value == default else "names of one's own"
    return value or "–"


def duration(seconds: float) -> str:
    """Returns a time as minutes and seconds."""
    whole = round(seconds)
    return f"{whole // 60} min {whole % 60:02d} s" if whole >= 60 else f"{whole} s"


def percent(share: float) -> str:
    """Returns a share in percent, a dash for nan."""
    return "–" if math.isnan(share) else f"{100 * share:.0f} %"


def quality_rows(qualities: tuple[PathQuality, ...], reachable: frozenset[int]) -> list[tuple[str, str, list[str]]]:
    """Returns the table that compares walks: for each figure its name, what it means, and its value for each walk.

    Args:
        qualities: Of the walks.
        reachable: Rooms that can be reached; a walk through walls may enter others, which does not count.
    """
    rows: tuple[tuple[str, str, Callable[[PathQuality], str]], ...] = (
        ("Length", "metres walked", lambda q: metres(q.length_m, 1)),
        ("Duration", "from first to last viewpoint", lambda q: duration(q.duration_s)),
        ("Collisions", "straight pieces of the path on which the body would meet the building",
         lambda q: f"{q.colliding_segments} of {q.segments}"),
        ("Tightest spot", "smallest space between body and building; 0 touches",
         lambda q: centimetres(q.min_clearance_m)),
        ("Typical space", "mean space beside the body, counted up to 2 m", lambda q: centimetres(q.mean_clearance_m)),
        ("Typical speed", "median while walking", lambda q: f"{q.median_speed_mps:.2f} m/s"),
        ("Highest speed", "", lambda q: f"{q.peak_speed_mps:.2f} m/s"),
        ("Jerkiness", "change of the acceleration, root mean square; lower is calmer",
         lambda q: f"{q.rms_jerk_mps3:.2f} m/s³"),
        ("Fastest turn of the view", "", lambda q: f"{math.degrees(q.peak_turn_rate_radps):.0f} °/s"),
        ("Eye height, largest error", "from the wished height over the floor, stairs evened out",
         lambda q: centimetres(q.height_deviation_m)),
        ("Eye height on flat floors", "standard deviation", lambda q: centimetres(q.flat_height_std_m)),
        ("Seen on the way", "share of the free space of the reachable rooms", lambda q: percent(q.seen_share)),
        ("Rooms entered", "of the rooms that can be reached",
         lambda q: f"{len(reachable & set(q.rooms))} of {len(reachable)}"),
    )  # fmt: skip
    return [(name, meaning, [figure(q) for q in qualities]) for name, meaning, figure in rows]


def headline(walkthrough: Walkthrough) -> str:
    """Returns the summary of a walk in two or three sentences."""
    quality, building = walkthrough.quality, walkthrough.building
    reachable = [i for i, room in enumerate(building.rooms) if room.reachable]
    levels = {int(s) for s in walkthrough.profile.storey if s >= 0}
    entered = sum(1 for i in reachable if i in quality.rooms)
    where = f"{entered} of the {len(reachable)} rooms that can be reached, on {_count(len(levels), 'level')}"
    text = f"A walk of {quality.length_m:.0f} m and {duration(quality.duration_s)} through {where}."
    walker = walkthrough.building.walker
    body = f"a person {walker.height_m:g} m tall and {2 * walker.radius_m:g} m wide"
    if quality.colliding_segments == 0:
        text += (
            f" Checked along its whole length for {body}: it touches nothing"
            f" and keeps at least {centimetres(quality.min_clearance_m)} free."
        )
    else:
        text += f" For {body} it does not pass freely: {_count(quality.colliding_segments, 'piece')} of it collide."
    unreachable = len(building.rooms) - len(reachable)
    if unreachable:
        text += f" {_count(unreachable, 'room')} cannot be reached on foot from there; the reasons are given below."
    return text


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" + ("" if number == 1 else "s")
