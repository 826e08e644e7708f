# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The page in a real browser with an emulated headset, before the real bridge, DDS and planner nodes."""

import pytest
from graph.domains import own_domain
from graph.rooms import make_rooms
from page.browser import STATIC, WEB, BridgedGraph, Browser, find_tools


@pytest.fixture(scope="session")
def browser():
    node, chromium = find_tools()
    if chromium is None:
        pytest.skip("there is no chromium; Debian's package of that name serves")
    if node is None:
        pytest.skip("there is no node to drive the browser")
    if not (WEB / "node_modules" / "playwright-core").is_dir():
        pytest.skip("the page's tools are not installed; `npm ci` in src/walk_vr_bridge/web does that")
    if not (STATIC / "index.html").is_file():
        pytest.skip("the page is not built; `npm run build` in src/walk_vr_bridge/web does that")
    browser = Browser(node, chromium)
    yield browser
    browser.close()


@pytest.fixture(scope="session")
def rooms(tmp_path_factory):
    return make_rooms(tmp_path_factory.mktemp("building") / "rooms.ply")


@pytest.fixture
def other_domain():
    with own_domain() as domain:
        yield domain


@pytest.fixture(scope="module")
def graph(browser, rooms, tmp_path_factory):
    with own_domain() as domain:
        graph = BridgedGraph(domain, tmp_path_factory.mktemp("graph"), rooms)
        try:
            graph.start_all()
            yield graph
        finally:
            graph.close()


@pytest.fixture(scope="module")
def headset(browser, graph):
    """A page in the headset that has building, keypoints and path."""
    page = browser.open(graph.url)
    page.js("await hands.until(() => window.walk, 'the page'); await hands.enter();")
    yield page
    page.close()
