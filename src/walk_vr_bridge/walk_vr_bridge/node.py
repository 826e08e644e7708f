# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The bridge as a node: the building for the page, the graph for its clients, and playback."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import orjson
from std_msgs.msg import String

from walk_building.building import Building
from walk_ros.conversions import importance_map_from_msg
from walk_ros.errors import MessageError
from walk_ros.node import WalkNode
from walk_ros.raw import from_bytes, to_bytes
from walk_ros.topics import TOPICS
from walk_vr_bridge.allowed import FILES, LOCAL, OWN, Allowed
from walk_vr_bridge.config import BridgeConfig
from walk_vr_bridge.files import Files
from walk_vr_bridge.graph import Graph
from walk_vr_bridge.model.scene import make_scene
from walk_vr_bridge.model.volume import volume
from walk_vr_bridge.site import Site
from walk_vr_bridge.stage import Stage
from walk_vr_bridge.wire.message import Message

PAGE = Path(__file__).resolve().parent / "static"


def default_certificate_dir() -> Path:
    """Returns the folder in which the certificate is kept across restarts."""
    state = os.environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state"
    return Path(state) / "walk" / "bridge"


class BridgeNode(WalkNode):
    """Makes the files of the page in its worker and hands messages on between graph and web server.

    Attributes:
        site: What the web server serves.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop, on_config: Callable[[], None]) -> None:
        """Subscribes; everything of the web server happens in the loop.

        Args:
            loop: Of the web server.
            on_config: Called in the loop when the bridge's config has changed.
        """
        super().__init__("vr_bridge", {"bridge": BridgeConfig})
        self.declare_text("certificate_dir", str(default_certificate_dir()), "folder of the certificate for bridge.lan")
        self._loop = loop
        self._on_config = on_config
        self._files = Files()
        self._allowed = Allowed(self.get_namespace())
        self._graph = Graph(self, self._allowed, loop)
        self.site = Site(self._allowed, self._files, self._graph, PAGE)
        self._stage = Stage(self, self.config.viewpoint_hz)
        self._scene_for: tuple[Any, ...] = ()
        self._map: Message | None = None
        self._own = {self._allowed.full(name) for name in OWN}
        for topic in TOPICS:
            if self._allowed.full(topic) in self._allowed.heard:
                self._graph.listen(topic, self._heard)
        self._announce()
        self.start()

    @property
    def config(self) -> BridgeConfig:
        """The bridge's config as it is now."""
        return self.parameters.get("bridge", BridgeConfig)

    def work(self, building: Building) -> None:
        """Makes the page's files of what is new: the building, the importance map."""
        config = self.config
        wanted = (building.hash, config.full_triangles, config.miniature_triangles)
        if wanted != self._scene_for:
            began = self.now_s()
            scene = make_scene(building, config, self.worker.progress)
            self._files.set_scene(scene)
            self._scene_for = wanted
            self._announce()
            self.get_logger().info(f"the page's building is ready, {1e3 * (self.now_s() - began):.0f} ms")
        message, self._map = self._map, None
        if message is not None:
            self._take_map(message, building)

    def forget(self) -> None:
        """Serves no building while another one is loaded."""
        self._scene_for = ()
        self._files.no_building("the building is being loaded", loading=True)
        self._announce()

    def report(self, error: Exception) -> None:
        """Says why there is no building."""
        if self.building is None:
            self._files.no_building(str(error), loading=False)
        super().report(error)

    def fail(self, stamp_ns: int) -> None:
        """Tells clients that there are no files."""
        del stamp_ns
        self._announce()

    def supersedes(self, groups: frozenset[str]) -> bool:
        """Returns whether a change of these groups makes the running step pointless; tells the web server."""
        if "bridge" in groups:
            self._stage.set_rate(self.config.viewpoint_hz)
            self.in_loop(self._on_config)
        return False

    def in_loop(self, what: Callable[..., object], *args: Any) -> None:
        """Calls something in the web server's thread."""
        if not self._loop.is_closed():
            self._loop.call_soon_threadsafe(what, *args)

    def _heard(self, message: Message) -> None:
        short = self._allowed.short(message.topic)
        if message.topic in self._own:
            self.in_loop(self._answered, message)
            return
        self.in_loop(self.site.hub.publish, message)
        if short == "importance_map":
            self._map = message
            self.worker.wake()
        elif short == "trajectory":
            try:
                self._stage.take(message.data)
            except MessageError as error:
                self.get_logger().warning(f"trajectory: {error}")
                self.diagnostics.note(refused_message=f"trajectory: {error}")

    def _answered(self, message: Message) -> None:
        self.site.operations.answered(message.topic, message.values())

    def _take_map(self, message: Message, building: Building) -> None:
        received = importance_map_from_msg(from_bytes(message.data, "sensor_msgs/msg/PointCloud2"))
        if received is not None:
            self._files.set_volume(volume(received, building.hash))
        else:
            self._files.no_volume()
        self._announce()

    def _announce(self) -> None:
        """Tells clients which files there are."""
        text = orjson.dumps(self._files.told()).decode()
        message = Message(self._allowed.full(FILES), LOCAL[FILES], to_bytes(String(data=text)))
        self.in_loop(self.site.hub.publish, message)
