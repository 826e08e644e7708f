# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import json
from pathlib import Path

from walk_plan.drawing.growth import draw_growth

ROWS = [
    {"voxels": 10**k, "first_map_s": 0.01, "error_0.1_s": 0.1, "exact_s": 100.0**k / 1e6, "exact_measured": k < 5}
    for k in (4, 5, 6)
]


def test_what_is_extrapolated_is_hollow_and_nothing_else() -> None:
    (axes,) = draw_growth(ROWS).axes
    points = [line for line in axes.lines if line.get_marker() not in ("None", "")]
    hollow = sorted(float(p.get_xdata()[0]) for p in points if p.get_markerfacecolor() == "white")
    assert len(points) == 9
    assert hollow == [1e5, 1e6]


def test_what_is_drawn_in_the_documents_goes_from_ten_thousand_to_ten_million_voxels() -> None:
    kept = Path(__file__).parents[2] / "docs" / "images" / "visibility_growth.json"
    rows = json.loads(kept.read_text(encoding="utf-8"))["visibility"]
    voxels = [row["voxels"] for row in rows]
    assert voxels == sorted(voxels)
    assert voxels[0] <= 1e4
    assert voxels[-1] >= 0.99e7
