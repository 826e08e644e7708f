# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Carrying and cutting the miniature, and getting about in the building, by controller events."""

import math

import pytest

pytestmark = pytest.mark.ros

START = """
  walk.client.actions.set({ hand: "right", snapTurn: true, teleport: true, fade: true, playbackPlace: "miniature" });
  walk.stage.miniature.clip.open();
  walk.room.rider.stop();
  const start = walk.client.store.state.building.start;
  hands.head([0, 1.6, 0]);
  hands.put("left", [-0.3, 1.0, -0.1], [-0.3, 1.0, -1]);
  hands.put("right", [0.3, 1.0, -0.1], [0.3, 1.0, -1]);
  await hands.frames(2);
  walk.room.rig.headTo(6, 0, -2);
  walk.view.rig.rotation.y = 0;
  walk.room.rig.headTo(6, 0, -2);
  await hands.frames(2);
  walk.room.bringToHand();
  await hands.frames(2);
"""


@pytest.fixture
def page(headset):
    headset.js(START)
    return headset


def test_squeeze_carries_the_miniature_upright_and_puts_it_down(page):
    was, held, put = page.js("""
      const { group } = walk.stage.miniature;
      const vector = () => walk.view.eye.clone();
      const pose = () => ({
        at: group.getWorldPosition(vector()).toArray(),
        up: vector().set(0, 0, 1).transformDirection(group.matrixWorld).toArray(),
      });
      const was = pose();
      await hands.button("right", "squeeze", 1);
      hands.device.controllers.right.position.set(0.3, 1.3, -0.1);
      hands.device.controllers.right.quaternion.set(0.25, 0, 0.1, 0.96);
      await hands.frames(3);
      const held = pose();
      await hands.button("right", "squeeze", 0);
      hands.device.controllers.right.position.set(0.6, 0.9, 0.2);
      await hands.frames(3);
      return [was, held, pose()];
    """)
    assert math.dist(was["at"], held["at"]) > 0.2
    assert held["up"] == pytest.approx([0, 1, 0], abs=1e-6)
    assert put["at"] == pytest.approx(held["at"], abs=1e-6)


def test_two_squeezes_scale_and_turn_it(page):
    before, after, turned = page.js("""
      const mini = walk.stage.miniature;
      const heading = () => { const e = mini.group.matrixWorld.elements; return Math.atan2(-e[2], e[0]); };
      const ends = (half, angle) => {
        const [x, z] = [half * Math.cos(angle), -half * Math.sin(angle)];
        hands.put("left", [-x, 1.0, -0.4 - z], [-x, 1.0, -1.4 - z]);
        hands.put("right", [x, 1.0, -0.4 + z], [x, 1.0, -1.4 + z]);
      };
      ends(0.15, 0);
      await hands.frames(3);
      await hands.button("left", "squeeze", 1);
      await hands.button("right", "squeeze", 1);
      const [scale, angle] = [mini.scale, heading()];
      ends(0.3, 0.5);
      await hands.frames(4);
      await hands.button("left", "squeeze", 0);
      await hands.button("right", "squeeze", 0);
      return [scale, mini.scale, heading() - angle];
    """)
    assert after / before == pytest.approx(2.0, rel=0.02)
    assert turned == pytest.approx(0.5, abs=0.02)


def test_knob_cuts_the_miniature_and_snaps_to_the_storey(page):
    snapped, free, gone = page.js("""
      const { clip } = walk.stage.miniature;
      const { place } = walk.stage.inMiniature;
      const knob = () => walk.room.knobs.group.children[0].getWorldPosition(walk.view.eye.clone()).toArray();
      const down = (metres) => { const at = knob(); return [at[0], at[1] - metres * place.scale, at[2]]; };
      await hands.reach("right", knob());
      await hands.button("right", "trigger", 1);
      const doing = walk.room.handlers[1].doing;
      await hands.carry("right", knob(), down(2.8 - 1.45), 8);
      const snapped = { doing, active: clip.active, storey: clip.storey, at: clip.plane.constant };
      await hands.carry("right", knob(), down(1.0), 8);
      const free = { active: clip.active, storey: clip.storey, at: clip.plane.constant };
      await hands.button("right", "trigger", 0);
      const shown = walk.stage.inMiniature.pins.counts;
      return [snapped, free, shown];
    """)
    assert snapped == {"doing": "knob", "active": True, "storey": 0, "at": pytest.approx(1.4)}
    assert free["active"] and free["storey"] == -1 and free["at"] < 1.2
    # The floors of the keypoints are below the cut: all of them stay in sight.
    assert gone["plain"] == page.js("return walk.client.store.state.keypoints.length")


def test_free_knob_holds_the_cut_askew(page):
    normal = page.js("""
      const knob = walk.room.knobs.group.children[1].getWorldPosition(walk.view.eye.clone()).toArray();
      await hands.reach("right", knob);
      await hands.button("right", "trigger", 1);
      const { quaternion: q } = hands.device.controllers.right;
      const roll = Math.PI / 6;
      q.set(Math.sin(roll / 2), 0, 0, Math.cos(roll / 2));
      await hands.frames(3);
      await hands.button("right", "trigger", 0);
      return walk.stage.miniature.clip.plane.normal.toArray();
    """)
    assert 0.4 < -normal[2] < 0.98
    assert math.hypot(*normal) == pytest.approx(1.0)


def test_snap_turn_turns_about_the_head(page):
    before, after, angle = page.js("""
      const eye = () => walk.view.eye.toArray();
      const before = eye();
      const heading = walk.view.rig.rotation.y;
      await hands.stick("right", 1, 0);
      await hands.stick("right", 0, 0);
      return [before, eye(), walk.view.rig.rotation.y - heading];
    """)
    assert after == pytest.approx(before, abs=1e-6)
    assert angle == pytest.approx(-math.pi / 6)


def test_stick_walks_on_the_floor_and_stops_at_walls(page):
    near, far, wall = page.js("""
      const at = () => walk.view.eye.toArray();
      await hands.stick("left", 0, -1);
      const first = at();
      await hands.until(() => Math.hypot(at()[0] - 6, at()[2] + 2) > 0.5, "half a metre");
      const half = at();
      for (let i = 0; i < 60; i++) await hands.frames(3);
      await hands.stick("left", 0, 0);
      return [first, half, at()];
    """)
    assert far[2] < near[2] < -1.9
    # The wall of the room is at y = 3.9: one stops before it.
    assert -3.75 < wall[2] < -3.4
    assert wall[1] == pytest.approx(1.6, abs=0.02)


def test_teleport_goes_where_the_arc_meets_the_floor(page):
    valid, target, eye, fade = page.js("""
      walk.stage.miniature.placeAt(walk.view.eye.clone().add({ x: 0, y: 0, z: 1.5 }), 0);
      const from = [6.2, 1.2, -2];
      hands.aim("right", from, [7.2, 1.05, -2.4]);
      await hands.frames(2);
      await hands.stick("right", 0, -1);
      await hands.frames(2);
      const { valid, target } = walk.room.travel.teleport;
      const goal = target.toArray();
      const done = hands.stick("right", 0, 0);
      await hands.until(() => walk.room.comfort.fade > 0, "the fade");
      const fade = walk.room.comfort.fade;
      await done;
      return [valid, goal, walk.view.eye.toArray(), fade];
    """)
    assert valid
    assert target[2] == pytest.approx(0.0, abs=0.01)
    assert [eye[0], -eye[2]] == pytest.approx(target[:2], abs=0.02)
    assert fade > 0.3


def test_pointing_into_the_miniature_teleports_there_at_full_scale(page):
    inside, eye = page.js("""
      const { place } = walk.stage.inMiniature;
      walk.stage.miniature.clip.cutStorey(0);
      await hands.frames(2);
      const there = place.toRoom(walk.view.eye.clone().set(10, 1.5, 0), walk.view.eye.clone()).toArray();
      hands.aim("right", [there[0], there[1] + 0.3, there[2] + 0.05], there);
      await hands.frames(2);
      await hands.stick("right", 0, -1);
      await hands.frames(2);
      const { inMiniature } = walk.room.travel.teleport;
      await hands.stick("right", 0, 0);
      return [inMiniature, walk.view.eye.toArray()];
    """)
    assert inside
    assert [eye[0], -eye[2]] == pytest.approx([10, 1.5], abs=0.05)
    assert eye[1] == pytest.approx(1.6, abs=0.02)


def test_what_is_at_hand_comes_along(page):
    before, after = page.js("""
      const { bin, miniature } = walk.stage;
      const off = () => [bin.group.position, miniature.group.getWorldPosition(walk.view.eye.clone())]
        .map((at) => at.clone().sub(walk.view.eye).toArray());
      const before = off();
      walk.room.travel.goTo(2, 1, 0, true);
      await hands.frames(2);
      return [before, off()];
    """)
    for was, now in zip(before, after, strict=True):
        assert now == pytest.approx(was, abs=1e-5)


def test_left_handed_users_have_it_the_other_way_round(page):
    bins, angle = page.js("""
      const side = () => walk.stage.bin.group.position.x - walk.view.eye.x;
      const right = side();
      walk.client.actions.set({ hand: "left" });
      walk.room.bringToHand();
      const left = side();
      const heading = walk.view.rig.rotation.y;
      await hands.stick("left", 1, 0);
      await hands.stick("left", 0, 0);
      const angle = walk.view.rig.rotation.y - heading;
      walk.client.actions.set({ hand: "right" });
      return [[right, left], angle];
    """)
    assert bins[0] > 0.3 and bins[1] < -0.3
    assert angle == pytest.approx(-math.pi / 6)


SEEN = """
  const { bvh } = walk.stage.models;
  const { eye } = walk.view;
  const { panel } = walk.room;
  const corners = [[0, 0], [-1, -1], [-1, 1], [1, -1], [1, 1]]
    .map(([x, y]) => eye.clone().set((x * panel.widthM) / 2, (y * panel.heightM) / 2, 0));
  panel.group.updateMatrixWorld();
  const way = (to) => {
    const [d, off] = [to.clone().sub(eye).normalize(), to.distanceTo(eye)];
    const hit = bvh.cast(eye.x, -eye.z, eye.y, d.x, -d.z, d.y, 0, off);
    return { off, free: hit.distance === Infinity };
  };
  return {
    panel: corners.map((at) => way(panel.group.localToWorld(at))),
    bin: way(walk.stage.bin.group.position),
    miniature: way(walk.stage.inMiniature.place.toRoom(eye.clone().set(6, 2, -0.2), eye.clone())),
    side: panel.group.position.clone().sub(eye).applyAxisAngle({ x: 0, y: 1, z: 0 }, -walk.view.rig.rotation.y).x,
  };
"""


@pytest.mark.parametrize(
    ("turn", "hand", "side"),
    # Turned so far to the left with a wall at the west; where the panel hangs, -1 at the left.
    [(0, "right", 1), (0, "left", 1), (math.pi, "left", -1), (math.pi / 2, "right", -1), (-math.pi / 2, "right", -1)],
)
def test_nothing_at_hand_is_behind_the_wall_that_one_stands_beside(page, turn, hand, side):
    seen = page.js(
        f"""
      walk.client.actions.set({{ hand: "{hand}" }});
      walk.view.rig.rotation.y = {turn};
      await hands.frames(2);
      // A quarter of a metre from the wall between two rooms, away from its doorway.
      walk.room.rig.headTo(4.35, 0, -2.8);
      await hands.frames(2);
      walk.room.bringToHand();
      walk.client.actions.set({{ hand: "right" }});
    """
        + SEEN
    )
    for corner in seen["panel"]:
        assert corner["free"] and corner["off"] > 0.29
    for name in ("bin", "miniature"):
        assert seen[name]["free"] and seen[name]["off"] > 0.29
    assert seen["side"] * side > 0.2


def test_everything_comes_to_hand_where_there_is_no_building_yet(page):
    off = page.js("""
      const { models } = walk.stage;
      walk.stage.models = null;
      walk.room.rig.headTo(4.35, 0, -2.8);
      await hands.frames(1);
      walk.room.bringToHand();
      walk.stage.models = models;
      return walk.room.panel.group.position.clone().sub(walk.view.eye).toArray();
    """)
    assert off == pytest.approx([-0.58, 1.25 - 1.6, -0.52], abs=0.02)
