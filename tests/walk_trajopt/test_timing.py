# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The clock and the look: closed forms on a straight line, limits everywhere, nothing sudden."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from walk_building import ParameterError
from walk_trajopt.config import TimingConfig
from walk_trajopt.curve import refine
from walk_trajopt.path import OptimisedPath
from walk_trajopt.timing import time_path
from walk_trajopt.trajectory import Trajectory


def path_of(points: NDArray[np.float64], keypoint_index: tuple[int, ...] = ()) -> OptimisedPath:
    return OptimisedPath(
        points=np.asarray(points, dtype=np.float64), keypoint_index=np.array(keypoint_index, dtype=np.int64), cost={},
        iterations=0, evaluations=0, solver="", repaired=(), colliding=(),
    )  # fmt: skip


def straight(length: float) -> OptimisedPath:
    return path_of(np.column_stack([np.linspace(0, length, 21), np.zeros(21), np.full(21, 1.6)]), (0, 10, 20))


def corner(radius: float) -> OptimisedPath:
    """6 m, a quarter circle to the left, 6 m."""
    angle = np.linspace(0, np.pi / 2, 40)
    arc = np.column_stack([6 + radius * np.sin(angle), radius * (1 - np.cos(angle)), np.full(40, 1.6)])
    return path_of(np.vstack([[0, 0, 1.6], arc, arc[-1] + [0, 6, 0]]))


def yaw_pitch(trajectory: Trajectory) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    ahead = Rotation.from_quat(trajectory.quat_xyzw).apply([1.0, 0.0, 0.0])
    return np.unwrap(np.arctan2(ahead[:, 1], ahead[:, 0])), np.arcsin(np.clip(ahead[:, 2], -1, 1))


def even(trajectory: Trajectory, values: NDArray[np.float64], step: float = 0.02) -> NDArray[np.float64]:
    return np.interp(np.arange(0, trajectory.duration_s, step), trajectory.t_s, values)


def test_a_straight_line_takes_the_time_of_its_trapezoid() -> None:
    config = TimingConfig()
    trajectory = time_path(straight(20.0), config)
    v, a, j = config.speed_mps, config.max_acceleration_mps2, config.max_jerk_mps3
    assert trajectory.duration_s == pytest.approx(20 / v + v / a + 2 * a / j, abs=0.05)
    assert trajectory.speed_mps.max() == pytest.approx(v, rel=1e-3)
    assert np.median(even(trajectory, trajectory.speed_mps)) == pytest.approx(v, rel=1e-3)


def test_a_short_line_never_reaches_the_wished_speed() -> None:
    config = TimingConfig(max_jerk_mps3=200.0)
    trajectory = time_path(straight(0.5), config)
    assert trajectory.speed_mps.max() == pytest.approx(np.sqrt(0.5 * config.max_acceleration_mps2), rel=0.03)


def test_it_starts_and_ends_at_rest_on_the_ends_of_the_path() -> None:
    path = corner(1.0)
    trajectory = time_path(path)
    np.testing.assert_allclose(trajectory.positions[[0, -1]], path.points[[0, -1]], atol=1e-9)
    assert trajectory.speed_mps[[0, -1]] == pytest.approx(0, abs=1e-6)
    assert trajectory.stop[[0, -1]].all() and not trajectory.stop[5:-5].any()


def test_samples_are_near_in_time_and_lie_on_the_path() -> None:
    path = corner(0.5)
    trajectory = time_path(path)
    steps = np.diff(trajectory.t_s)
    assert steps.min() > 0 and steps.max() <= TimingConfig().sample_s + 1e-9
    inner = path.points[1:-1]
    gap = np.linalg.norm(trajectory.positions[:, None] - inner[None], axis=2).min(axis=0)
    assert gap.max() < 1e-9, "points of the path that are no samples let the samples cut corners"


@pytest.mark.parametrize("radius", [0.3, 1.0])
def test_a_turn_is_walked_no_faster_than_its_lateral_acceleration_allows(radius: float) -> None:
    config = TimingConfig(max_turn_rate_radps=10.0)
    trajectory = time_path(corner(radius), config)
    turning = (trajectory.positions[:, 0] > 6) & (trajectory.positions[:, 1] < radius)
    middle = trajectory.speed_mps[turning][turning.sum() // 2]
    assert middle == pytest.approx(min(np.sqrt(config.max_lateral_acceleration_mps2 * radius), 1.4), rel=0.25)
    # A bend tighter than the body is averaged over the body.
    allowed = np.sqrt(config.max_lateral_acceleration_mps2 * radius) * (1.2 if radius < 0.5 else 1.02)
    assert trajectory.speed_mps[turning].min() <= allowed


@pytest.mark.parametrize("config", [TimingConfig(), TimingConfig(speed_mps=0.7), TimingConfig(max_jerk_mps3=2.0)])
def test_numeric_derivatives_stay_within_the_limits(config: TimingConfig) -> None:
    bends = np.array([[0, 0, 1.6], [3, 0, 1.6], [3.5, 2, 1.6], [6, 2.5, 2.0], [6, 0, 2.4], [9, 0, 2.4], [5, 0.3, 2.4]])
    # Lines between the samples have steps in their speed; the finer the samples, the smaller.
    trajectory = time_path(path_of(refine(bends, 0.003)[0]), dataclasses.replace(config, sample_s=0.01))
    arc = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(trajectory.positions, axis=0), axis=1))])
    s = even(trajectory, arc)
    speed = np.diff(s) / 0.02
    acceleration = np.diff(speed) / 0.02
    assert speed.max() <= config.speed_mps * 1.01
    assert np.abs(acceleration).max() <= config.max_acceleration_mps2 * 1.1
    jerk = np.diff(np.convolve(acceleration, np.full(10, 0.1), "valid")) / 0.02
    assert np.abs(jerk).max() <= config.max_jerk_mps3 * 1.1
    yaw, pitch = yaw_pitch(trajectory)
    assert np.abs(np.diff(even(trajectory, yaw)) / 0.02).max() <= config.max_turn_rate_radps * 1.01
    assert pitch == pytest.approx(0, abs=1e-9)
    assert np.einsum("ij,ij->i", trajectory.quat_xyzw[1:], trajectory.quat_xyzw[:-1]).min() > 0.99
    np.testing.assert_allclose(np.linalg.norm(trajectory.quat_xyzw, axis=1), 1)


def test_velocities_are_the_derivative_of_the_positions() -> None:
    trajectory = time_path(corner(1.0))
    numeric = np.gradient(trajectory.positions, trajectory.t_s, axis=0)
    assert np.linalg.norm(numeric - trajectory.velocities, axis=1).max() < 0.08


def test_a_dwell_stands_still_for_its_time_and_nowhere_else() -> None:
    path = straight(10.0)
    walked = time_path(path)
    trajectory = time_path(path, dwell_s=[0.0, 3.0, 0.0])
    standing = trajectory.stop & (np.abs(trajectory.positions[:, 0] - 5.0) < 1e-3)
    assert np.ptp(trajectory.t_s[standing]) == pytest.approx(3.0, abs=0.12)
    assert trajectory.stop[np.flatnonzero(standing)[0] : np.flatnonzero(standing)[-1]].all()
    assert trajectory.duration_s > walked.duration_s + 3.0
    assert not walked.stop[3:-3].any()
    assert time_path(path, TimingConfig(dwell_s=3.0)).duration_s == pytest.approx(trajectory.duration_s + 6.0, abs=1.0)


def test_rests_at_almost_one_place_are_one() -> None:
    points = np.column_stack([[0, 0.01, 2, 2.01, 2.02, 4], np.zeros(6), np.full(6, 1.6)])
    trajectory = time_path(path_of(points, (0, 1, 2, 3, 4, 5)), TimingConfig(dwell_s=1.0))
    assert np.isfinite(trajectory.t_s).all() and 6.0 < trajectory.duration_s < 16.0


def test_a_wished_duration_is_met_or_refused() -> None:
    path = straight(20.0)
    for wish in (15.0, 60.0):
        assert time_path(path, TimingConfig(duration_s=wish)).duration_s == pytest.approx(wish, abs=0.1)
    with pytest.raises(ParameterError, match="duration_s"):
        time_path(path, TimingConfig(duration_s=5.0))


def test_the_look_goes_ahead_and_turns_before_the_body() -> None:
    trajectory = time_path(corner(0.5))
    yaw, _ = yaw_pitch(trajectory)
    assert yaw[[0, -1]] == pytest.approx([0, np.pi / 2], abs=0.02)
    before = np.searchsorted(trajectory.positions[:, 0], 5.9)
    assert yaw[before] > 0.1


def test_a_look_at_target_is_faced_while_standing() -> None:
    target = np.array([[np.nan] * 3, [5.0, -8.0, 1.0], [np.nan] * 3])
    config = TimingConfig(max_pitch_rad=0.05)
    trajectory = time_path(straight(10.0), config, look_at=target, dwell_s=[0, 6.0, 0])
    yaw, pitch = yaw_pitch(trajectory)
    middle = len(yaw) // 2
    assert yaw[middle] == pytest.approx(-np.pi / 2, abs=0.03)
    assert pitch[middle] == pytest.approx(-0.05, abs=1e-3)
    assert yaw[[0, -1]] == pytest.approx(0, abs=0.02)
    assert np.abs(np.diff(even(trajectory, yaw)) / 0.02).max() <= config.max_turn_rate_radps * 1.01


def test_bad_input_is_named() -> None:
    path = straight(5.0)
    with pytest.raises(ParameterError, match="path"):
        time_path(path_of(np.zeros((3, 3))))
    with pytest.raises(ParameterError, match="look_at"):
        time_path(path, look_at=np.zeros((2, 3)))
    with pytest.raises(ParameterError, match="dwell_s"):
        time_path(path, dwell_s=[0, -1, 0])
    with pytest.raises(ParameterError, match="speed_mps"):
        TimingConfig(speed_mps=2.0, max_speed_mps=1.0)
    with pytest.raises(ParameterError, match="max_turn_rate"):
        TimingConfig(max_turn_rate_radps=float("nan"))


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.tuples(st.floats(-20, 20), st.floats(-20, 20), st.floats(1, 3)), min_size=2, max_size=7),
    st.floats(0.3, 3.0),
)
def test_any_polyline_gets_a_clock_without_steps(corners: list[tuple[float, float, float]], speed: float) -> None:
    points = np.array(corners)
    assume(np.linalg.norm(np.diff(points, axis=0), axis=1).sum() > 1e-3)
    trajectory = time_path(path_of(points), TimingConfig(speed_mps=speed))
    assert np.isfinite(trajectory.positions).all() and np.isfinite(trajectory.accelerations).all()
    assert np.diff(trajectory.t_s).min() > 0 and np.diff(trajectory.t_s).max() <= 0.05 + 1e-9
    assert trajectory.speed_mps.max() <= speed + 1e-6
    yaw, _ = yaw_pitch(trajectory)
    assert np.abs(np.diff(yaw)).max() <= 1.57 * 0.05 * 1.05
