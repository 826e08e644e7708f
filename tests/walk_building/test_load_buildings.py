# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What is known of five public buildings."""

from __future__ import annotations

import functools
import os
from pathlib import Path

import numpy as np
import pytest

from walk_building.loaders import load_model
from walk_building.model import LoadOptions, Model

# file: size [m], triangles of obstacles, doors, spaces, storeys
_FACTS = {
    "duplex.ifc": ((9.28, 26.57, 8.18), 25_332, 14, 21, 4),
    "large_building.ifc": ((53.19, 39.12, 8.15), 30_226, 18, 8, 2),
    "willowgarage.dae": ((58.63, 48.62, 2.84), 13_591, 0, 0, 0),
    "parking_garage.dae": ((60.47, 41.53, 45.91), 6_412, 0, 0, 0),
    "small_house.ply": ((19.0, 11.4, 3.0), 122_402, 0, 0, 0),
}


@functools.lru_cache
def _load(name: str, options: LoadOptions | None = None) -> Model:
    folder = Path(os.environ.get("WALK_BUILDINGS", Path(__file__).parents[3] / "shared" / "buildings"))
    if not (folder / name).is_file():
        pytest.skip(f"the public building {name} is not in {folder}")
    return load_model(folder / name, options)


@pytest.mark.parametrize("name", list(_FACTS))
def test_known_facts(name: str, capfd: pytest.CaptureFixture[str]) -> None:
    size, triangles, doors, spaces, storeys = _FACTS[name]
    model = _load(name)
    np.testing.assert_allclose(np.ptp(model.vertices, axis=0), size, atol=0.01)
    assert len(model.faces) == pytest.approx(triangles, rel=0.01)
    assert (len(model.doors), len(model.spaces), len(model.storeys)) == (doors, spaces, storeys)
    assert not any("on its side" in warning for warning in model.warnings)
    assert not model.offset_m.any()
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("name", ["willowgarage.dae", "parking_garage.dae"])
def test_inches_of_collada_are_applied(name: str) -> None:
    assert _load(name).units_m == pytest.approx(0.0254, rel=1e-6)


def test_duplex_has_named_rooms_on_their_storeys() -> None:
    model = _load("duplex.ifc")
    rooms = {space.name: (space.long_name, space.storey) for space in model.spaces}
    assert rooms["A102"] == ("Living Room", "Level 1")
    assert rooms["B203"] == ("Bedroom 2", "Level 2")
    elevations = {storey.name: storey.elevation_m for storey in model.storeys}
    assert elevations["Level 2"] == pytest.approx(3.1)
    assert all(2.0 < door.size[2] < 2.6 for door in model.doors)


def test_duplex_without_furniture_has_fewer_parts() -> None:
    full, empty = _load("duplex.ifc"), _load("duplex.ifc", LoadOptions(furniture=False))
    assert len(full.parts) - len(empty.parts) == 61
    assert full.content_hash != empty.content_hash


@pytest.mark.parametrize("name", ["duplex.ifc", "small_house.ply"])
def test_two_loads_are_equal_bit_for_bit(name: str) -> None:
    first = _load(name)
    second = load_model(first.source)
    assert first.content_hash == second.content_hash and first.parts == second.parts
    assert np.array_equal(first.vertices, second.vertices) and np.array_equal(first.faces, second.faces)


@pytest.mark.parametrize("name", list(_FACTS))
def test_buildings_laid_on_their_side_are_suspected(name: str) -> None:
    model = _load(name, LoadOptions(up="y"))
    assert any("on its side" in warning for warning in model.warnings)
