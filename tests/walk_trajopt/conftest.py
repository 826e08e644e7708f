# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from scenes import box, building_of, ramp, shell, two_rooms

from walk_building import Building
from walk_trajopt.objectives import Setting

MakeSetting = Callable[..., Setting]


@pytest.fixture(scope="session")
def hall() -> Building:
    """An empty room of 12 x 8 m."""
    return building_of(shell(12, 8))


@pytest.fixture(scope="session")
def sloping() -> Building:
    """A ramp of one in eight along x."""
    return building_of(ramp(slope=0.125))


@pytest.fixture(scope="session")
def rooms() -> Building:
    """Two rooms and a door."""
    return building_of(two_rooms())


@pytest.fixture(scope="session")
def screen() -> Building:
    """A room of 8 x 6 m with a screen of a few millimetres across it, open over the last 2 m."""
    return building_of([*shell(8, 6), box((3.998, 0, 0), (4.002, 4, 3))])


@pytest.fixture(scope="session")
def make_setting() -> MakeSetting:
    def make(building: Building, start: NDArray[np.float64], **changes: object) -> Setting:
        length = np.linalg.norm(np.diff(start, axis=0), axis=1).sum()
        values: dict[str, object] = {
            "start": start,
            "spacing_m": float(length) / (len(start) - 1),
            "keypoints": start[[0, len(start) // 2]],
            "keypoint_index": np.array([0, len(start) // 2]),
            "keypoint_radius_m": np.array([0.1, 0.1]),
            "geometry": building.geometry,
            "surface": building.surface,
            "walker": building.walker,
            "clearance_m": 0.6,
            "clearance_of": "body",
        }
        return Setting(**(values | changes))  # type: ignore[arg-type]

    return make


def eyes(*xy: tuple[float, float], z: float = 1.6) -> NDArray[np.float64]:
    return np.array([(x, y, z) for x, y in xy], dtype=np.float64)
