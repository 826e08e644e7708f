# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A frame keeps nothing: the heap after a collection is the same before and after ten thousand of them."""

import itertools
import statistics

import pytest

pytestmark = pytest.mark.ros

FRAMES = 10_000
WINDOWS = 10
MOST_KEPT = 10.0
"""Bytes a frame; the smallest object that a frame could keep takes more, with its place in a list."""

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
    page.js("await hands.frames(3000)")
    yield page
    page.close()


def heap(page):
    """What is left after a collection, as the median of three: the engine's own stock comes and goes."""
    used = []
    for _ in range(3):
        page.devtools("HeapProfiler.collectGarbage")
        used.append(page.devtools("Runtime.getHeapUsage")["usedSize"])
        page.js("await hands.frames(20)")
    return statistics.median(used)


def kept_by(page, frames):
    """Bytes that a frame keeps: the median slope between any two of eleven readings of the heap.

    Code that is compiled on the way is a step, which hardly moves that; what each frame keeps is in every slope.
    """
    readings = [heap(page)]
    for _ in range(WINDOWS):
        page.js(f"await hands.frames({frames // WINDOWS})")
        readings.append(heap(page))
    pairs = itertools.combinations(range(len(readings)), 2)
    return statistics.median((readings[j] - readings[i]) / (j - i) for i, j in pairs) / (frames / WINDOWS)


def test_the_heap_is_flat_over_ten_thousand_frames(hurried):
    assert kept_by(hurried, FRAMES) < MOST_KEPT


def test_the_heap_is_flat_while_the_tour_plays(hurried):
    # Slowly, so that it does not end.
    hurried.js("walk.client.actions.speed(0.1); await walk.client.actions.play();")
    hurried.until("walk.stage.inMiniature.walker.visible", "the figure")
    hurried.js("await hands.frames(1000)")
    kept = kept_by(hurried, 3 * FRAMES // 10)
    assert hurried.js("return walk.client.store.state.playback.playing")
    assert kept < 2 * MOST_KEPT


def test_an_object_kept_by_every_frame_would_be_seen(hurried):
    hurried.js("window.kept = []; walk.view.onFrame((seconds) => window.kept.push({ seconds }));")
    assert kept_by(hurried, FRAMES // 5) > 2 * MOST_KEPT
