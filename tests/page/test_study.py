# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A whole user study by mouse: what the planner's graph hears of it gives the scores that the page shows."""

import json

import pytest
from page.desk import SIZE, Desk

from walk_vr_bridge.study import scores_from_events

pytestmark = pytest.mark.ros

MODE = "desk.state.parameters.find(({ name }) => name === 'trajopt.mode').value"


@pytest.fixture
def desk(browser, graph):
    page = browser.open(graph.url, headset=False, width=SIZE[0], height=SIZE[1])
    yield Desk(page)
    page.close()


def answer(desk, scale, index):
    desk.page.until(f"document.querySelector('[data-id=\"{scale}\"]')", scale)
    desk.click(f'[data-id="{scale}"] .marks button:nth-child({index + 1})')
    desk.press("next")


def test_a_study_is_told_to_the_graph_and_scores_as_the_instruments_prescribe(desk):
    desk.page.js("""
      window.heard = [];
      const socket = new WebSocket(`ws://${location.host}/ws?client=listenerlistener01`);
      await new Promise((done) => (socket.onopen = done));
      socket.onmessage = ({ data }) => {
        const said = JSON.parse(data);
        if (said.topic === "/walk/study_events") heard.push(said.msg);
      };
      socket.send(JSON.stringify({ op: "subscribe", topic: "/walk/study_events", queue_length: 200 }));
    """)
    desk.open("study")
    desk.press("begin")
    for condition in ("catmull_rom", "optimised"):
        desk.page.until(f"{MODE} === '{condition}'", condition)
        for _ in range(3):
            desk.press("task-begin")
            desk.press("task-done")
        for item in range(10):
            answer(desk, f"sus:{item}", 3)
        for scale in ("mental", "physical", "temporal", "performance", "effort", "frustration"):
            answer(desk, f"tlx:{scale}", 8)
        for _ in range(15):
            desk.click('[data-id^="pair-"]')
            desk.press("next")
    desk.page.until("heard.at(-1)?.status[0].name === 'end'", "the end of the study")
    shown = desk.page.js("return walk.desktop.study.run.scores")
    events = json.loads(desk.page.js("return JSON.stringify(heard)"))
    told = scores_from_events(
        (event["status"][0]["name"], {pair["key"]: pair["value"] for pair in event["status"][0]["values"]})
        for event in events
    )
    assert [score.condition for score in told] == ["optimiser_off", "optimiser_on"]
    for mine, theirs in zip(told, shown, strict=True):
        assert mine.sus == theirs["sus"] == 50.0
        assert mine.raw_tlx == pytest.approx(theirs["rawTlx"]) == 40.0
        assert mine.weighted_tlx == pytest.approx(theirs["weightedTlx"]) == 40.0
        assert list(mine.task_s) == pytest.approx(theirs["taskS"], abs=1e-3)


@pytest.mark.parametrize("before", ["optimised", "b_spline"])
def test_a_study_that_is_broken_off_leaves_the_optimiser_as_it_was(desk, before):
    set_mode = """
      const mode = desk.state.parameters.find(({ name }) => name === "trajopt.mode");
      return walk.client.actions.setParameter(mode, MODE);
    """
    assert desk.page.js(set_mode.replace("MODE", repr(before)))
    desk.open("study")
    desk.press("begin")
    desk.page.until(f"{MODE} === 'catmull_rom'", "the first condition")
    desk.press("break-off")
    desk.page.until(f"{MODE} === '{before}'", "the mode before")
    asked = 'await walk.client.ask("trajopt/get_parameters", { names: ["trajopt.mode"] })'
    desk.page.until(f"({asked}).values[0].string_value === '{before}'", "the planner's own mode")
    assert desk.page.js("return document.querySelectorAll('[data-id=\"not-set-back\"]').length") == 0
    desk.page.js(set_mode.replace("MODE", "'optimised'"))
