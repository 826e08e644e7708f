# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a plan is compared with: each objective left out, a slope, other methods."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scenes import ramp

from walk_bringup.cli.main import main
from walk_plan.compare.comparison import Comparison, compare, figures
from walk_plan.compare.page import write_page
from walk_plan.compare.slope import NO_HEIGHT, NO_SLOPE, SlopeComparison, compare_on_slope
from walk_plan.compare.variants import ALL, sharp_turns
from walk_plan.options import plan_config
from walk_plan.outputs import COMPARISON_WRITERS, MARKER
from walk_plan.pipeline import make_walkthrough, plan_walkthrough
from walk_plan.stages import StageClock
from walk_plan.walkthrough import Walkthrough
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.objectives import OBJECTIVES

WEIGHTED = [name for name in OBJECTIVES if TrajoptConfig().weight(name) > 0]


@pytest.fixture(scope="module")
def comparison(walkthrough: Walkthrough) -> Comparison:
    return compare(walkthrough)


@pytest.fixture(scope="module")
def on_a_ramp(tmp_path_factory: pytest.TempPathFactory) -> Comparison:
    """A hall whose floor rises by 1 m over 8 m."""
    path = tmp_path_factory.mktemp("ramp") / "ramp.ply"
    trimesh.util.concatenate(ramp()).export(path)
    config = plan_config({"keypoints": 6})
    return compare(make_walkthrough(path, config, StageClock(lambda stage, fraction: None)))


def test_each_objective_with_a_weight_is_left_out_once(comparison: Comparison) -> None:
    assert [variant.name for variant in comparison.variants] == [ALL, *WEIGHTED]


def test_leaving_out_an_objective_worsens_what_it_is_for(comparison: Comparison) -> None:
    by_name = {variant.name: variant for variant in comparison.variants}
    every = by_name[ALL]
    assert by_name["deviation"].deviation_m >= every.deviation_m - 0.02
    # Smoothness draws the path off the corners of the plan.
    assert by_name["smoothness"].deviation_m < every.deviation_m
    assert by_name["clearance"].quality.mean_clearance_m < every.quality.mean_clearance_m
    assert by_name["keypoints"].keypoint_miss_m >= every.keypoint_miss_m - 0.02


def test_the_walk_with_all_objectives_is_the_planned_one(comparison: Comparison) -> None:
    ours, every = comparison.walkthrough.quality, comparison.variants[0]
    assert every.repaired == len(comparison.walkthrough.path.repaired)
    if not every.repaired:
        assert every.quality.length_m == pytest.approx(ours.length_m, rel=1e-3)


def test_what_has_no_weight_is_not_left_out(walkthrough: Walkthrough) -> None:
    flat = dataclasses.replace(walkthrough.config.trajectory, weight_height=0.0, weight_length=0.0)
    without = dataclasses.replace(walkthrough, config=dataclasses.replace(walkthrough.config, trajectory=flat))
    made = compare(without)
    assert {variant.name for variant in made.variants} == {ALL, *WEIGHTED} - {"height", "length"}
    assert made.slope == NO_HEIGHT


def test_an_objective_added_since_is_on_the_page_by_its_own_name(comparison: Comparison, tmp_path: Path) -> None:
    added = dataclasses.replace(comparison.variants[-1], name="level_gaze")
    write_page(tmp_path / "compare.html", dataclasses.replace(comparison, variants=(*comparison.variants, added)))
    assert "Level gaze" in (tmp_path / "compare.html").read_text()


def test_a_flat_building_has_no_slope_and_says_so(comparison: Comparison) -> None:
    assert comparison.slope == NO_SLOPE
    assert figures(comparison)["slope"] == {"reason": NO_SLOPE}


def test_on_a_ramp_the_height_objective_keeps_the_eye_up(on_a_ramp: Comparison) -> None:
    slope = on_a_ramp.slope
    assert isinstance(slope, SlopeComparison)
    assert abs(slope.rise_m) == pytest.approx(1.0, abs=0.1)
    assert slope.run_m == pytest.approx(8.0, abs=1.0)
    with_it, without = slope.eyes
    assert with_it.mean_error_m < 0.02
    assert without.mean_error_m > 2.0 * with_it.mean_error_m


def test_the_slope_is_found_in_either_direction(on_a_ramp: Comparison) -> None:
    backwards = tuple(dataclasses.replace(v, points=v.points[::-1].copy()) for v in on_a_ramp.variants)
    slope = compare_on_slope(on_a_ramp.walkthrough.building, backwards)
    assert isinstance(slope, SlopeComparison) and isinstance(on_a_ramp.slope, SlopeComparison)
    assert slope.rise_m == pytest.approx(-on_a_ramp.slope.rise_m, abs=0.1)


@pytest.mark.parametrize(("angle", "expected"), [(0.0, 0), (25.0, 0), (35.0, 1), (90.0, 1)])
def test_a_bent_line_has_a_sharp_turn_above_thirty_degrees(angle: float, expected: int) -> None:
    direction = [np.cos(np.radians(angle)), np.sin(np.radians(angle)), 0.0]
    points = np.array([[-3.0, 0.0, 0.0], [0.0, 0.0, 0.0], [3.0 * d for d in direction]])
    assert sharp_turns(points) == expected


def test_a_comparison_is_written_beside_the_plan_and_goes_with_the_next(
    rooms_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert main(["plan", str(rooms_file), "--out", str(out), "--compare", "--quiet"]) == 0
    assert capsys.readouterr().out.splitlines()[-1].startswith(f"comparison {out / 'compare.html'}: ")
    assert set(COMPARISON_WRITERS) <= {made.name for made in out.iterdir()}
    data = json.loads((out / "compare.json").read_text())
    assert [entry["left_out"] for entry in data["objectives"]] == ["", *WEIGHTED]
    assert [entry["name"] for entry in data["methods"]] == ["ours", "spline", "mst_dfs", "rooms_and_doors"]
    page = (out / "compare.html").read_text()
    assert (
        page.count("data:image/svg+xml") == 2 and NO_SLOPE in page and "http" not in page.replace("http://www.w3", "")
    )
    plan_walkthrough(rooms_file, out)
    assert (out / MARKER).exists() and not (out / "compare.json").exists()
