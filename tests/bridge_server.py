# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A web server of the bridge on a free port of loopback, with a graph that only remembers what it was told."""

import asyncio
import contextlib
import time

import aiohttp
import orjson
from std_msgs.msg import String

from walk_ros.raw import to_bytes
from walk_vr_bridge.allowed import Allowed
from walk_vr_bridge.config import BridgeConfig
from walk_vr_bridge.files import Files
from walk_vr_bridge.server import WebServer
from walk_vr_bridge.site import Site, open_door
from walk_vr_bridge.wire.message import Message


class FakeGraph:
    """Remembers what is published; answers services with their default response."""

    def __init__(self):
        self.published = []
        self.called = []
        self.silent = False
        self.heard = True

    def is_heard(self, topic):
        return self.heard

    def publish(self, topic, msg):
        self.published.append((topic, msg))

    def call(self, service, cls, request, done):
        self.called.append((service, request))
        if not self.silent:
            asyncio.get_running_loop().call_soon(done, cls.Response(), "")

    def now_ns(self):
        return time.time_ns()

    def on(self, topic):
        return [msg for name, msg in self.published if name == topic]


class Served:
    def __init__(self, site, door, graph, files, shown, port, session):
        self.site, self.door, self.graph, self.files, self.shown = site, door, graph, files, shown
        self.port, self.session = port, session
        self.scheme = "https" if door.lan else "http"
        self.url = f"{self.scheme}://localhost:{port}"

    def get(self, path, **options):
        return self.session.get(self.url + path, ssl=False, **options)

    def post(self, path, body, **options):
        return self.session.post(self.url + path, data=orjson.dumps(body), ssl=False, **options)

    def ws(self, path="/ws", **options):
        return self.session.ws_connect(self.url + path, ssl=False, max_msg_size=0, **options)

    def say(self, topic, type_name, msg):
        """Lets the graph say something."""
        self.site.hub.publish(Message(self.site.hub.allowed.full(topic), type_name, to_bytes(msg)))

    def code(self):
        """The pairing code that was shown last."""
        line = [text for text in self.shown if "Code to type" in text][-1]
        return "".join(c for c in line if c.isdigit())


@contextlib.asynccontextmanager
async def serving(folder, lan=False, hosts=""):
    shown, graph, files = [], FakeGraph(), Files()
    page = folder / "page"
    (page / "assets").mkdir(parents=True, exist_ok=True)
    (page / "index.html").write_text("<html>the page</html>")
    (page / "assets" / "app-1.js").write_text("console.log('" + "x" * 500 + "')")
    (folder / "secret.txt").write_text("a secret beside the page")
    site = Site(Allowed("walk"), files, graph, page)
    door = open_door(BridgeConfig(lan=lan, hosts=hosts), folder / "certificate", shown.append)
    server = WebServer(site, door)
    port = await server.start("127.0.0.1", 0)
    try:
        async with aiohttp.ClientSession(cookie_jar=aiohttp.DummyCookieJar()) as session:
            yield Served(site, door, graph, files, shown, port, session)
    finally:
        await server.stop()


async def status(request):
    """Returns the status of the answer to a request."""
    async with request as response:
        return response.status


async def receive(ws, limit_s=5.0):
    """Returns the next message of a WebSocket; JSON as values, binary as bytes, else the close code."""
    message = await ws.receive(limit_s)
    if message.type is aiohttp.WSMsgType.TEXT:
        return orjson.loads(message.data)
    return message.data if message.type is aiohttp.WSMsgType.BINARY else ws.close_code


async def receive_until(ws, condition, limit_s=5.0):
    """Returns the first message that meets the condition."""
    end = time.monotonic() + limit_s
    while True:
        message = await receive(ws, max(end - time.monotonic(), 0.01))
        if condition(message):
            return message
        assert not isinstance(message, int | None), f"closed with {message}"


def text(data):
    return String(data=data)
