# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From a controller's release to the new path on the screen, the whole loop: browser, bridge, DDS, planner and back.

Prints JSON. `python tests/page/bench_release.py [RELEASES]` with the packages on the path, as for the tests.
"""

import json
import shutil
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from graph.rooms import make_rooms
from page.browser import BridgedGraph, Browser

GOAL_P50_MS, GOAL_P95_MS = 25.0, 60.0
DOMAIN = 101
WARM_UP = 2
"""Releases that are not counted: compiled code and caches come in."""

LIMIT_MS = 240_000
"""No release is begun after this long; what is counted is told."""

# The clock starts when the trigger lets go and stops when the frame with the new path has been handed to the graphics
# system. In between the emulator, like a real headset, tells the page of the trigger at the next frame.
RELEASES = """
  const { store } = walk.client;
  const id = store.state.keypoints[1].id;
  let fresh = 0;
  let drawn = null;
  let [sent, came] = [NaN, NaN];
  store.subscribe("path", () => {
    if (fresh !== 1 || Number.isNaN(sent)) return;
    fresh = 2;
    came = performance.now();
  });
  const { actions } = walk.client;
  const release = actions.release.bind(actions);
  actions.release = (...what) => {
    sent = performance.now();
    return release(...what);
  };
  const { renderer, scene } = walk.view;
  const render = renderer.render.bind(renderer);
  renderer.render = (...what) => {
    render(...what);
    if (fresh === 2) { renderer.getContext().finish(); fresh = 3; drawn(performance.now()); }
  };
  // Until no path has come for some frames, for 60 at most: a planner that never rests is told, not waited for.
  let restless = 0;
  const settle = async (frames) => {
    for (let still = 0, all = 0, last = ""; still < frames; still++) {
      if (store.state.path.revision !== last) { still = 0; last = store.state.path.revision; }
      if (++all > 60) { restless += 1; return; }
      await hands.frames(1);
    }
  };
  const quiet = async () => {
    await hands.until(() => store.state.connection.unconfirmed === 0, "the answer");
    await settle(12);
  };
  const times = [];
  const parts = [];
  const began = performance.now();
  let missed = 0;
  for (let round = 0; round < COUNT && performance.now() - began < LIMIT_MS; round++) {
    await quiet();
    const from = hands.shown(id);
    await hands.reach("right", from);
    await hands.button("right", "trigger", 1);
    const way = round % 2 ? -0.012 : 0.012;
    await hands.carry("right", from, [from[0] + way, from[1], from[2]], 5);
    await settle(6);
    // Not always at the same moment of a frame.
    await new Promise((done) => setTimeout(done, Math.random() * 17));
    const done = new Promise((resolve) => { drawn = resolve; });
    fresh = 1;
    sent = came = NaN;
    const start = performance.now();
    hands.device.controllers.right.updateButtonValue("trigger", 0);
    const late = new Promise((resolve) => setTimeout(() => resolve(NaN), 2000));
    const end = await Promise.race([done, late]);
    if (Number.isNaN(end)) missed += 1;
    else {
      times.push(end - start);
      parts.push([sent - start, came - sent, end - came]);
    }
    fresh = 0;
    await hands.frames(3);
  }
  const frameStart = performance.now();
  await hands.frames(60);
  const frameMs = (performance.now() - frameStart) / 60;
  actions.release = release;
  return { times, parts, missed, restless, frameMs, refused: store.state.refusals.length };
"""


def measure(count):
    """Returns the figures of `count` releases on the small made building."""
    browser = Browser(shutil.which("node"), shutil.which("chromium"))
    with tempfile.TemporaryDirectory() as folder:
        graph = BridgedGraph(DOMAIN, Path(folder), make_rooms(Path(folder) / "rooms.ply"))
        try:
            graph.start_all()
            page = browser.open(graph.url)
            page.js("await hands.until(() => window.walk, 'the page'); await hands.enter();")
            result = page.js(RELEASES.replace("COUNT", str(WARM_UP + count)).replace("LIMIT_MS", str(LIMIT_MS)))
        finally:
            graph.close()
            browser.close()
    waits, planner, drawing = np.median(result["parts"][WARM_UP:], axis=0)
    p50, p95 = np.percentile(result["times"][WARM_UP:], [50, 95])
    return {
        "releases": len(result["times"]) - WARM_UP,
        "refused": result["refused"],
        "missed": result["missed"],
        "restless": result["restless"],
        "frame_ms": round(result["frameMs"], 1),
        "release_to_path_p50_ms": round(float(p50), 1),
        "release_to_path_p95_ms": round(float(p95), 1),
        "p50_of_parts_ms": {
            "until_the_page_hears_of_the_trigger": round(float(waits), 1),
            "bridge_graph_and_back": round(float(planner), 1),
            "until_it_is_drawn": round(float(drawing), 1),
        },
        "p50_to_goal": round(float(p50) / GOAL_P50_MS, 2),
        "p95_to_goal": round(float(p95) / GOAL_P95_MS, 2),
    }


if __name__ == "__main__":
    print(json.dumps(measure(int(sys.argv[1]) if len(sys.argv) > 1 else 50), indent=2))
