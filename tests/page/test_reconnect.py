# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The bridge goes away and comes back: the page takes it up again and nothing is lost."""

import pytest
from page.browser import BridgedGraph

pytestmark = pytest.mark.ros


def test_what_is_released_without_a_connection_is_sent_when_it_is_back(browser, rooms, tmp_path, other_domain):
    graph = BridgedGraph(other_domain, tmp_path, rooms)
    try:
        graph.start_all()
        page = browser.open(graph.url)
        page.js("await hands.until(() => window.walk, 'the page'); await hands.enter();")
        # What the worker hears lies in memory that both threads see.
        assert page.js("return crossOriginIsolated")
        before = page.js("return walk.client.store.state.keypoints")
        graph.kill("bridge")
        page.until("walk.client.store.state.connection.phase !== 'connected'", "the loss of the connection")
        wished = page.js("""
          const id = walk.client.store.state.keypoints[1].id;
          const from = hands.shown(id);
          await hands.reach("right", from);
          await hands.button("right", "trigger", 1);
          await hands.carry("right", from, [from[0] + 0.02, from[1], from[2]]);
          await hands.button("right", "trigger", 0);
          return { id, at: hands.keypoint(id).position, unconfirmed: walk.client.store.state.connection.unconfirmed };
        """)
        assert wished["unconfirmed"] == 1
        graph.start_bridge(port=graph.port)
        page.until(
            "walk.client.store.state.connection.phase === 'connected' &&"
            " walk.client.store.state.connection.unconfirmed === 0",
            "the connection and the answer",
        )
        after = page.js(f"await hands.frames(3); return hands.keypoint({wished['id']})")
        assert page.js("return walk.client.store.state.refusals") == []
        assert after["position"][:2] == pytest.approx(wished["at"][:2], abs=0.05)
        assert not after["pending"]
        moved = next(one for one in before if one["id"] == wished["id"])
        assert after["position"][0] - moved["position"][0] > 0.2
        assert page.js("return walk.view.presenting")
        page.close()
    finally:
        graph.close()
