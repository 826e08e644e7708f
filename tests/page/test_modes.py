# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The ways to look at building and path: each is a picture of its own, in the headset, with the planner's real maps."""

import pytest

pytestmark = pytest.mark.ros

PLAIN = {"surface": "building", "map": "none", "pathColour": "plain"}
MAPS = ("obstacle", "distance", "visibility", "importance")
MEASURED = "walk.client.store.state.path.clearanceM[walk.stage.tube.rowOf[walk.stage.tube.rings - 1]] > -1"
COLOURS = ("speed", "clearance", "height", "collisions")


@pytest.fixture(scope="module")
def picture(headset, tmp_path_factory):
    folder = tmp_path_factory.mktemp("modes")
    headset.js("""
      await hands.until(() => walk.client.store.state.importance, "the importance map", 60000);
      walk.room.rig.headTo(6, 0, -2);
      hands.head([0, 1.5, 0.1]);
      hands.device.quaternion.set(-0.3, 0, 0, 0.954);
      await hands.frames(3);
      walk.room.bringToHand();
      walk.stage.nameNote.hide();
      walk.client.actions.showStorey(0);
    """)

    def take(**settings):
        wanted = PLAIN | settings
        headset.js(f"walk.client.actions.set({wanted}); await hands.frames(4); walk.stage.nameNote.hide()")
        if wanted["pathColour"] in ("clearance", "height", "collisions"):
            headset.js(f"await hands.until(() => {MEASURED}, 'the measures of the path')")
        headset.js("await hands.frames(2)")
        file = folder / "picture.png"
        headset.shot(file)
        return file.read_bytes()

    yield take
    headset.js(f"walk.client.actions.set({PLAIN}); walk.client.actions.showStorey(-1)")


def test_same_mode_is_the_same_picture_and_every_other_mode_another(picture):
    plain = picture()
    assert picture() == plain
    pictures = [plain, picture(surface="transparent"), *(picture(map=name) for name in MAPS)]
    pictures += [picture(pathColour=name) for name in COLOURS]
    assert len(set(pictures)) == 2 + len(MAPS) + len(COLOURS)


def test_path_is_painted_by_what_the_planner_measured(headset, picture):
    picture(pathColour="collisions")
    green = headset.js("""
      const colours = walk.stage.tube.geometry.getAttribute("color").array;
      const used = walk.stage.tube.rings * 2 * 4;
      let green = 0;
      for (let i = 0; i < used; i += 4) if (colours[i + 1] > 2 * colours[i]) green += 1;
      return green / (used / 4);
    """)
    # A tour of the planner touches nothing.
    assert green == 1
    picture(pathColour="speed")
    kinds = headset.js("""
      const colours = walk.stage.tube.geometry.getAttribute("color").array;
      const seen = new Set();
      for (let ring = 0; ring < walk.stage.tube.rings; ring++) seen.add(colours.slice(ring * 8, ring * 8 + 3).join());
      return seen.size;
    """)
    assert kinds > 5


def test_points_of_a_map_are_few(headset, picture):
    picture(map="importance")
    count = headset.js("return walk.stage.inMiniature.map.group.children[1].geometry.getAttribute('position').count")
    assert 0 < count <= 20_000
