# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The tour played: by a figure in the miniature, and as a ride from which one strays and is led back."""

import math

import pytest

pytestmark = pytest.mark.ros

START = """
  const { actions, store } = walk.client;
  await actions.stop();
  actions.set({ hand: "right", playbackPlace: PLACE, vignette: true, fade: true, teleport: true });
  walk.room.rider.stop();
  hands.head([0, 1.6, 0]);
  hands.put("left", [-0.3, 1.0, -0.1], [-0.3, 1.0, -1]);
  hands.put("right", [0.3, 1.0, -0.1], [0.3, 1.0, -1]);
  await hands.until(() => !store.state.playback.playing, "the end of playback");
  walk.room.rig.headTo(6, 0, -2);
  await hands.frames(3);
"""
PLAYER = "walk.stage.player.position"


def test_figure_runs_in_the_miniature_and_the_user_stays(headset):
    moved, eye = headset.js(
        START.replace("PLACE", "'miniature'")
        + """
      const eye = walk.view.eye.toArray();
      await hands.click("right", "a-button");
      await hands.until(() => store.state.playback.playing, "playback");
      await hands.until(() => walk.stage.inMiniature.walker.visible, "the figure");
      const from = walk.stage.inMiniature.walker.position.toArray();
      await hands.until(() => walk.stage.inMiniature.walker.position.x !== from[0], "a step");
      await hands.frames(30);
      const to = walk.stage.inMiniature.walker.position.toArray();
      await hands.click("right", "a-button");
      await hands.until(() => !store.state.playback.playing, "the pause");
      return [[from, to], [eye, walk.view.eye.toArray()]];
    """
    )
    assert math.dist(*moved) > 0.05
    assert eye[0] == pytest.approx(eye[1], abs=1e-6)


def test_ride_carries_the_rig_along_the_path_and_any_button_stops_it(headset):
    ridden = headset.js(
        START.replace("PLACE", "'ride'")
        + """
      await actions.play();
      await hands.until(() => walk.room.rider.ride.phase === "on" && store.state.playback.playing, "the ride");
      await hands.frames(3);
      const [first, start] = [hands.offTour(), walk.view.eye.toArray()];
      await hands.frames(60);
      const { eye, rig } = walk.view;
      const rode = { first, last: hands.offTour(), feet: rig.position.y, tilt: [rig.rotation.x, rig.rotation.z],
        way: Math.hypot(eye.x - start[0], eye.z - start[2]), vignette: walk.room.comfort.vignette,
        figure: walk.stage.inFull.walker.visible };
      await hands.click("left", "trigger");
      await hands.until(() => !store.state.playback.playing, "the stop");
      rode.phase = walk.room.rider.ride.phase;
      const stopped = walk.view.eye.toArray();
      await hands.frames(10);
      rode.paused = { off: hands.offTour(), figure: walk.stage.inFull.walker.visible };
      rode.drift = Math.hypot(walk.view.eye.x - stopped[0], walk.view.eye.z - stopped[2]);
      return rode;
    """
    )
    assert ridden["first"] < 0.15 and ridden["last"] < 0.15
    assert ridden["feet"] == pytest.approx(0.0, abs=0.05)
    assert ridden["way"] > 0.2
    assert ridden["tilt"] == [0, 0]
    assert ridden["vignette"] > 0.2
    assert not ridden["figure"]
    assert ridden["phase"] == "strayed"
    assert ridden["drift"] < 1e-6
    assert ridden["paused"]["off"] < 0.5 and not ridden["paused"]["figure"]


def test_who_strays_is_led_back_and_the_tour_goes_on(headset):
    back = headset.js(
        START.replace("PLACE", "'ride'")
        + """
      await actions.play();
      await hands.until(() => walk.room.rider.ride.phase === "on" && store.state.playback.playing, "the ride");
      await hands.frames(40);
      // Off the tour with the stick of the weaker hand: whichever way there is room.
      const leave = walk.view.eye.toArray();
      const away = () => Math.hypot(walk.view.eye.x - leave[0], walk.view.eye.z - leave[2]);
      for (const [x, y] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
        await hands.stick("left", x, y);
        for (let i = 0; i < 40 && away() < 0.8; i++) await hands.frames(2);
        await hands.stick("left", 0, 0);
        if (away() >= 0.8) break;
      }
      await hands.until(() => !store.state.playback.playing, "the pause");
      const strayed = { phase: walk.room.rider.ride.phase, away: away(), leftAtS: walk.room.rider.ride.leftAtS };
      await hands.click("right", "a-button");
      const led = walk.room.rider.ride.phase;
      let most = 0;
      let last = walk.view.eye.toArray();
      await hands.until(() => {
        most = Math.max(most, Math.hypot(walk.view.eye.x - last[0], walk.view.eye.z - last[2]));
        last = walk.view.eye.toArray();
        return walk.room.rider.ride.phase === "on" && store.state.playback.playing;
      }, "the tour");
      await hands.frames(5);
      const off = hands.offTour();
      await actions.stop();
      actions.set({ playbackPlace: "miniature" });
      return { ...strayed, led, most, off, timeS: store.state.playback.timeS };
    """
    )
    assert back["phase"] == "strayed"
    assert back["away"] >= 0.8
    assert back["led"] in ("back", "on")
    assert back["most"] < 0.5
    assert back["off"] < 0.3
