# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Every function of the panel by mouse, before the real bridge, DDS and planner nodes."""

import pytest
from page.desk import SIZE, Desk

pytestmark = pytest.mark.ros

PARAMETER = "desk.state.parameters.find(({{ name }}) => name === '{}').value"


@pytest.fixture(scope="module")
def opened(browser, graph):
    page = browser.open(graph.url, headset=False, width=SIZE[0], height=SIZE[1])
    yield Desk(page)
    page.close()


@pytest.fixture
def desk(opened):
    opened.open("tour")
    return opened


def choose(desk, number):
    desk.page.js("walk.client.actions.select(null)")
    desk.press(f"keypoint:{number}")
    desk.page.until(f"desk.state.selection.keypoint === {number}", "that it is chosen")


def test_lock_start_end_and_order_of_the_chosen_keypoint(desk):
    number = desk.ids()[1]
    choose(desk, number)
    for button, field in (("end", "end"), ("start", "start")):
        desk.press(button)
        desk.page.until(f"desk.keypoint({number}).{field}", field)
    assert desk.ids()[0] == number
    desk.press("start")
    desk.page.until(f"!desk.keypoint({number}).start", "that the start is free")
    place = desk.ids().index(number)
    desk.press("later")
    desk.page.until(f"desk.state.keypoints.findIndex(({{ id }}) => id === {number}) === {place + 1}", "the new order")


def test_a_locked_keypoint_is_not_moved(desk):
    number = desk.ids()[0]
    was = desk.position(number)
    choose(desk, number)
    desk.press("lock")
    desk.page.until(f"desk.keypoint({number}).locked", "the lock")
    desk.look("plan")
    desk.drag(number, 15, 10)
    desk.drop()
    assert desk.position(number) == pytest.approx(was)
    assert "locked" in desk.page.js("return desk.state.refusals.at(-1).reason")
    choose(desk, number)
    desk.press("lock")
    desk.page.until(f"!desk.keypoint({number}).locked", "that it is unlocked")


def test_stay_and_look_at(desk):
    number = desk.ids()[0]
    choose(desk, number)
    desk.click(f'[data-id="dwell:{number}"] [data-id="more"]')
    desk.page.until(f"desk.keypoint({number}).dwellS === 1", "the stay")
    desk.look("plan")
    desk.press("look-at")
    x, y = desk.on_screen(number)
    desk.page.mouse(["click", x + 25, y + 5])
    desk.page.until(f"desk.keypoint({number}).lookAt !== null", "what to look at")
    desk.press("look-ahead")
    desk.page.until(f"desk.keypoint({number}).lookAt === null", "that it looks ahead")


def test_delete_undo_and_half_way_by_buttons(desk):
    before = desk.ids()
    choose(desk, before[0])
    desk.press("half-way")
    desk.page.until(f"desk.state.keypoints.length === {len(before) + 1}", "one more")
    desk.press("undo")
    desk.page.until(f"desk.state.keypoints.length === {len(before)}", "the undo")
    desk.press("redo")
    desk.page.until(f"desk.state.keypoints.length === {len(before) + 1}", "the redo")
    (added,) = set(desk.ids()) - set(before)
    choose(desk, added)
    desk.press("delete")
    desk.page.until(f"desk.state.keypoints.length === {len(before)}", "the deletion")


def test_a_slider_sets_the_planners_parameter_and_the_path_follows(desk):
    desk.open("tune")
    path = desk.revision()
    desk.page.js("document.querySelector('[data-id=\"trajopt.clearance_m\"] input').focus()")
    before = desk.page.js(f"return {PARAMETER.format('trajopt.clearance_m')}")
    desk.page.key("ArrowLeft")
    desk.path_follows(path)
    asked = desk.page.js("""
      const answer = await walk.client.ask("trajopt/get_parameters", { names: ["trajopt.clearance_m"] });
      return answer.values[0].double_value;
    """)
    assert asked < before
    assert asked == pytest.approx(desk.page.js(f"return {PARAMETER.format('trajopt.clearance_m')}"))


def test_the_optimiser_is_switched_off_and_on(desk):
    desk.open("tune")
    path = desk.revision()
    desk.press("optimiser")
    desk.path_follows(path)
    assert desk.page.js(f"return {PARAMETER.format('trajopt.mode')}") == "catmull_rom"
    path = desk.revision()
    desk.press("optimiser")
    desk.path_follows(path)
    assert desk.page.js(f"return {PARAMETER.format('trajopt.mode')}") == "optimised"


def test_order_kept_or_optimised(desk):
    desk.open("tour")
    for method in ("given", "auto"):
        desk.click(f'[data-id="order"] [data-value="{method}"]')
        desk.page.until(f"{PARAMETER.format('sequencer.method')} === '{method}'", method)
    desk.press("replan")
    assert desk.page.js("return document.querySelectorAll('.toast').length") in (0, 1)


MEANING = {"obstacle": "Red", "distance": "0: at a wall", "visibility": "How much of", "importance": "How much there"}


def test_every_map_and_every_colour_of_the_path_can_be_chosen(desk):
    desk.open("view")
    desk.page.until("desk.state.importance !== null", "the importance map")
    for name in ("obstacle", "distance", "visibility", "importance"):
        desk.click(f'[data-id="map"] [data-value="{name}"]')
        meaning = "document.querySelector('[data-id=\"map-meaning\"]')?.textContent"
        desk.page.until(f"{meaning}?.startsWith({MEANING[name]!r})", "its meaning")
        assert desk.page.js("return desk.state.settings.map") == name
        # What is there or not has no scale.
        shown = desk.page.js("return document.querySelector('[data-id=\"map-legend\"]') !== null")
        assert shown == (name != "obstacle")
    desk.click('[data-id="map"] [data-value="none"]')
    for colour in ("speed", "clearance", "height", "collisions", "plain"):
        desk.click(f'[data-id="path-colour"] [data-value="{colour}"]')
        assert desk.page.js("return desk.state.settings.pathColour") == colour
    desk.click('[data-id="surface"] [data-value="transparent"]')
    assert desk.page.js("return desk.state.settings.surface") == "transparent"
    desk.click('[data-id="surface"] [data-value="building"]')


def test_play_pause_seek_speed_and_stop(desk):
    desk.open("walk")
    desk.press("play")
    desk.page.until("desk.state.playback.playing", "playing")
    desk.click('[data-id="speed"] [data-value="2"]')
    desk.page.until("desk.state.playback.speed === 2", "the speed")
    desk.press("pause")
    desk.page.until("!desk.state.playback.playing", "the pause")
    desk.page.js("document.querySelector('.panel [data-id=\"time\"] input').focus()")
    at = desk.page.js("return desk.state.playback.timeS")
    for _ in range(3):
        desk.page.key("ArrowRight")
    desk.page.until(f"desk.state.playback.timeS > {at} + 2", "the seeking")
    desk.press("stop")
    desk.page.until("desk.state.playback.timeS === 0", "the stop")
    desk.click('[data-id="speed"] [data-value="1"]')


FRAMES = """
  const draw = async (frames, each = () => {}) => {
    const drawn = walk.room.panel.drawn;
    for (let i = 0; i < frames; i++) {
      await new Promise(requestAnimationFrame);
      each(i);
      walk.room.panel.update(0.01);
    }
    return walk.room.panel.drawn - drawn;
  };
"""


@pytest.fixture
def picture(desk):
    """The headset's panel beside a desktop, once what the planner answers to the tests before has come."""
    desk.page.js("walk.room.panel.group.visible = true")
    desk.page.until(f"await (async () => {{ {FRAMES} return draw(60); }})() === 0", "frames in which nothing is drawn")
    yield desk.page
    desk.page.js("walk.client.actions.select(null); walk.room.panel.group.visible = false")


def test_the_headsets_picture_is_drawn_only_when_something_changes(picture):
    drawn = picture.js(f"{FRAMES} walk.client.actions.select(desk.state.keypoints[0].id); return draw(60);")
    assert 1 <= drawn < 10


def test_the_headsets_picture_is_not_drawn_anew_where_it_looks_the_same(picture):
    told = "walk.client.store.set('parameters', [...desk.state.parameters]); walk.client.store.touch('keypoints');"
    assert picture.js(f"{FRAMES} {told} return draw(60);") == 0


def test_the_headsets_picture_rests_while_paths_follow_a_drag(picture):
    during, after = picture.js(f"""
      {FRAMES}
      const {{ path }} = desk.state;
      const length = path.lengthM;
      const drag = () => {{ path.lengthM += 1; walk.client.store.touch("path"); }};
      const during = await draw(100, drag);
      const after = await draw(60);
      path.lengthM = length;
      walk.client.store.touch("path");
      return [during, after];
    """)
    assert during == 0
    assert after == 1
