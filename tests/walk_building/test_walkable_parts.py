# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The walkable parts of public buildings against an independent check with vertical rays and a capsule."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from walk_building import LoadOptions, load_building

# Areas [m²] of the largest parts, indoors and out, and how far up they reach [m].
PARTS = {
    "duplex.ifc": [(156, 6.5), (94, 3.2), (93, 3.2)],
    "large_building.ifc": [(154, 4.4), (141, 4.0), (141, 6.7), (118, 0.0), (114, 0.0)],
    "willowgarage.dae": [(1654, 0.0)],
    "parking_garage.dae": [(13230, 39.1), (1748, 39.1)],
    "small_house.ply": [(121, 0.2)],
}


@pytest.mark.slow
@pytest.mark.parametrize("name", PARTS)
def test_walkable_parts_agree_with_an_independent_check(name: str, buildings_dir: Path) -> None:
    building = load_building(buildings_dir / name, LoadOptions(outdoors=True))
    surface = building.surface
    found = []
    for part in range(len(PARTS[name])):
        here = surface.component == part
        found.append((here.sum() * surface.place_area_m2, surface.places[here, 2].max()))
    for (area, top), (expected, expected_top) in zip(found, PARTS[name], strict=True):
        assert area == pytest.approx(expected, rel=0.1)
        assert top == pytest.approx(expected_top, abs=0.3)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["duplex.ifc", "large_building.ifc"])
def test_a_tour_starts_on_no_roof(name: str, buildings_dir: Path) -> None:
    building = load_building(buildings_dir / name)
    reached = building.surface.places[building.reachable]
    assert reached[:, 2].min() == pytest.approx(0.0, abs=0.05)
    above = np.column_stack([reached[:, :2], reached[:, 2] + building.walker.height_m])
    up = np.broadcast_to([0.0, 0.0, 1.0], above.shape)
    assert np.isfinite(building.geometry.raycast(above, up).distance_m).mean() > 0.99
