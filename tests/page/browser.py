# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A Chromium that tests drive through a small Node program, and the planner's graph with its bridge."""

import json
import re
import shutil
import subprocess
import time
from pathlib import Path

from graph.processes import LIMIT_S, Graph

from walk_bringup.check.browser import find_browser

ROOT = Path(__file__).resolve().parents[2]
WEB = ROOT / "src" / "walk_vr_bridge" / "web"
STATIC = ROOT / "src" / "walk_vr_bridge" / "walk_vr_bridge" / "static"
DRIVER = Path(__file__).with_name("driver.mjs")
HEADSET = Path(__file__).with_name("headset.js")
IWER = WEB / "node_modules" / "iwer" / "build" / "iwer.min.js"
WIDTH, HEIGHT = 320, 200
FLAGS = (
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--js-flags=--expose-gc",
    "--enable-precise-memory-info",
)
"""Graphics in software, nothing in the background."""


def find_tools():
    """Returns the paths of Node and Chromium, None for what is not there."""
    return shutil.which("node"), find_browser()


class Browser:
    """Pages of one Chromium."""

    def __init__(self, node, chromium):
        self._process = subprocess.Popen(
            [node, str(DRIVER), str(WEB), chromium, *FLAGS], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def ask(self, **request):
        self._process.stdin.write(json.dumps(request) + "\n")
        self._process.stdin.flush()
        line = self._process.stdout.readline()
        assert line, "the browser has ended"
        answer = json.loads(line)
        assert "error" not in answer, answer["error"]
        return answer["value"]

    def open(self, url, *, headset=True, width=WIDTH, height=HEIGHT, density=1):
        """Opens a tab; a headset's without smooth edges, unless it is for a picture, of a density of 2."""
        url = f"{url}/?plain" if headset and density == 1 else url
        opened = self.ask(op="open", url=url, headset=headset, width=width, height=height, density=density)
        return Page(self, opened)

    def close(self):
        self._process.stdin.close()
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait(10)
        self._process.stdout.close()


class Page:
    """One tab."""

    def __init__(self, browser, number):
        self._browser, self._number = browser, number

    def js(self, code):
        """Runs the body of an async function in the page; returns what it returns."""
        return self._browser.ask(op="js", page=self._number, code=code)

    def until(self, condition, what, limit_s=LIMIT_S):
        """Waits until an expression of the page is true; returns its value."""
        end = time.monotonic() + limit_s
        while not (value := self.js(f"return {condition}")):
            assert time.monotonic() < end, f"waited in vain for {what}; the page said {self.said()}"
            time.sleep(0.02)
        return value

    def shot(self, file):
        self._browser.ask(op="shot", page=self._number, file=str(file))

    def mouse(self, *steps):
        self._browser.ask(op="mouse", page=self._number, steps=steps)

    def key(self, key):
        self._browser.ask(op="key", page=self._number, key=key)

    def devtools(self, method, **params):
        """Sends a command of the Chrome DevTools Protocol; returns its answer."""
        return self._browser.ask(op="devtools", page=self._number, method=method, params=params)

    def said(self):
        """Errors that the page has put on its console."""
        return self._browser.ask(op="said", page=self._number)

    def close(self):
        self._browser.ask(op="close", page=self._number)


class BridgedGraph(Graph):
    """The planner's nodes with the bridge."""

    def start_all(self, *bridge):
        for name in ("trajopt", "sequencer", "importance"):
            self.start(name)
        self.start_bridge(*bridge)

    def start_bridge(self, *parameters, port=0):
        """Starts the bridge; `url` is then where it is."""
        told = len(self.log("bridge")) if (self.folder / "bridge.log").exists() else 0
        given = [f"building:={self.building}", f"bridge.port:={port}", *parameters]
        self.run("bridge", "walk_vr_bridge.main", "--ros-args", *(part for p in given for part in ("-p", p)))
        end = time.monotonic() + LIMIT_S
        while not (found := re.search(r"http://\S+:\d+", self.log("bridge")[told:])):
            assert time.monotonic() < end, f"the bridge does not say where it is: {self.log('bridge')}"
            time.sleep(0.05)
        self.url = found.group().rstrip("/")
        self.port = int(self.url.rsplit(":", 1)[1])
