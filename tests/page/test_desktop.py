# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The page by mouse and keyboard, before the real bridge, DDS and planner nodes."""

import math

import pytest
from page.desk import SIZE, Desk

pytestmark = pytest.mark.ros


@pytest.fixture(scope="module")
def opened(browser, graph):
    page = browser.open(graph.url, headset=False, width=SIZE[0], height=SIZE[1])
    yield Desk(page)
    page.close()


@pytest.fixture
def desk(opened):
    opened.page.key("Escape")
    opened.page.key("Escape")
    opened.look("plan")
    opened.open("tour")
    return opened


def test_a_keypoint_follows_the_mouse_and_stays_where_it_is_dropped(desk):
    number = desk.ids()[0]
    was, path = desk.position(number), desk.revision()
    desk.drag(number, 12, 9)
    held = desk.position(number)
    assert math.dist(was[:2], held[:2]) > 0.05
    desk.path_follows(path)  # while it is still held
    desk.drop()
    assert math.dist(held[:2], desk.position(number)[:2]) < 0.3
    assert desk.page.js("return desk.state.refusals.length") == 0


@pytest.mark.parametrize("view", ["orbit", "walk"])
def test_it_can_be_moved_in_every_view(desk, view):
    desk.look(view)
    number = desk.page.js("""
      const inPicture = ({ position }) => {
        const [x, y] = desk.onScreen(position);
        return x > 220 && x < 680 && y > 120 && y < 580;
      };
      const ahead = ({ position }) => {
        const at = walk.view.eye.clone();
        walk.stage.overlayInView().place.shown(position, at);
        return at.project(walk.desktop.camera).z < 1;
      };
      return desk.state.keypoints.filter(ahead).find(inPicture)?.id ?? null;
    """)
    assert number is not None, "no keypoint is in the picture from where one begins"
    was = desk.position(number)
    desk.drag(number, 10, 4)
    assert math.dist(was[:2], desk.position(number)[:2]) > 0.01
    desk.page.key("Escape")  # put back
    desk.page.mouse(["up"])
    desk.quiet()
    assert math.dist(was, desk.position(number)) < 1e-3


def test_undo_and_redo_keys_take_a_move_back_and_do_it_again(desk):
    number = desk.ids()[0]
    was = desk.position(number)
    desk.drag(number, -10, 8)
    desk.drop()
    moved = desk.position(number)
    desk.page.key("Control+z")
    desk.page.until(f"Math.hypot(...desk.keypoint({number}).position.map((x, i) => x - {was}[i])) < 1e-3", "undo")
    desk.page.key("Control+y")
    desk.page.until(f"Math.hypot(...desk.keypoint({number}).position.map((x, i) => x - {moved}[i])) < 1e-3", "redo")


def test_what_is_refused_goes_back_and_is_told_where_it_happened(desk):
    number = desk.ids()[0]
    was = desk.position(number)
    place = desk.page.js("""
      const { min } = desk.state.building;
      return desk.onScreen([min[0] - 0.5, min[1] - 0.8, 1.6]);
    """)
    x, y = desk.on_screen(number)
    desk.page.mouse(["move", x, y], ["down"], ["move", x - 20, y], ["move", *place])
    wished = desk.position(number)
    desk.drop()
    assert math.dist(was, desk.position(number)) < 1e-3
    reason = desk.page.js("return desk.state.refusals.at(-1).reason")
    toast = desk.page.js("""
      const toast = [...document.querySelectorAll(".toast")].at(-1);
      const box = toast.getBoundingClientRect();
      const live = Boolean(toast.closest("[role=alert]"));
      return { text: toast.textContent, x: box.x + box.width / 2, bottom: box.bottom, live };
    """)
    assert reason and reason.lower()[:20] in toast["text"].lower()
    assert toast["live"]
    at = desk.page.js(f"return desk.onScreen({wished})")
    assert abs(toast["bottom"] - at[1]) < 40
    desk.click(".toast button")
    desk.page.until("document.querySelectorAll('.toast').length === 0", "the toast's end")


def test_a_toast_goes_by_itself_unless_one_is_at_it(desk):
    # The clock set ahead for some frames; then it is back, so that what holds the toast has held it till now.
    later = """
      const { now } = Date;
      Date.now = () => now() + MS;
      const end = walk.view.frames + 3;
      while (walk.view.frames < end) await new Promise((done) => setTimeout(done, 5));
      Date.now = now;
      return document.querySelectorAll(".toast").length;
    """
    desk.page.js("await walk.client.actions.setStart(9999)")
    desk.page.until("document.querySelectorAll('.toast').length === 1", "the toast")
    assert "9999" in desk.page.js("return document.querySelector('.toast').textContent")
    # Whatever the pointer has been at before.
    desk.page.mouse(["move", 5, SIZE[1] - 5])
    desk.page.until("!document.querySelector('.toast:hover')", "the pointer elsewhere")
    assert desk.page.js(later.replace("MS", "9000")) == 1
    desk.page.mouse(["move", *desk.page.js("return desk.middle('.toast')")])
    desk.page.until("document.querySelector('.toast:hover')", "the pointer over it")
    assert desk.page.js(later.replace("MS", "11000")) == 1
    desk.page.js("document.querySelector('.toast button').focus()")
    desk.page.mouse(["move", 5, SIZE[1] - 5])
    desk.page.until("!document.querySelector('.toast:hover')", "the pointer elsewhere")
    assert desk.page.js(later.replace("MS", "11000")) == 1
    desk.page.js("walk.view.renderer.domElement.focus()")
    assert desk.page.js(later.replace("MS", "9000")) == 1
    assert desk.page.js(later.replace("MS", "11000")) == 0


def test_a_keypoint_is_added_by_dragging_it_out_of_the_panel_and_deleted_by_a_key(desk):
    before = desk.ids()
    x, y = desk.page.js("return desk.middle('.drag-source')")
    first = desk.position(before[0])
    to = desk.page.js(f"return desk.onScreen([{first[0]} + 0.6, {first[1]} + 0.4, {first[2]}])")
    desk.page.mouse(["move", x, y], ["down"], ["move", x - 30, y + 10], ["move", *to])
    assert desk.page.js("return document.querySelectorAll('.ghost.over').length") == 1
    desk.page.mouse(["up"])
    desk.page.until(f"desk.state.keypoints.length === {len(before) + 1}", "the new keypoint")
    (added,) = set(desk.ids()) - set(before)
    assert math.dist(desk.position(added)[:2], [first[0] + 0.6, first[1] + 0.4]) < 0.4
    desk.page.until(f"desk.state.selection.keypoint === {added}", "that it is chosen")
    desk.page.js("walk.view.renderer.domElement.focus()")
    desk.page.key("Delete")
    desk.page.until(f"desk.state.keypoints.length === {len(before)}", "the deletion")
    assert set(desk.ids()) == set(before)


def test_adding_by_a_key_and_a_click(desk):
    before = desk.ids()
    desk.page.js("walk.view.renderer.domElement.focus()")
    desk.page.key("n")
    x, y = desk.on_screen(before[0])
    desk.page.mouse(["click", x + 18, y + 18])
    desk.page.until(f"desk.state.keypoints.length === {len(before) + 1}", "the new keypoint")
    desk.page.key("Control+z")
    desk.page.until(f"desk.state.keypoints.length === {len(before)}", "its undo")


def test_walking_by_keys_stays_on_the_floor_and_out_of_the_walls(desk):
    desk.look("walk")
    eye = "walk.view.camera.getWorldPosition(walk.view.eye.clone()).toArray()"
    begin = desk.page.js(f"return {eye}")
    desk.page.js("""
      const press = (kind) => new KeyboardEvent(kind, { code: "KeyW", key: "w", bubbles: true });
      walk.view.renderer.domElement.dispatchEvent(press("keydown"));
      for (let i = 0; i < 150; i++) await new Promise(requestAnimationFrame);
      walk.view.renderer.domElement.dispatchEvent(press("keyup"));
    """)
    end = desk.page.js(f"return {eye}")
    assert math.dist(begin, end) > 0.2
    low, high = desk.page.js("return [desk.state.building.min, desk.state.building.max]")
    assert low[0] < end[0] < high[0] and low[1] < -end[2] < high[1]
    assert end[1] == pytest.approx(begin[1], abs=0.5)


def test_the_tour_plays_by_the_space_key_and_takes_one_along(desk):
    desk.open("walk")
    desk.click('[data-id="place"] [data-value="ride"]')
    desk.page.js("walk.view.renderer.domElement.focus()")
    desk.page.key(" ")
    desk.page.until("desk.state.playback.playing && walk.desktop.viewName === 'walk'", "the ride")
    begin = desk.page.js("return walk.view.eye.toArray()")
    desk.page.until(f"walk.view.eye.distanceTo({{x: {begin[0]}, y: {begin[1]}, z: {begin[2]}}}) > 0.3", "movement")
    desk.page.key(" ")
    desk.page.until("!desk.state.playback.playing", "the pause")
    # One stands where the figure would: it is not drawn before the eyes.
    figure = "walk.stage.inFull.walker.visible"
    off = "(([x, y], [a, , b]) => Math.hypot(x - a, -y - b))(walk.stage.player.position, walk.view.eye.toArray())"
    desk.settle()
    assert desk.page.js(f"return [{off} < 0.5, {figure}]") == [True, False]
    desk.page.js("walk.client.actions.seek(0.8 * desk.state.playback.durationS)")
    desk.page.until(f"{off} > 1 && {figure}", "the figure farther away")
    desk.click('[data-id="place"] [data-value="miniature"]')


def test_who_is_inside_walks_along_and_a_step_of_ones_own_leaves_the_tour(desk):
    eye = "walk.view.eye.toArray()"
    off = "(([x, y], [a, , b]) => Math.hypot(x - a, -y - b))(walk.stage.player.position, walk.view.eye.toArray())"
    desk.look("walk")
    assert desk.page.js("return desk.state.settings.playbackPlace") == "miniature"
    desk.page.js("walk.client.actions.seek(1)")
    desk.page.js("await walk.client.actions.play()")
    begin = desk.page.js(f"return {eye}")
    desk.page.until(f"walk.view.eye.distanceTo({{x: {begin[0]}, y: {begin[1]}, z: {begin[2]}}}) > 0.3", "movement")
    desk.page.until(f"{off} < 0.05", "the eye on the tour")
    desk.page.js("""
      const press = (kind) => new KeyboardEvent(kind, { code: "KeyS", key: "s", bubbles: true });
      walk.view.renderer.domElement.dispatchEvent(press("keydown"));
      for (let i = 0; i < 5; i++) await new Promise(requestAnimationFrame);
      walk.view.renderer.domElement.dispatchEvent(press("keyup"));
    """)
    desk.page.until(f"desk.state.playback.playing && {off} > 0.5", "the tour to go on without one")
    assert not desk.page.js("return walk.stage.riding")
    desk.page.js("await walk.client.actions.stop()")
    desk.look("orbit")


def test_every_control_has_a_name_and_can_be_reached_by_keys(desk):
    for tab in ("tour", "view", "tune", "walk", "study"):
        desk.open(tab)
        unnamed = desk.page.js("""
          const label = (one) => one.getAttribute("aria-label") || one.labels?.[0]?.textContent;
          const named = (one) => (label(one) || one.textContent).trim();
          const controls = [...document.querySelectorAll(".desktop button, .desktop input")];
          return controls.filter((one) => one.offsetParent && !named(one)).map((one) => one.outerHTML);
        """)
        assert unnamed == []
    assert desk.page.js("return document.querySelector('#view').tabIndex") == 0


def test_the_page_says_nothing_wrong_on_its_console(desk):
    # A browser reports by itself the 503 of a building that is still loading, and the 409 of a map that two newer ones
    # have followed between its description and its bytes; the page waits for the one and skips the other.
    expected = ("status of 503", "status of 409")
    assert [said for said in desk.page.said() if not any(status in said for status in expected)] == []
