# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The walker: the person whose body has to fit through the building."""

from __future__ import annotations

import dataclasses

from walk_building.config import Config, param
from walk_building.errors import ParameterError


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Walker(Config):
    """A vertical capsule that hangs from the eye.

    The body covers the heights from `step_m` to `height_m` above the floor: what is lower than a step is
    stepped over. Its axis therefore runs from `axis_low_m` to `axis_high_m` above the floor, and a body at an
    eye position `e` is the set of points nearer than `radius_m` to the segment from
    `e - (0, 0, eye_height_m - axis_low_m)` to `e - (0, 0, eye_height_m - axis_high_m)`.
    """

    radius_m: float = param(0.25, "radius of the body", unit="m", low=0.05, high=1.0)
    height_m: float = param(1.8, "height of the body", unit="m", low=0.5, high=3.0)
    eye_height_m: float = param(1.6, "height of the eye above the floor", unit="m", low=0.3, high=2.9)
    step_m: float = param(0.25, "highest step that is climbed or stepped over", unit="m", low=0.0, high=0.6)
    max_slope_deg: float = param(40.0, "steepest floor that is walked on", unit="deg", low=0.0, high=60.0)

    def __post_init__(self) -> None:
        # The two-argument form: slots=True makes a new class, which the bare super() would not find.
        super(Walker, self).__post_init__()
        if self.eye_height_m > self.height_m:
            raise ParameterError("eye_height_m", self.eye_height_m, f"at most height_m, {self.height_m:g} m")
        if self.step_m + 2 * self.radius_m > self.height_m:
            raise ParameterError(
                "height_m", self.height_m, f"at least step_m + 2 * radius_m, {self.step_m + 2 * self.radius_m:g} m"
            )

    @property
    def axis_low_m(self) -> float:
        """Height of the body axis's lower end above the floor [m]."""
        return self.step_m + self.radius_m

    @property
    def axis_high_m(self) -> float:
        """Height of the body axis's upper end above the floor [m]."""
        return self.height_m - self.radius_m
