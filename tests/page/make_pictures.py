# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Takes the pictures of the page for the documentation, with the sample building, through the whole graph.

`python tests/page/make_pictures.py [FOLDER]` with the packages on the path, as for the tests; docs/images by default.
"""

import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from page.browser import ROOT, BridgedGraph, Browser, find_tools
from page.desk import Desk

from walk_bringup.sample import sample_path

DOMAIN = 100
DESKTOP, HEADSET = (1280, 800), (1200, 750)


def of_desktop(browser, graph, folder):
    """The model with its tour, and the plan of the lower storey."""
    page = browser.open(graph.url, headset=False, width=DESKTOP[0], height=DESKTOP[1], density=2)
    desk = Desk(page)
    page.js("walk.client.actions.showStorey(0); walk.client.actions.set({ pathColour: 'speed' })")
    for view, name in (("orbit", "desktop"), ("plan", "plan_view")):
        desk.look(view)
        page.js("await new Promise((done) => setTimeout(done, 1500))")
        page.shot(folder / f"{name}.png")
    page.close()


def of_headset(browser, graph, folder):
    """What one eye sees: the room, the miniature in front, the panel at the side."""
    page = browser.open(graph.url, width=HEADSET[0], height=HEADSET[1], density=2)
    page.js("""
      await hands.until(() => window.walk, "the page");
      hands.device.stereoEnabled = false;
      await hands.enter();
      await hands.frames(5);
      walk.room.bringToHand();
      walk.stage.miniature.clip.cutStorey(0);
      walk.stage.nameNote.hide();
      hands.head([-0.15, 1.62, 0.25]);
      hands.device.quaternion.set(Math.sin(-0.18), 0, 0, Math.cos(-0.18));
      hands.put("left", [-0.35, 1.05, -0.25], [-0.2, 1.0, -1]);
      hands.put("right", [0.3, 1.05, -0.2], [0.05, 0.9, -0.8]);
      await hands.frames(8);
      walk.stage.nameNote.hide();
      await hands.frames(2);
    """)
    page.shot(folder / "headset_room.png")
    page.close()


def main(folder):
    """Starts graph and browser and takes all pictures."""
    folder.mkdir(parents=True, exist_ok=True)
    browser = Browser(*find_tools())
    with tempfile.TemporaryDirectory() as state:
        graph = BridgedGraph(DOMAIN, Path(state), sample_path())
        try:
            graph.start_all()
            of_desktop(browser, graph, folder)
            of_headset(browser, graph, folder)
        finally:
            graph.close()
            browser.close()


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "images")
