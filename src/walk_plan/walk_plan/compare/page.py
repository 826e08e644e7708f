# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""compare.html: the comparison in the style of the report."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from walk_building.sweep import BodySweep
from walk_plan import wording
from walk_plan.compare.comparison import Comparison
from walk_plan.compare.variants import ALL, Variant
from walk_plan.drawing.slope import draw_slope
from walk_plan.drawing.small_multiples import Panel, draw_panels
from walk_plan.quality import PathQuality
from walk_plan.report import environment, picture

STOREYS_SHOWN = 2
"""Small plans are drawn of the levels with the most of the walk on them."""

_WHAT = {
    ALL: ("Nothing", "all objectives together"),
    "deviation": ("Deviation", "stay near the planned tour"),
    "length": ("Length", "do not walk farther than needed"),
    "smoothness": ("Smoothness", "turn softly, walk evenly"),
    "clearance": ("Clearance", "keep off walls and furniture"),
    "height": ("Height", "keep the eye at its height over the floor"),
    "keypoints": ("Viewpoints", "pass by each viewpoint"),
}
_COLUMNS: tuple[tuple[str, str, str, Callable[[Variant], str]], ...] = (
    ("Off the plan", "mean, from the planned tour", "deviation", lambda v: wording.centimetres(v.deviation_m)),
    ("Length", "metres walked", "length", lambda v: wording.metres(v.quality.length_m, 1)),
    ("Sharp turns", "over 30° within 0.3 m", "smoothness", lambda v: str(v.sharp_turns)),
    ("Collisions", "pieces of the path", "clearance", lambda v: _collisions(v.quality)),
    ("Eye height", "largest error", "height", lambda v: wording.centimetres(v.quality.height_deviation_m)),
    ("Viewpoint missed", "by at most", "keypoints", lambda v: wording.centimetres(v.keypoint_miss_m)),
    ("Space beside", "the body, mean", "", lambda v: wording.centimetres(v.quality.mean_clearance_m)),
    ("Mended", "stretches, by the check", "", lambda v: str(v.repaired)),
)  # fmt: skip


def _what(name: str) -> tuple[str, str]:
    """Returns what an objective is called on the page and what it asks for; one added since has its own name only."""
    return _WHAT.get(name, (name.replace("_", " ").capitalize(), ""))


def write_page(path: Path, comparison: Comparison) -> None:
    """Writes compare.html, pictures inside."""
    path.write_text(environment().get_template("compare.html.j2").render(context(comparison)), encoding="utf-8")


def context(comparison: Comparison) -> dict[str, Any]:
    """Returns what the template shows."""
    walkthrough, slope = comparison.walkthrough, comparison.slope
    building = walkthrough.building
    storeys, walked = shown_storeys(comparison)
    reachable = frozenset(index for index, room in enumerate(building.rooms) if room.reachable)
    names = [building.storeys[storey].name for storey in storeys]
    shown = {"objectives": objective_figures(comparison), "methods": method_figures(comparison)}
    return {
        "title": building.model.source.stem.replace("_", " "),
        "headline": wording.headline(walkthrough),
        "count": len(comparison.variants) - 1,
        **{
            key: [picture(made, name, f"Small plans of {name}") for name, made in zip(names, drawn, strict=True)]
            for key, drawn in shown.items()
        },
        "beyond": "" if walked == len(storeys) else f"Drawn are the {len(storeys)} of {walked} levels most walked on.",
        "columns": [(name, meaning) for name, meaning, _, _ in _COLUMNS],
        "variants": [
            (*_what(variant.name), [(show(variant), key == variant.name) for _, _, key, show in _COLUMNS])
            for variant in comparison.variants
        ],
        "slope": slope if isinstance(slope, str) else picture(draw_slope(slope), "", "Side view of the slope"),
        "slope_text": "" if isinstance(slope, str) else slope_text(comparison),
        "walks": [wording.TITLES.get(quality.name, quality.name) for quality in comparison.qualities],
        "quality": wording.quality_rows(comparison.qualities, reachable),
        "file": building.model.source.name,
        "hash": building.hash,
    }


def shown_storeys(comparison: Comparison) -> tuple[list[int], int]:
    """Returns the storeys to draw, lowest first, and how many are walked on at all."""
    profile = comparison.walkthrough.profile
    steps = np.diff(profile.walked_m, prepend=0.0)
    lengths = {int(s): float(steps[profile.storey == s].sum()) for s in np.unique(profile.storey) if s >= 0}
    longest = sorted(lengths, key=lambda s: -lengths[s])[:STOREYS_SHOWN]
    return sorted(longest), len(lengths)


def objective_figures(comparison: Comparison) -> list[Figure]:
    """Returns the small plans of the walks without an objective, one picture for each storey that is shown."""
    panels = []
    for variant in comparison.variants:
        title = "All objectives" if variant.name == ALL else f"Without {_what(variant.name)[0].lower()}"
        panels.append((title, _variant_note(variant), variant.points))
    return _drawn(comparison, panels)


def method_figures(comparison: Comparison) -> list[Figure]:
    """Returns the small plans of the walks by other methods, one picture for each storey that is shown."""
    panels = []
    for walk, quality in zip(comparison.walks, comparison.qualities, strict=True):
        note = f"{quality.length_m:.1f} m, {_collisions(quality)} pieces collide"
        panels.append((_SHORT_TITLES.get(walk.name, walk.name), note, walk.path))
    return _drawn(comparison, panels)


def slope_text(comparison: Comparison) -> str:
    """Returns what the slope shows, in two sentences."""
    slope = comparison.slope
    assert not isinstance(slope, str)
    with_it, without = slope.eyes
    way = "up" if slope.rise_m > 0 else "down"
    return (
        f"The longest slope of the walk leads {abs(slope.rise_m):.2f} m {way} over {slope.run_m:.1f} m. There the eye"
        f" is {wording.centimetres(with_it.mean_error_m)} off its height of {slope.eye_height_m:g} m on average and"
        f" {wording.centimetres(with_it.largest_error_m)} at most; without the height objective"
        f" {wording.centimetres(without.mean_error_m)} and {wording.centimetres(without.largest_error_m)}."
    )


_SHORT_TITLES = {
    "ours": "This walk",
    "spline": "Curve, not optimised",
    "mst_dfs": "Spanning tree's order",
    "rooms_and_doors": "Rooms and doors",
}


def _variant_note(variant: Variant) -> str:
    notes = {
        "deviation": f"{wording.centimetres(variant.deviation_m)} off the planned tour",
        "length": wording.metres(variant.quality.length_m, 1),
        "smoothness": f"{variant.sharp_turns} sharp turns",
        "clearance": f"{_collisions(variant.quality)} pieces collide",
        "height": f"eye height up to {wording.centimetres(variant.quality.height_deviation_m)} wrong",
        "keypoints": f"misses one by {wording.centimetres(variant.keypoint_miss_m)}",
    }
    return notes.get(variant.name) or ", ".join([notes["length"], notes["clearance"]])


def _collisions(quality: PathQuality) -> str:
    return f"{quality.colliding_segments} of {quality.segments}"


def _drawn(comparison: Comparison, walks: list[tuple[str, str, Any]]) -> list[Figure]:
    building = comparison.walkthrough.building
    sweep = BodySweep(building.geometry, building.walker)
    panels = [Panel(title=t, note=n, points=points, free=sweep.segments_free(points)) for t, n, points in walks]
    storeys, _ = shown_storeys(comparison)
    return [draw_panels(building, storey, panels, comparison.walkthrough.keypoints) for storey in storeys]
