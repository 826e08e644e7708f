# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a user can tune about the path and about the clock."""

from __future__ import annotations

import dataclasses

from walk_building.config import Config, param
from walk_building.errors import ParameterError


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class TrajoptConfig(Config):
    """The trajectory problem: its points, the weights of its objectives, and how it is solved.

    Every objective is an integral along the path (`docs/trajectory.md`), so the weights mean the same whatever the
    number of points. Deviation and smoothness balance over a length of (weight_smoothness / weight_deviation)^(1/4)
    metres. The weights are our own: the source prints none.
    """

    mode: str = param(
        "optimised",
        "optimised, which is checked too; or the source's manual mode, a spline through the keypoints in their order "
        "that is not optimised: its collisions are told, not mended",
        choices=("optimised", "catmull_rom", "b_spline"),
    )
    points: int = param(
        0,
        "number of points that are optimised; 0 takes one every spacing_m, and 100 for a short tour",
        low=0,
        high=100_000,
    )
    spacing_m: float = param(
        0.25,
        "distance between points where `points` is 0; half a doorway's depth, so that no wall hides between two",
        unit="m",
        low=0.02,
        high=5.0,
    )
    weight_deviation: float = param(0.01, "pull towards the planned tour", low=0.0, high=1e6)
    weight_length: float = param(0.01, "pull towards a short path", low=0.0, high=1e6)
    weight_smoothness: float = param(1.0, "pull towards an even, smooth path", low=0.0, high=1e6)
    weight_clearance: float = param(50.0, "push away from what is nearer than clearance_m", low=0.0, high=1e6)
    weight_height: float = param(100.0, "pull towards the eye height above the floor", low=0.0, high=1e6)
    weight_keypoints: float = param(
        20.0, "pull towards keypoints that are missed by more than keypoint_radius_m (our own)", low=0.0, high=1e6
    )
    keypoint_radius_m: float = param(
        0.5,
        "how near to a keypoint the path passes, so that it can turn there; half the room around it where that is less",
        unit="m",
        low=0.0,
        high=10.0,
    )
    clearance_m: float = param(
        0.42, "wished distance D between the body's axis, or the eye, and the building", unit="m", low=0.0, high=10.0
    )
    clearance_of: str = param(
        "body",
        "what keeps the distance: the body's axis, so that tables and railings below the eye repel too (our own), "
        "or the eye alone (the source)",
        choices=("body", "eye"),
    )
    solver: str = param(
        "levenberg_marquardt",
        "how the problem is minimised; lbfgs is the source's",
        choices=("levenberg_marquardt", "lbfgs", "lbfgs_whitened"),
    )
    max_iterations: int = param(300, "iterations after which a solver stops", low=0, high=100_000)
    tolerance: float = param(
        1e-4, "a solver stops when an iteration lowers the cost by less than this share of it", low=1e-15, high=0.1
    )
    chord_error_m: float = param(
        0.003,
        "largest distance between the smooth curve through the points and the checked polyline that stands for it",
        unit="m",
        low=1e-4,
        high=0.1,
    )

    def __post_init__(self) -> None:
        # The two-argument form: slots=True makes a new class, which the bare super() would not find.
        super(TrajoptConfig, self).__post_init__()
        weights = [f.name for f in dataclasses.fields(self) if f.name.startswith("weight_")]
        if not any(getattr(self, name) > 0.0 for name in weights):
            raise ParameterError("weights", 0.0, "at least one of " + ", ".join(weights) + " above zero")
        if self.points == 1:
            raise ParameterError("points", self.points, "0, or at least 2")

    def weight(self, objective: str) -> float:
        """Returns the weight of the objective of that name."""
        return float(getattr(self, f"weight_{objective}"))


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class TimingConfig(Config):
    """The clock and the look direction. No published limits were found for the turn rates: they are our own."""

    speed_mps: float = param(1.4, "wished walking speed", unit="m/s", low=0.05, high=3.0)
    max_speed_mps: float = param(
        3.0, "speed that is never exceeded, whatever duration is wished", unit="m/s", low=0.05, high=3.0
    )
    max_acceleration_mps2: float = param(1.6, "largest change of speed", unit="m/s²", low=0.05, high=10.0)
    max_lateral_acceleration_mps2: float = param(
        2.6, "largest acceleration sideways: it slows the walker down in turns", unit="m/s²", low=0.05, high=20.0
    )
    max_jerk_mps3: float = param(
        32.0, "largest change of acceleration along the path", unit="m/s³", low=0.2, high=200.0
    )
    max_turn_rate_radps: float = param(
        1.57,
        "fastest turn of the look direction, 90° a second; what makes people sick first",
        unit="rad/s",
        low=0.05,
        high=10.0,
    )
    max_turn_acceleration_radps2: float = param(
        6.0, "fastest change of the turn rate", unit="rad/s²", low=0.1, high=200.0
    )
    lookahead_m: float = param(
        0.4, "how far ahead on the path the look direction is taken", unit="m", low=0.0, high=5.0
    )
    look_smoothing_m: float = param(
        0.7,
        "length over which the direction of the path is averaged for the look direction",
        unit="m",
        low=0.05,
        high=5.0,
    )
    look_at_m: float = param(
        1.5,
        "distance along the path from a keypoint at which the look begins to turn to what is seen there",
        unit="m",
        low=0.0,
        high=20.0,
    )
    look_at_share: float = param(
        0.5, "how far the look turns from ahead towards it while walking; at a dwell it turns fully", low=0.0, high=1.0
    )
    max_pitch_rad: float = param(0.2, "steepest look up or down, towards a target", unit="rad", low=0.0, high=1.5)
    dwell_s: float = param(0.0, "time to stand still at each keypoint; 0 walks through", unit="s", low=0.0, high=3600.0)
    duration_s: float = param(
        0.0, "wished duration of the whole walk; 0 lets the speed decide", unit="s", low=0.0, high=1e6
    )
    sample_s: float = param(0.05, "longest time between two samples", unit="s", low=0.002, high=0.1)

    def __post_init__(self) -> None:
        # The two-argument form: slots=True makes a new class, which the bare super() would not find.
        super(TimingConfig, self).__post_init__()
        if self.speed_mps > self.max_speed_mps:
            raise ParameterError("speed_mps", self.speed_mps, f"at most max_speed_mps, {self.max_speed_mps:g} m/s")
