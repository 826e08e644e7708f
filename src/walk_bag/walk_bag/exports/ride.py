# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What is exported: a camera's way through a building, and what is beside it."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from walk_building.config import Config, param
from walk_building.model import Model


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Ride:
    """A timed camera path, in the model's coordinates: metres, z up, near the origin; m samples, K keypoints."""

    t_s: NDArray[np.float64]  # (m,) strictly rising [s]
    positions: NDArray[np.float64]  # (m, 3) of the eye [m]
    quat_xyzw: NDArray[np.float64]  # (m, 4) x axis ahead, z axis up; neighbours on the same side of the double cover
    stop: NDArray[np.bool_]  # (m,) the walker stands still
    keypoints: NDArray[np.float64]  # (K, 3) in the order of the tour [m]
    keypoint_quat_xyzw: NDArray[np.float64] | None = None  # (K, 4) where one looks there
    offset_m: NDArray[np.float64] = dataclasses.field(default_factory=lambda: np.zeros(3))
    """(3,) what leads from here to the coordinates of the building's file [m]."""
    model: Model | None = None  # the building, where it is known
    building_name: str = ""
    building_hash: str = ""

    def to_file(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Returns points (N, 3) in the building file's own coordinates, in metres and z up."""
        return np.asarray(points + self.offset_m)


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class ExportConfig(Config):
    """What the formats leave to the user."""

    fps: float = param(
        25.0, "frames a second of videos and of formats that count frames", unit="1/s", low=1.0, high=120.0
    )
    width: int = param(1280, "width of a video; even, as its coding needs", unit="pixel", low=64, high=7680)
    height: int = param(720, "height of a video; even, as its coding needs", unit="pixel", low=64, high=4320)
    samples: int = param(
        1, "samples a pixel of a video; 4 smooths the edges and takes two to three times as long", low=1, high=8
    )
    field_of_view_rad: float = param(
        1.2, "upright angle of view, about that of a phone's wide camera", unit="rad", low=0.1, high=2.6
    )
