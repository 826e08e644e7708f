# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a headset can bear: draw calls and triangles of every building, size of the scripts."""

import gzip

import pytest
from page.browser import STATIC, BridgedGraph

pytestmark = pytest.mark.ros

MOST_CALLS, MOST_TRIANGLES, MOST_SCRIPT = 120, 600_000, 250_000
BUILDINGS = ("duplex.ifc", "large_building.ifc", "willowgarage.dae", "parking_garage.dae", "small_house.ply")
KEYPOINTS = 100


@pytest.mark.parametrize("name", BUILDINGS)
def test_calls_and_triangles_of_both_eyes(browser, buildings_dir, tmp_path, other_domain, name):
    graph = BridgedGraph(other_domain, tmp_path, buildings_dir / name)
    try:
        graph.start_bridge()
        page = browser.open(graph.url)
        page.js("await hands.until(() => window.walk?.stage.models, 'the building', 120000)")
        # Only the bridge runs: as many keypoints and as long a path as there ever are, around the user; maps laid.
        worst = page.js(f"""
          const {{ store, actions }} = walk.client;
          const [x, y, z] = store.state.building.start;
          const around = (_, i) => [x + Math.cos(i) * 2, y + Math.sin(i) * 2, z + 1.6];
          hands.invent(Array.from({{ length: {KEYPOINTS} }}, around));
          const path = store.state.path;
          const rows = 3000;
          path.count = rows;
          const along = (_, i) => [x + Math.floor(i / 3) / 1000, y, z + 1.6][i % 3];
          path.positions = Float32Array.from({{ length: 3 * rows }}, along);
          const rest = ["quats", "timeS", "speedMps", "heightM", "clearanceM"];
          for (const field of rest) path[field] = new Float32Array(4 * rows);
          store.touch("path");
          const names = ["obstacle", "distance", "visibility", "importance"];
          const channels = names.map((name) => ({{ name, low: 0, high: 1 }}));
          const data = new Uint8Array(4 * 8 ** 3).fill(100);
          const {{ min, max, storeys }} = store.state.building;
          const voxelM = Math.max(...max.map((value, axis) => value - min[axis])) / 8;
          store.set("importance", {{ origin: min, voxelM, shape: [8, 8, 8], channels, data, revision: "1" }});
          await walk.xr.enter();
          await hands.until(() => walk.view.presenting && walk.view.frames > 3, "the session");
          hands.head([0, 1.6, 0]);
          await hands.frames(2);
          walk.room.bringToHand();
          let [calls, triangles] = [0, 0];
          const looks = [["building", "none", -1], ["transparent", "none", -1]];
          for (const map of ["none", "importance", "obstacle"]) looks.push(["building", map, storeys.length - 1]);
          for (const [surface, map, storey] of looks) for (let quarter = 0; quarter < 4; quarter++) {{
            actions.set({{ surface, map }});
            actions.showStorey(storey);
            hands.head([0, 1.6, 0], quarter * Math.PI / 2);
            await hands.frames(2);
            const {{ render }} = walk.view.renderer.info;
            calls = Math.max(calls, render.calls);
            triangles = Math.max(triangles, render.triangles);
          }}
          return {{ calls, triangles, views: walk.view.renderer.xr.getCamera().cameras.length }};
        """)
        page.close()
    finally:
        graph.close()
    print(f"{name}: {worst['calls']} calls, {worst['triangles']:,} triangles")
    assert worst["views"] == 2
    assert 20 < worst["calls"] <= MOST_CALLS
    assert 10_000 < worst["triangles"] <= MOST_TRIANGLES


def test_scripts_are_small(browser):
    scripts = list(STATIC.rglob("*.js"))
    assert scripts
    assert sum(len(gzip.compress(script.read_bytes(), 6)) for script in scripts) <= MOST_SCRIPT


def test_page_fetches_nothing_from_elsewhere(headset, graph):
    addresses = headset.js("return performance.getEntriesByType('resource').map((one) => one.name)")
    assert addresses
    assert [
        address for address in addresses if not address.startswith((graph.url, graph.url.replace("http", "ws")))
    ] == []
