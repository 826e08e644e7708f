# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The page as a user at a desk has it: a mouse, a keyboard, and what stands on the screen."""

import json

SIZE = (1100, 720)

_SETUP = """
  window.desk = {
    state: walk.client.store.state,
    keypoint: (id) => desk.state.keypoints.find((one) => one.id === id),
    onScreen: (position) => {
      const at = walk.view.eye.clone();
      walk.stage.overlayInView().place.shown(position, at);
      at.project(walk.desktop.camera);
      const { clientWidth, clientHeight } = walk.view.renderer.domElement;
      return [((at.x + 1) / 2) * clientWidth, ((1 - at.y) / 2) * clientHeight];
    },
    middle: (selector) => {
      const found = document.querySelector(selector);
      if (!found) throw new Error(`nothing is ${selector}`);
      found.scrollIntoView({ block: "nearest" });
      const box = found.getBoundingClientRect();
      return [box.x + box.width / 2, box.y + box.height / 2];
    },
  };
"""


class Desk:
    """One tab with mouse and keyboard."""

    def __init__(self, page):
        self.page = page
        page.until("window.walk?.stage.models && walk.client.store.state.path.count > 0", "building and path")
        page.js(_SETUP)
        told = "desk.state.parameters.some(({ node }) => node === 'trajopt')"
        page.until(f"{told} && desk.state.session.role === 'editor'", "the parameters")

    def look(self, view):
        """Looks another way by the button, and waits until the camera stands still."""
        self.click(f'.segments [data-view="{view}"]')
        self.page.until(f"walk.desktop.viewName === '{view}'", view)
        self.settle()

    def settle(self):
        self.page.js("""
          let last = "";
          for (let i = 0; i < 200; i++) {
            await new Promise(requestAnimationFrame);
            const now = walk.desktop.camera.matrixWorld.elements.map((x) => x.toFixed(4)).join();
            if (now === last) return;
            last = now;
          }
        """)

    def open(self, tab):
        self.click(f'[data-tab="{tab}"]')

    def click(self, selector):
        """Clicks what is on the page, once it is there."""
        self.page.until(f"document.querySelector({json.dumps(selector)})", selector)
        x, y = self.page.js(f"return desk.middle({json.dumps(selector)})")
        self.page.mouse(["click", x, y])

    def press(self, widget):
        """Clicks a widget of the panel."""
        self.click(f'.panel [data-id="{widget}"]')

    def ids(self):
        return self.page.js("return desk.state.keypoints.map(({ id }) => id)")

    def position(self, identity):
        return self.page.js(f"return desk.keypoint({identity}).position")

    def on_screen(self, identity):
        return self.page.js(f"return desk.onScreen(desk.keypoint({identity}).position)")

    def drag(self, identity, dx, dy, steps=6):
        """Takes hold of a keypoint and moves it by so many pixels; it is still held afterwards."""
        x, y = self.on_screen(identity)
        moves = [["move", x + dx * k / steps, y + dy * k / steps] for k in range(1, steps + 1)]
        self.page.mouse(["move", x, y], ["down"], *moves)

    def drop(self):
        self.page.mouse(["up"])
        self.quiet()

    def quiet(self):
        """Waits until every edit has been answered and is shown."""
        self.page.until(
            "desk.state.connection.unconfirmed === 0 && desk.state.keypoints.every(({ pending }) => !pending)",
            "answers",
        )

    def revision(self):
        return self.page.js("return desk.state.path.revision")

    def path_follows(self, revision):
        self.page.until(f"desk.state.path.count > 0 && desk.state.path.revision !== {revision!r}", "another path")
