# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk bench release`: from a controller's release to the new path on the screen, hop by hop, as JSON.

Browser, bridge, DDS, planner and back, on the small made building. Needs Chromium, and the page built for the tests.
"""

import argparse
import contextlib
import json
import re
import sys
import tempfile
import threading
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from graph.domains import own_domain
from graph.processes import Observer
from graph.rooms import make_rooms
from page.browser import BridgedGraph
from page.devtools import DevTools

from walk_bringup.check.browser import find_browser
from walk_ros.conversions import EditKind, edit_from_msg

GOAL_P50_MS, GOAL_P95_MS = 25.0, 60.0
WARM_UP = 3
"""Releases that are not counted: compiled code and caches come in."""

REFINED_MS = 400.0
"""A path that is drawn later than this after a release is not taken for that release, solved in full."""

LIMIT_S = 150.0
"""No release is begun after this long; how many were counted is told."""

# The clock starts when the trigger lets go and stops when the frame that shows the path of that edit, or a later path,
# has been drawn: a pixel of it can be read. In between the emulator, like a real headset, tells the page of the trigger
# at the next frame. All stamps are of the one clock of this machine [ms since 1970].
RELEASES = """
  const hz = hands.pace(HZ);
  await hands.frames(hz / 2);
  const { client } = walk;
  const { store, actions } = client;
  const id = store.state.keypoints[1].id;
  const now = () => performance.timeOrigin + performance.now();
  const came = {}, drawn = [], answers = {};
  store.subscribe("path", () => (came[store.state.path.revision] ??= now()));
  const told = { type: "diagnostic_msgs/DiagnosticStatus" };
  client.wire.subscribe("/walk/path_results", told, ({ values }) => {
    const answer = Object.fromEntries(values.map(({ key, value }) => [key, value]));
    answers[answer.edit_stamp_ns] = answer;
  });
  const { renderer } = walk.view;
  const gl = renderer.getContext();
  const pixel = new Uint8Array(4);
  const render = renderer.render.bind(renderer);
  let shown = "";
  const frames = [];
  renderer.render = (...what) => {
    frames.push(performance.now());
    render(...what);
    const { revision } = store.state.path;
    if (revision === shown) return;
    shown = revision;
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    drawn.push([revision, now()]);
  };
  let row = {};
  const release = actions.release.bind(actions);
  actions.release = (...what) => {
    row.sent = now();
    const confirmed = release(...what);
    confirmed.then(({ label }) => Object.assign(row, { label, answered: now() }));
    return confirmed;
  };
  const rest = (ms) => new Promise((done) => setTimeout(done, ms));
  const rows = [];
  const began = performance.now();
  for (let round = 0; round < COUNT && performance.now() - began < LIMIT_MS; round++) {
    await hands.answered();
    await rest(300);
    const from = hands.shown(id);
    await hands.reach("right", from);
    await hands.button("right", "trigger", 1);
    const way = round % 2 ? -0.012 : 0.012;
    await hands.carry("right", from, [from[0] + way, from[1], from[2]], 5);
    // Not always at the same moment of a frame.
    await rest(120 + 17 * Math.random());
    row = { start: now() };
    hands.device.controllers.right.updateButtonValue("trigger", 0);
    const one = row;
    await hands.until(() => one.answered, "the answer");
    await rest(200);
    rows.push({ ...one, paths: Object.values(came).filter((at) => at > one.start + 300).length });
  }
  frames.length = 0;
  await hands.frames(hz);
  const [left, top] = [new Uint8Array(4), new Uint8Array(4)];
  renderer.render = (...what) => {
    render(...what);
    // One spot of floor, one above the horizon: what is drawn must not be blank.
    gl.readPixels(80, 20, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, left);
    gl.readPixels(80, 190, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, top);
  };
  await hands.frames(2);
  if (!left[3] || left.join() === top.join()) throw new Error("nothing is drawn");
  return { rows, came, drawn, answers, hz, frames };
"""


class Listener(Observer):
    """Hears in a thread of its own when the bridge let each release go on."""

    def __init__(self, domain):
        super().__init__(domain, topics=("keypoint_edits",))
        threading.Thread(target=self.executor.spin, daemon=True).start()

    def releases_ms(self):
        edits = [edit_from_msg(msg) for msg in self.heard["keypoint_edits"]]
        return [edit.stamp_ns / 1e6 for edit in edits if edit.kind is EditKind.RELEASE]


def measure(count, hz):
    """Returns what page and listener have seen of `count` releases at `hz` frames a second, None: the headset's own."""
    names = {"HZ": hz or "undefined", "COUNT": count, "LIMIT_MS": 1000 * LIMIT_S}
    script = re.sub("|".join(names), lambda name: str(names[name.group()]), RELEASES)
    with tempfile.TemporaryDirectory() as folder, own_domain() as domain, contextlib.ExitStack() as ends:
        graph = BridgedGraph(domain, Path(folder), make_rooms(Path(folder) / "rooms.ply"))
        listener = Listener(domain)
        ends.callback(listener.close)
        ends.callback(graph.close)
        graph.start_all()
        page = DevTools(find_browser(), graph.url)
        ends.callback(page.close)
        page.js("await hands.until(() => window.walk, 'the page'); await hands.enter();")
        seen = page.js(script)
        seen["passed_on"] = listener.releases_ms()
    return seen


def hops(seen):
    """Returns the times of each release whose path came [ms], (releases, 8).

    Five hops, the whole, the confirmation, and the whole way to the next path, which is solved in full; nan for none.
    """
    rows = []
    for row, passed_on in zip(seen["rows"], seen["passed_on"], strict=True):
        answer = seen["answers"].get(str(row["label"]), {})
        revision = answer.get("revision_ns", "")
        came = seen["came"].get(revision)
        drawn = next((at for shown, at in seen["drawn"] if shown >= revision), None)
        if answer.get("outcome") != "followed" or came is None or drawn is None:
            continue
        at = [row["start"], row["sent"], passed_on, int(revision) / 1e6, came, max(drawn, came)]
        later = next((at for shown, at in seen["drawn"] if shown > revision), np.inf)
        refined = later - at[0] if later < at[0] + REFINED_MS else np.nan
        rows.append([*np.diff(at), at[-1] - at[0], row["answered"] - row["start"], refined])
    return np.array(rows)


def report(seen):
    """Returns the figures."""
    names = ("until_the_page_hears_of_the_trigger", "page_to_bridge", "bridge_to_path", "path_to_page", "path_to_frame")
    rows = hops(seen)[WARM_UP:]
    p50, p95 = np.nanpercentile(rows, [50, 95], axis=0)
    gap50, gap95 = np.percentile(np.diff(seen["frames"]), [50, 95])
    return {
        "releases": len(rows),
        "without_a_path": len(seen["rows"]) - WARM_UP - len(rows),
        "frames": {"hz": seen["hz"], "p50_ms": round(gap50, 1), "p95_ms": round(gap95, 1)},
        "release_to_drawn": {"p50_ms": round(p50[5], 1), "p95_ms": round(p95[5], 1)},
        "to_goal": {"p50": round(p50[5] / GOAL_P50_MS, 2), "p95": round(p95[5] / GOAL_P95_MS, 2)},
        "hops": {
            name: {"p50_ms": round(p50[k], 1), "p95_ms": round(p95[k], 1)} for k, name in enumerate(names)
        },
        "release_to_refined": {"p50_ms": round(p50[7], 1), "p95_ms": round(p95[7], 1)},
        "release_to_confirmed": {"p50_ms": round(p50[6], 1), "p95_ms": round(p95[6], 1)},
        "releases_with_a_path_later_than_300_ms": sum(row["paths"] > 0 for row in seen["rows"][WARM_UP:]),
    }  # fmt: skip


def frame_rate(text):
    """Reads the frames a second of a display."""
    if not (text.isdecimal() and 30 <= int(text) <= 240):
        raise argparse.ArgumentTypeError(f"{text!r} is no whole number from 30 to 240")
    return int(text)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="./walk bench release", description=__doc__.splitlines()[0])
    parser.add_argument("--releases", type=int, default=50, help="that are counted (default: %(default)s)")
    rates = "frames a second of the display, 30 to 240 (default: the headset's own)"
    parser.add_argument("--hz", type=frame_rate, help=rates)
    args = parser.parse_args()
    if find_browser() is None:
        parser.error("there is no Chromium: install it first (Debian: sudo apt install chromium)")
    print(json.dumps(report(measure(WARM_UP + args.releases, args.hz)), indent=2))
