# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What is shown of a building with several storeys: cuts, caps, and keypoints dimmed through floors."""

import pytest
from page.browser import ROOT, BridgedGraph

pytestmark = pytest.mark.ros

SAMPLE = ROOT / "src" / "walk_bringup" / "buildings" / "sample.ifc"


@pytest.fixture(scope="module")
def page(browser, tmp_path_factory):
    """The sample building with a keypoint in each room; only the bridge runs."""
    graph = BridgedGraph(231, tmp_path_factory.mktemp("storeys"), SAMPLE)
    try:
        graph.start_bridge()
        page = browser.open(graph.url)
        page.js("""
          await hands.until(() => window.walk?.stage.models, "the building", 120000);
          const { store } = walk.client;
          hands.invent(store.state.building.rooms.map(({ centre: [x, y, z] }) => [x, y, z + 1.6]));
          await walk.xr.enter();
          await hands.until(() => walk.view.presenting && walk.view.frames > 5, "the session");
          hands.head([0, 1.6, 0]);
          await hands.frames(3);
          walk.room.bringToHand();
          await hands.frames(2);
        """)
        yield page
        page.close()
    finally:
        graph.close()


def counts(page, setup):
    return page.js(f"""
      {{ {setup} }}
      await hands.frames(3);
      const {{ rooms }} = walk.client.store.state.building;
      return {{ mini: walk.stage.inMiniature.pins.counts, full: walk.stage.inFull.pins.counts,
        rooms: [0, 1].map((storey) => rooms.filter((room) => room.storey === storey).length),
        underCut: rooms.filter((room) => room.centre[2] < 1.4).length }};
    """)


def test_keypoints_of_lower_storeys_are_dimmed_through_the_floor(page):
    above = counts(page, "walk.client.actions.showStorey(1)")
    lower, upper = above["rooms"]
    assert lower > 0 and upper > 0
    assert above["mini"] == {"plain": upper, "dimmed": lower}
    # What stands over the cut is taken away with its storey, and so is the upper half of the ramp.
    below = counts(page, "walk.client.actions.showStorey(0)")
    assert lower - 1 <= below["underCut"] <= lower
    assert below["mini"] == {"plain": below["underCut"], "dimmed": 0}


def test_whoever_stands_upstairs_sees_the_lower_storey_dimmed(page):
    below = counts(
        page, "const s = walk.client.store.state.building.start; walk.room.travel.goTo(s[0], s[1], 0, false)"
    )
    above = counts(
        page,
        "const { rooms, storeys } = walk.client.store.state.building;"
        "const at = rooms.find((room) => room.storey === 1).centre;"
        "walk.room.travel.goTo(at[0], at[1], storeys[1].floorZ, false)",
    )
    lower, upper = above["rooms"]
    assert below["full"] == {"plain": lower + upper, "dimmed": 0}
    assert above["full"] == {"plain": upper, "dimmed": lower}


def test_the_cut_changes_the_miniature_and_never_the_building_around(page):
    planes = page.js("""
      walk.client.actions.showStorey(0);
      await hands.frames(3);
      const of = (copy) => copy.group.children.map((child) => child.material.clippingPlanes?.length ?? 0);
      const { miniature, full } = walk.stage;
      return { mini: of(miniature.copy), full: of(full), renderer: walk.view.renderer.clippingPlanes.length };
    """)
    assert set(planes["mini"]) == {1}
    assert set(planes["full"]) == {0}
    assert planes["renderer"] == 0


# The miniature from straight above, cut along a storey: its pixels, and where a place of the map is among them.
FROM_ABOVE = """
  const { view, stage } = walk;
  const gl = view.renderer.getContext();
  const fromAbove = async (storey) => {
    walk.client.actions.showStorey(storey);
    await hands.frames(3);
    const camera = new view.camera.constructor(40, gl.drawingBufferWidth / gl.drawingBufferHeight, 0.01, 10);
    const at = stage.inMiniature.place.toRoom(stage.bounds.getCenter(view.eye.clone()), view.eye.clone());
    camera.position.copy(at).y += 0.9;
    camera.up.set(0, 0, -1);
    camera.lookAt(at);
    camera.updateMatrixWorld();
    const { xr } = view.renderer;
    xr.enabled = false;
    const target = view.renderer.getRenderTarget();
    view.renderer.setRenderTarget(null);
    view.renderer.render(view.scene, camera);
    const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
    const pixels = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    view.renderer.setRenderTarget(target);
    xr.enabled = true;
    const pixelOf = (map) => {
      const seen = stage.inMiniature.place.toRoom(view.eye.clone().fromArray(map), view.eye.clone()).project(camera);
      const column = Math.floor(((seen.x + 1) / 2) * width), row = Math.floor(((seen.y + 1) / 2) * height);
      return Array.from(pixels.subarray(4 * (row * width + column), 4 * (row * width + column) + 3));
    };
    return { width, height, pixels, pixelOf };
  };
"""
CAP = (57, 66, 77)


def test_walls_are_filled_where_they_are_cut(page):
    # A cut building shows caps: areas of their colour, of which there are none without the cut.
    shares = page.js(f"""
      {FROM_ABOVE}
      const share = async (storey) => {{
        const {{ width, height, pixels }} = await fromAbove(storey);
        const like = (at) => {list(CAP)}.every((value, channel) => Math.abs(pixels[at + channel] - value) < 4);
        // Areas, not the single pixels that shine through where two faces meet.
        const within = (at) => [0, -4, 4, -4 * width, 4 * width].every((step) => like(at + step));
        let caps = 0;
        for (let i = 4 * width; i < pixels.length - 4 * width; i += 4) if (within(i)) caps += 1;
        return caps / (width * height);
      }};
      return [await share(-1), await share(0)];
    """)
    assert shares[1] > 0.002
    assert shares[1] > 10 * shares[0]


def test_a_wall_that_stands_on_another_is_filled_too(page):
    # The bottom of the upper one, all that one sees of its cut from above, lies in one plane with the top of the lower.
    corners = [(0.15, 0.15), (23.85, 0.15), (0.15, 15.85), (23.85, 15.85)]
    colours = page.js(f"""
      {FROM_ABOVE}
      const {{ pixelOf }} = await fromAbove(1);
      return {[list(corner) for corner in corners]}.map(([x, y]) => pixelOf([x, y, 4.6]));
    """)
    for colour in colours:
        assert max(abs(a - b) for a, b in zip(colour, CAP, strict=True)) < 4
