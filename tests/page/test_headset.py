# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What hands do in the headset, by controller events through bridge, DDS and planner."""

import math

import pytest

pytestmark = pytest.mark.ros

MOST_CALLS, MOST_TRIANGLES = 120, 600_000


def keypoints(page):
    return {k["id"]: k for k in page.js("return walk.client.store.state.keypoints")}


def distance(a, b):
    return math.dist(a, b)


def quiet(page):
    """Waits until nothing is unconfirmed or held."""
    page.until("walk.client.store.state.connection.unconfirmed === 0 && 1", "the planner's answers")


def test_building_and_miniature_are_there_at_once_within_the_budget(headset):
    page = headset
    info = page.js("await hands.frames(2); return {...walk.view.renderer.info.render}")
    assert page.js("return walk.stage.mode") == "room"
    assert page.js("return walk.stage.inFull.place.group.visible && walk.stage.inMiniature.place.group.visible")
    scale = page.js("return walk.stage.inMiniature.place.scale")
    assert 0.6 / 12.4 * 0.9 < scale < 0.6 / 12.4 * 1.1
    assert 0 < info["calls"] <= MOST_CALLS
    assert 0 < info["triangles"] <= MOST_TRIANGLES


def test_near_hand_moves_a_keypoint_in_the_miniature_and_the_path_follows(headset):
    page = headset
    moved = page.js("""
      const id = walk.client.store.state.keypoints[1].id;
      const before = walk.client.store.state.path.revision;
      const from = hands.shown(id);
      await hands.reach("right", from);
      const picked = walk.room.handlers[1].pick.id;
      await hands.button("right", "trigger", 1);
      const start = hands.keypoint(id).position;
      const to = [from[0] + 0.02, from[1], from[2]];
      await hands.carry("right", from, to);
      await hands.until(() => walk.client.store.state.path.revision !== before, "a path while dragging");
      const during = walk.client.store.state.path.revision;
      const wished = hands.keypoint(id).position;
      await hands.button("right", "trigger", 0);
      await hands.answered();
      await hands.until(() => walk.client.store.state.path.revision !== during, "the path after the release");
      const { refusals } = walk.client.store.state;
      return { id, picked, start, wished, end: hands.keypoint(id).position, refusals };
    """)
    assert moved["picked"] == moved["id"]
    assert moved["refusals"] == []
    assert distance(moved["start"][:2], moved["wished"][:2]) > 0.2
    # The planner stands the keypoint on the floor below the wish.
    assert distance(moved["end"][:2], moved["wished"][:2]) < 0.15


def test_refusal_is_shown_where_it_happened_and_the_keypoint_goes_back(headset):
    page = headset
    refused = page.js("""
      const id = walk.client.store.state.keypoints[1].id;
      const from = hands.shown(id);
      const start = hands.keypoint(id).position;
      await hands.reach("right", from);
      await hands.button("right", "trigger", 1);
      const to = [from[0], from[1], from[2] - 0.25];
      await hands.carry("right", from, to);
      await hands.button("right", "trigger", 0);
      await hands.answered();
      await hands.until(() => walk.stage.refusalNote.mesh.visible, "the note");
      await hands.frames(2);
      const note = walk.stage.refusalNote;
      return { start, end: hands.keypoint(id).position, text: note.text, at: note.mesh.position.toArray(), to };
    """)
    assert refused["end"] == pytest.approx(refused["start"], abs=1e-6)
    assert len(refused["text"]) > 10
    assert distance(refused["at"], refused["to"]) < 0.15
    page.js("walk.client.store.set('refusals', []); walk.stage.refusalNote.hide()")


def test_bin_deletes_and_the_second_button_undoes(headset):
    page = headset
    quiet(page)
    before = keypoints(page)
    gone = page.js("""
      const id = walk.client.store.state.keypoints[1].id;
      const from = hands.shown(id);
      await hands.reach("right", from);
      await hands.button("right", "trigger", 1);
      await hands.carry("right", from, walk.stage.bin.group.position.toArray());
      await hands.button("right", "trigger", 0);
      await hands.until(() => !hands.keypoint(id), "the keypoint to go");
      return id;
    """)
    assert gone in before
    quiet(page)
    page.js(f"""
      hands.put("right", [0.3, 1.0, -0.1], [0.3, 1.0, -1]);
      await hands.click("right", "b-button");
      await hands.until(() => hands.keypoint({gone}), "the keypoint to come back");
    """)
    quiet(page)
    after = keypoints(page)
    assert set(after) == set(before)
    assert after[gone]["position"] == pytest.approx(before[gone]["position"], abs=0.02)


def test_ray_moves_a_keypoint_at_full_scale(headset):
    page = headset
    moved = page.js("""
      const { store } = walk.client;
      // Stand two metres from a keypoint of this room and point at it, the miniature put aside.
      const id = store.state.keypoints[0].id;
      const [x, y, z] = hands.keypoint(id).position;
      const away = x < 2 ? 1.2 : -1.2;
      walk.room.rig.headTo(x + away, z - walk.stage.eyeHeightM, -y);
      await hands.frames(2);
      walk.stage.miniature.placeAt(walk.view.eye.clone().add({ x: 0, y: 0, z: 1.2 }), 0);
      await hands.frames(2);
      const from = walk.view.eye.toArray();
      from[1] -= 0.1;
      const at = hands.shown(id, "full");
      hands.aim("right", from, at);
      await hands.frames(3);
      const pick = { id: walk.room.handlers[1].pick.id, where: walk.room.handlers[1].pick.overlay?.place.name };
      await hands.button("right", "trigger", 1);
      const start = hands.keypoint(id).position;
      hands.aim("right", from, [at[0], at[1], at[2] - 0.25]);
      await hands.frames(4);
      await hands.button("right", "trigger", 0);
      await hands.answered();
      await hands.frames(2);
      const end = hands.keypoint(id).position;
      const refusals = store.state.refusals.map((one) => one.reason);
      walk.room.bringToHand();
      return { id, pick, start, end, refusals };
    """)
    assert moved["pick"] == {"id": moved["id"], "where": "full"}
    assert moved["refusals"] == []
    assert 0.1 < distance(moved["start"], moved["end"]) < 0.6


def test_chosen_keypoint_looks_where_the_ray_meets_the_building(headset):
    page = headset
    seen = page.js("""
      const { store, actions } = walk.client;
      const { id, position: [x, y, z] } = store.state.keypoints[0];
      walk.room.rig.headTo(x, z - walk.stage.eyeHeightM, -y);
      await hands.frames(2);
      walk.stage.miniature.placeAt(walk.view.eye.clone().add({ x: 0, y: 0, z: 1.2 }), 0);
      actions.select(id);
      actions.useTool("lookAt");
      const from = walk.view.eye.toArray();
      // Towards the wall at y = 4, steeply enough to be no keypoint's ray.
      hands.aim("right", from, [from[0], from[1] + 0.2, -4]);
      await hands.frames(3);
      await hands.click("right", "trigger");
      await hands.answered();
      await hands.until(() => hands.keypoint(id).lookAt, "what to look at");
      walk.room.bringToHand();
      return { at: hands.keypoint(id).lookAt, x, tool: store.state.selection.tool };
    """)
    assert seen["tool"] == "edit"
    assert seen["at"][:2] == pytest.approx([seen["x"], 3.9], abs=0.02)


def test_new_keypoint_goes_to_the_best_place_around_where_that_is_wanted(headset):
    page = headset
    added = page.js("""
      const { store, actions } = walk.client;
      walk.stage.miniature.clip.cutStorey(0);
      walk.desktop.panel.open("tour");
      walk.room.travel.goTo(6, 2, 0, false);
      await hands.frames(2);
      walk.room.bringToHand();
      await hands.frames(3);
      actions.set({ addNear: true });
      const before = store.state.keypoints.map((one) => one.id);
      await hands.atPanel("right", "add");
      await hands.button("right", "trigger", 1);
      const { place } = walk.stage.inMiniature;
      // In the corner, where nobody can stand.
      const goal = walk.view.eye.clone().set(11.85, 0.15, 1.0);
      await hands.reach("right", place.toRoom(goal, goal).toArray());
      await hands.button("right", "trigger", 0);
      await hands.answered();
      actions.set({ addNear: false });
      walk.stage.miniature.clip.open();
      const fresh = store.state.keypoints.find((one) => !before.includes(one.id));
      return { at: fresh?.position, refusals: store.state.refusals.map((one) => one.reason) };
    """)
    assert added["refusals"] == []
    assert distance(added["at"][:2], [11.85, 0.15]) > 0.1


def test_keypoint_is_added_by_dragging_it_from_the_panel_into_the_miniature(headset):
    page = headset
    added = page.js("""
      const { store } = walk.client;
      const { travel } = walk.room;
      walk.stage.miniature.clip.cutStorey(0);
      walk.desktop.panel.open("tour");
      travel.goTo(6, 2, 0, false);
      await hands.frames(2);
      walk.room.bringToHand();
      await hands.frames(3);
      const before = store.state.keypoints.map((one) => one.id);
      await hands.atPanel("right", "add");
      await hands.button("right", "trigger", 1);
      const doing = walk.room.handlers[1].doing;
      const { place } = walk.stage.inMiniature;
      const goal = walk.view.eye.clone().set(10, 1.2, 1.0);
      await hands.reach("right", place.toRoom(goal, goal).toArray());
      await hands.button("right", "trigger", 0);
      await hands.until(() => store.state.keypoints.length > before.length, "a new keypoint");
      const fresh = store.state.keypoints.find((one) => !before.includes(one.id));
      walk.stage.miniature.clip.open();
      return { doing, at: fresh.position, refusals: store.state.refusals.map((one) => one.reason) };
    """)
    assert added["doing"] == "add"
    assert added["refusals"] == []
    assert added["at"] == pytest.approx([10, 1.2, 1.6], abs=0.15)


def test_keypoint_is_added_by_dragging_it_from_the_panel_into_the_room(headset):
    page = headset
    added = page.js("""
      const { store } = walk.client;
      const { travel } = walk.room;
      travel.goTo(2, 1.5, 0, false);
      await hands.frames(2);
      walk.room.bringToHand();
      walk.stage.miniature.placeAt(walk.view.eye.clone().add({ x: 0, y: 0, z: 1.2 }), 0);
      await hands.frames(3);
      const before = store.state.keypoints.map((one) => one.id);
      await hands.atPanel("right", "add");
      await hands.button("right", "trigger", 1);
      const eye = walk.view.eye.toArray();
      hands.aim("right", [eye[0] + 0.2, 1.3, eye[2] - 0.2], [3, 0, -2.8]);
      await hands.frames(4);
      await hands.button("right", "trigger", 0);
      await hands.until(() => store.state.keypoints.length > before.length, "a new keypoint");
      const fresh = store.state.keypoints.find((one) => !before.includes(one.id));
      walk.room.bringToHand();
      return { at: fresh.position, refusals: store.state.refusals.map((one) => one.reason) };
    """)
    assert added["refusals"] == []
    assert added["at"] == pytest.approx([3, 2.8, 1.6], abs=0.15)


def test_panel_is_pressed_by_a_ray(headset):
    tab = headset.js("""
      await hands.atPanel("left", "tab:view");
      await hands.click("left", "trigger");
      const { tab } = walk.desktop.panel;
      walk.desktop.panel.open("tour");
      return tab;
    """)
    assert tab == "view"


def test_nothing_went_wrong_in_the_page(headset):
    # The browser notes every file that is not there yet; the page waits for it.
    assert [words for words in headset.said() if "Failed to load resource" not in words] == []
