# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The whole comparison of a plan: objectives left out, the slope, and other methods."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import Any

from walk_building.progress import Progress, no_progress
from walk_building.sweep import BodySweep
from walk_plan.baselines import Walk, baselines
from walk_plan.clearance import SideClearance
from walk_plan.compare.slope import SlopeComparison, compare_on_slope
from walk_plan.compare.variants import Variant, objective_variants
from walk_plan.quality import Measure, PathQuality
from walk_plan.seen import sample_free_space
from walk_plan.summary import as_plain, named_rooms
from walk_plan.walkthrough import Walkthrough

FORMAT = 1
"""Rises when a key of compare.json changes its meaning."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Comparison:
    """A plan beside the same plan without one of its parts."""

    walkthrough: Walkthrough
    variants: tuple[Variant, ...]  # with all objectives first
    slope: SlopeComparison | str  # or why there is none
    walks: tuple[Walk, ...]  # this walk first, then other methods
    qualities: tuple[PathQuality, ...]  # of the walks


def compare(walkthrough: Walkthrough, progress: Progress = no_progress) -> Comparison:
    """Returns the comparison of a plan; it takes about as long as the plan's own path, times the objectives."""
    building = walkthrough.building
    progress("compare", 0.0)
    measure = Measure(
        building,
        BodySweep(building.geometry, building.walker),
        SideClearance(building),
        sample_free_space(building, walkthrough.importance_map),
    )
    variants = objective_variants(walkthrough, measure)
    progress("compare", 0.6)
    others = baselines(building, walkthrough.suggestion, walkthrough.tour, walkthrough.config)
    ours = Walk(name="ours", path=walkthrough.path.points, trajectory=walkthrough.trajectory)
    # The plan has measured these walks already.
    known = {quality.name: quality for quality in walkthrough.qualities}
    progress("compare", 1.0)
    return Comparison(
        walkthrough=walkthrough,
        variants=variants,
        slope=compare_on_slope(building, variants),
        walks=(ours, *others),
        qualities=tuple(known[walk.name] for walk in (ours, *others)),
    )


def figures(comparison: Comparison) -> dict[str, Any]:
    """Returns all figures as plain data: what compare.json holds. Metres, seconds, degrees; null: no meaning."""
    building = comparison.walkthrough.building
    plain = as_plain(
        {
            "format": FORMAT,
            "building": {"file": building.model.source.name, "hash": building.hash},
            "objectives": [
                {
                    "left_out": "" if at == 0 else variant.name,
                    "deviation_m": variant.deviation_m,
                    "sharp_turns": variant.sharp_turns,
                    "keypoint_miss_m": variant.keypoint_miss_m,
                    "repaired": variant.repaired,
                    "colliding_after_repair": variant.colliding,
                    **named_rooms(building, variant.quality),
                }
                for at, variant in enumerate(comparison.variants)
            ],
            "slope": _slope(comparison.slope),
            "methods": [named_rooms(building, quality) for quality in comparison.qualities],
        }
    )
    assert isinstance(plain, dict)
    return plain


def write_figures(path: Path, comparison: Comparison) -> None:
    """Writes compare.json."""
    path.write_text(json.dumps(figures(comparison), indent=1, allow_nan=False) + "\n", encoding="utf-8")


def _slope(slope: SlopeComparison | str) -> dict[str, Any]:
    if isinstance(slope, str):
        return {"reason": slope}
    return {
        "rise_m": slope.rise_m,
        "run_m": slope.run_m,
        **{
            f"{eye.name}_height_objective": {
                "mean_error_m": eye.mean_error_m,
                "largest_error_m": eye.largest_error_m,
            }
            for eye in slope.eyes
        },
    }
