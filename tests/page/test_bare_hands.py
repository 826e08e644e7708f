# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Hands without controllers: they pinch."""

import math

import pytest

pytestmark = pytest.mark.ros


@pytest.fixture
def page(headset):
    headset.js("""
      hands.device.primaryInputMode = "hand";
      hands.put("left", [-0.3, 1.0, -0.1], [-0.3, 1.0, -1]);
      hands.put("right", [0.3, 1.0, -0.1], [0.3, 1.0, -1]);
      await hands.until(() => walk.room.inputs.right.bare && walk.room.inputs.right.tracked, "bare hands");
      walk.room.rig.headTo(6, 0, -2);
      await hands.frames(2);
      walk.room.bringToHand();
      walk.stage.miniature.clip.open();
      await hands.frames(2);
    """)
    yield headset
    headset.js("""
      hands.device.primaryInputMode = "controller";
      await hands.until(() => !walk.room.inputs.right.bare && walk.room.inputs.right.tracked, "controllers");
    """)


def test_pinch_moves_a_keypoint(page):
    moved = page.js("""
      const id = walk.client.store.state.keypoints[1].id;
      const from = hands.shown(id);
      await hands.reach("right", from);
      const start = hands.keypoint(id).position;
      await hands.button("right", "", 1);
      const doing = walk.room.handlers[1].doing;
      // The fingertips have met somewhere near where they were open.
      const tip = walk.room.inputs.right.tip.toArray();
      await hands.carry("right", tip, [tip[0] - 0.015, tip[1], tip[2]]);
      await hands.button("right", "", 0);
      await hands.answered();
      await hands.frames(2);
      return { doing, start, end: hands.keypoint(id).position, refusals: walk.client.store.state.refusals };
    """)
    assert moved["doing"] == "keypoint"
    assert moved["refusals"] == []
    assert math.dist(moved["start"], moved["end"]) > 0.1


def test_pinching_the_miniature_carries_it(page):
    way = page.js("""
      const { group } = walk.stage.miniature;
      const { place } = walk.stage.inMiniature;
      const at = () => group.getWorldPosition(walk.view.eye.clone());
      const corner = place.toRoom(walk.view.eye.clone().set(0, 0, 2.8), walk.view.eye.clone()).toArray();
      await hands.reach("left", corner);
      await hands.button("left", "", 1);
      const before = at();
      const doing = walk.room.handlers[0].doing;
      const tip = walk.room.inputs.left.tip.toArray();
      await hands.carry("left", tip, [tip[0], tip[1] + 0.1, tip[2]]);
      await hands.button("left", "", 0);
      return { doing, way: at().sub(before).toArray() };
    """)
    assert way["doing"] == "carry"
    assert way["way"][1] == pytest.approx(0.1, abs=0.03)
