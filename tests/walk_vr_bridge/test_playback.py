# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Playback against a straight walk, on which every place and time is known."""

import numpy as np
import pytest

from walk_vr_bridge.playback import MAX_SPEED, Player, Timeline

AHEAD = np.array([0.0, 0.0, 0.0, 1.0])


def straight(length_s=10.0, y=0.0, reverse=False):
    """One metre a second along x, from 0 or back to it."""
    t_s = np.linspace(0.0, length_s, 41)
    x = length_s - t_s if reverse else t_s
    positions = np.stack([x, np.full_like(x, y), np.full_like(x, 1.6)], axis=1)
    return Timeline(stamp_ns=7, t_s=t_s, positions=positions, quat_xyzw=np.tile(AHEAD, (41, 1)))


@pytest.fixture
def player():
    player = Player()
    player.take(straight(), 0.0)
    return player


def test_nothing_is_played_without_a_trajectory():
    player = Player()
    assert not player.play(0.0)
    assert player.state(1.0) == {"playing": False, "t_s": 0.0, "speed": 1.0, "duration_s": 0.0, "trajectory_ns": ""}


def test_time_goes_with_the_speed_and_stays_on_a_pause(player):
    assert player.play(100.0)
    assert player.time(103.0) == pytest.approx(3.0)
    player.set_speed(2.0, 103.0)
    assert player.time(104.0) == pytest.approx(5.0)
    player.pause(104.0)
    assert player.time(110.0) == pytest.approx(5.0)
    assert player.play(110.0)
    assert player.time(111.0) == pytest.approx(7.0)


def test_it_stops_at_the_end_and_plays_again_from_the_beginning(player):
    player.play(0.0)
    assert player.time(60.0) == 10.0
    assert not player.playing
    player.play(61.0)
    assert player.time(62.0) == pytest.approx(1.0)


def test_backwards_ends_at_the_beginning(player):
    player.set_speed(-1.0, 0.0)
    player.play(0.0)
    assert player.time(4.0) == pytest.approx(6.0)
    assert player.time(99.0) == 0.0
    assert not player.playing


def test_seeking_and_speeding_stay_within_bounds(player):
    player.seek(99.0, 0.0)
    assert player.time(0.0) == 10.0
    player.seek(-1.0, 0.0)
    assert player.time(0.0) == 0.0
    player.set_speed(1e9, 0.0)
    assert player.speed == MAX_SPEED


def test_another_trajectory_is_joined_where_the_eye_is(player):
    player.play(0.0)
    player.take(straight(y=0.3, reverse=True), 4.0)
    # x = 4 is passed at 6 s on the way back.
    assert player.time(4.0) == pytest.approx(6.0, abs=0.3)
    assert player.playing
    player.take(None, 5.0)
    assert not player.playing


@pytest.mark.parametrize("at_s", [0.0, 10.0])
def test_who_waits_at_an_end_stays_there_when_an_edit_moves_it(player, at_s):
    player.seek(at_s, 0.0)
    # It begins 3 m before the first one and ends 2 m behind it.
    longer = straight(15.0)
    longer.positions[:, 0] -= 3.0
    player.take(longer, 5.0)
    assert player.time(5.0) == (15.0 if at_s else 0.0) and not player.playing


def test_on_a_trajectory_that_comes_by_twice_the_nearer_time_counts():
    there = straight()
    back = straight(reverse=True)
    t_s = np.concatenate([there.t_s, 10.25 + back.t_s])
    both = Timeline(
        stamp_ns=1,
        t_s=t_s,
        positions=np.concatenate([there.positions, back.positions]),
        quat_xyzw=np.tile(AHEAD, (82, 1)),
    )
    assert both.closest(np.array([4.0, 0.0, 1.6]), 5.0) == pytest.approx(4.0)
    assert both.closest(np.array([4.0, 0.0, 1.6]), 15.0) == pytest.approx(16.25)


def test_turns_take_the_short_way_and_stay_unit():
    turn = np.array([0.0, 0.0, np.sin(0.2), np.cos(0.2)])
    line = Timeline(
        stamp_ns=1, t_s=np.array([0.0, 1.0]), positions=np.zeros((2, 3)), quat_xyzw=np.stack([AHEAD, -turn])
    )
    quat = line.sample(0.5)[1]
    assert np.linalg.norm(quat) == pytest.approx(1.0)
    assert 2 * np.arctan2(abs(quat[2]), abs(quat[3])) == pytest.approx(0.2, abs=1e-3)
