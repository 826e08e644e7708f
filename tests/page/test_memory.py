# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A frame keeps nothing: the heap after a collection is the same before and after many of them.

WALK_FRAMES says over how many; 10000 is the full run, by hand and for releases.
"""

import os

import pytest

pytestmark = pytest.mark.ros

FRAMES = int(os.environ.get("WALK_FRAMES", "4000"))
WINDOWS = 16
ROUNDS = 3
MOST_GROWTH = 100_000
"""Bytes: ten a frame in the full run, less than the smallest object that a frame could keep takes with its place."""

# Frames come as fast as they are drawn instead of sixty times a second; what they do is the same.
HURRY = """
  const { port1, port2 } = new MessageChannel();
  let due = [];
  port1.onmessage = () => {
    const now = due;
    due = [];
    for (const run of now) run(performance.now());
  };
  window.requestAnimationFrame = (run) => {
    if (due.push(run) === 1) port2.postMessage(null);
    return 1;
  };
"""


@pytest.fixture(scope="module")
def hurried(browser, graph):
    """A page in the headset whose frames are small and follow each other at once."""
    page = browser.open(graph.url, width=64, height=40)
    page.js("await hands.until(() => window.walk, 'the page'); await hands.enter();")
    page.js(HURRY)
    # What is compiled, and what grows to its size, does so first.
    page.js("await hands.frames(4000)")
    yield page
    page.close()


def heap(page):
    """What is left after a collection [bytes]."""
    page.devtools("HeapProfiler.collectGarbage")
    return page.devtools("Runtime.getHeapUsage")["usedSize"]


def growth(page, frames):
    """How much more is left after the last frames than after the first ones [bytes].

    What has not been collected yet only adds to a reading, so the least of six counts on either side. What is compiled
    late, on a busy machine, is kept once; what every frame keeps is kept again: of up to three rounds the least counts.
    """
    least = float("inf")
    for _ in range(ROUNDS):
        readings = [heap(page)]
        for _ in range(WINDOWS):
            page.js(f"await hands.frames({frames // WINDOWS})")
            readings.append(heap(page))
        least = min(least, min(readings[-6:]) - min(readings[:6]))
        if least < MOST_GROWTH:
            break
    return least


def test_the_heap_is_flat_over_many_frames(hurried):
    assert growth(hurried, FRAMES) < MOST_GROWTH


def test_the_heap_is_flat_while_the_tour_plays(hurried):
    # So slowly that it does not end, however busy the machine is.
    hurried.js("walk.client.actions.speed(0.01); await walk.client.actions.play();")
    hurried.until("walk.stage.inMiniature.walker.visible", "the figure")
    # What plays for the first time is compiled first.
    hurried.js("await hands.frames(1500)")
    grown = growth(hurried, FRAMES // 3)
    assert hurried.js("return walk.client.store.state.playback.playing")
    assert grown < MOST_GROWTH


def test_an_object_kept_by_every_frame_would_be_seen(hurried):
    hurried.js("window.kept = []; walk.view.onFrame((seconds) => window.kept.push(new Array(16).fill(seconds)));")
    assert growth(hurried, FRAMES // 2) > MOST_GROWTH
