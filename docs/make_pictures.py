# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Draws the pictures of README.md and docs/ from the sample building into docs/images/.

    ./walk python docs/make_pictures.py

How visibility grows is drawn from docs/images/visibility_growth.json, which `./walk bench growth` prints: it takes
minutes on a machine that does nothing else.
"""

from __future__ import annotations

import json
from pathlib import Path

from walk_bringup.sample import sample_path
from walk_building.progress import no_progress
from walk_plan.compare.comparison import compare
from walk_plan.compare.page import method_figures, objective_figures
from walk_plan.drawing.growth import draw_growth
from walk_plan.drawing.maps import draw_maps
from walk_plan.drawing.profiles import draw_profiles
from walk_plan.drawing.slope import draw_slope
from walk_plan.drawing.storey_plan import draw_storey
from walk_plan.options import PlanConfig
from walk_plan.pipeline import make_walkthrough
from walk_plan.stages import StageClock

FOLDER = Path(__file__).resolve().parent / "images"


def main() -> None:
    """Plans the sample building and draws its storeys, maps and profiles, and what it is compared with."""
    FOLDER.mkdir(exist_ok=True)
    walkthrough = make_walkthrough(sample_path(), PlanConfig(), StageClock(no_progress))
    storeys = list(range(len(walkthrough.building.storeys)))
    figures = {
        "ground_floor.png": draw_storey(walkthrough, 0),
        "upper_floor.png": draw_storey(walkthrough, 1),
        "maps.png": draw_maps(walkthrough, storeys),
        "profiles.png": draw_profiles(walkthrough),
    }
    measured = json.loads((FOLDER / "visibility_growth.json").read_text(encoding="utf-8"))
    figures["visibility_growth.png"] = draw_growth(measured["visibility"])
    comparison = compare(walkthrough)
    figures["objectives.png"] = objective_figures(comparison)[0]
    figures["methods.png"] = method_figures(comparison)[0]
    if not isinstance(comparison.slope, str):
        figures["slope.png"] = draw_slope(comparison.slope)
    for name, figure in figures.items():
        figure.savefig(FOLDER / name, dpi=110)


if __name__ == "__main__":
    main()
