# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The keypoints of a recorded camera path, on paths whose bends and stands are known."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from walk_bag import BagError, BagWriter
from walk_bag.camera_path import camera_keypoints
from walk_bag.walkthrough import bag_topic
from walk_ros import conversions as c
from walk_ros.diagnostics import Diagnostics
from walk_ros.raw import to_bytes

AHEAD = [0.0, 0.0, 0.0, 1.0]
BACK = [0.0, 0.0, 1.0, 0.0]


def write(path: Path, points: NDArray[np.float64], turns: list[list[float]], offset: str = "") -> Path:
    with BagWriter(path) as writer:
        if offset:
            told = Diagnostics("/walk/plan")
            told.building("house.ifc", "ab")
            told.note(offset_m=offset)
            writer.write(bag_topic("/diagnostics"), 0, to_bytes(told.to_msg(0)))
        for k, (point, turn) in enumerate(zip(points, turns, strict=True)):
            at = k * 50_000_000
            writer.write(bag_topic("viewpoint"), at, to_bytes(c.viewpoint_to_msg(point, np.array(turn), at)))
    return path


def leg(a: tuple[float, float, float], b: tuple[float, float, float], steps: int) -> NDArray[np.float64]:
    return np.linspace(a, b, steps)


def test_ends_bends_and_stands_become_keypoints_with_their_looks(tmp_path: Path) -> None:
    corner, rest = (4.0, 0.0, 1.6), (4.0, 3.0, 1.6)
    points = np.vstack(
        [leg((0, 0, 1.6), corner, 80), leg(corner, rest, 60), leg(rest, rest, 40), leg(rest, (4, 6, 1.6), 60)]
    )
    turns = [AHEAD] * 140 + [BACK] * 40 + [AHEAD] * 60
    found = camera_keypoints(write(tmp_path / "c.mcap", points, turns))
    np.testing.assert_allclose(found.positions, [(0, 0, 1.6), corner, rest, (4, 6, 1.6)], atol=0.1)
    np.testing.assert_allclose(found.quat_xyzw[2], BACK, atol=1e-6)
    np.testing.assert_allclose(found.quat_xyzw[3], AHEAD, atol=1e-6)
    assert found.looks.all() and not found.of_building


def test_every_place_of_the_camera_is_near_the_line_through_the_keypoints(tmp_path: Path) -> None:
    angle = np.linspace(0.0, 3 * np.pi, 400)
    points = np.column_stack([5 * np.cos(angle), 3 * np.sin(angle), np.full(400, 1.6)])
    found = camera_keypoints(write(tmp_path / "c.mcap", points, [AHEAD] * 400)).positions
    line = np.vstack([leg(a, b, 200) for a, b in itertools.pairwise(found)])
    assert np.linalg.norm(points[:, None] - line[None], axis=2).min(axis=1).max() <= 0.55
    assert 8 <= len(found) <= 40


def test_positions_are_the_building_files_where_the_bag_tells_the_offset(tmp_path: Path) -> None:
    points = leg((0, 0, 1.6), (4, 0, 1.6), 50)
    found = camera_keypoints(write(tmp_path / "c.mcap", points, [AHEAD] * 50, "[100.0, 20.0, 3.0]"))
    assert found.of_building
    np.testing.assert_allclose(found.positions, [(100, 20, 4.6), (104, 20, 4.6)], atol=1e-9)


def test_a_camera_that_went_nowhere_is_said(tmp_path: Path) -> None:
    bag = write(tmp_path / "c.mcap", leg((1, 1, 1.6), (1, 1, 1.6), 20), [AHEAD] * 20)
    with pytest.raises(BagError, match="no viewpoint that moves"):
        camera_keypoints(bag)
