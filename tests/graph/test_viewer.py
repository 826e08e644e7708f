# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What Foxglove gets, asked by a client that speaks its protocol and knows nothing of ours."""

import asyncio
import json
import socket
import struct

import aiohttp
import numpy as np
import pytest
import rclpy
from graph.processes import Graph, Observer

from walk_ros import conversions as c
from walk_ros.raw import from_bytes
from walk_ros.topics import TOPICS, absolute_name

pytestmark = pytest.mark.ros


def free_port():
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return found.getsockname()[1]


async def first_path(port):
    """Connects as Foxglove does; returns the channels and the bytes of the first path."""
    async with aiohttp.ClientSession() as session:
        url = f"ws://127.0.0.1:{port}"
        async with session.ws_connect(url, protocols=("foxglove.sdk.v1", "foxglove.websocket.v1")) as socket_:
            channels = {}
            async for message in socket_:
                if message.type == aiohttp.WSMsgType.TEXT:
                    said = json.loads(message.data)
                    channels |= {channel["topic"]: channel for channel in said.get("channels", ())}
                    if "channels" in said and "/walk/path" in channels:
                        wanted = {"id": 7, "channelId": channels["/walk/path"]["id"]}
                        await socket_.send_str(json.dumps({"op": "subscribe", "subscriptions": [wanted]}))
                elif message.data[0] == 1:
                    _, subscription, _ = struct.unpack_from("<BIQ", message.data)
                    assert subscription == 7
                    return channels, message.data[13:]
    raise AssertionError("the connection was closed")


def test_a_late_client_gets_the_channels_and_what_is_latched(other_domain, tmp_path):
    graph, observer = Graph(other_domain, tmp_path, ""), Observer(other_domain)
    port = free_port()
    line = np.array([[0.0, 0.0, 1.6], [1.0, 2.0, 1.6]])
    try:
        spec = TOPICS["path"]
        publisher = observer.node.create_publisher(spec.type, absolute_name("path"), spec.qos)
        publisher.publish(c.tour_to_msg(line, 5))
        graph.run("viewer", "walk_bag.viewer", "--ros-args", "-r", "__ns:=/walk", "-p", f"viewer_port:={port}")
        observer.wait(lambda: "ws://localhost" in graph.log("viewer"), "the viewer")
        channels, data = asyncio.run(asyncio.wait_for(first_path(port), 20))
        assert set(channels) == {absolute_name(name) for name in TOPICS}
        assert channels["/walk/path"]["schemaName"] == "nav_msgs/msg/Path"
        assert channels["/walk/path"]["encoding"] == "cdr"
        assert "geometry_msgs/PoseStamped[] poses" in channels["/walk/path"]["schema"]
        np.testing.assert_array_equal(c.tour_from_msg(from_bytes(data, "nav_msgs/msg/Path")).positions, line)
        assert graph.interrupt("viewer") == 0, graph.log("viewer")
    finally:
        observer.close()
        graph.close()


def test_a_port_that_is_taken_is_a_sentence(other_domain, tmp_path):
    graph = Graph(other_domain, tmp_path, "")
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        process = graph.run("viewer", "walk_bag.viewer", "--ros-args", "-p", f"viewer_port:={port}")
        assert process.wait(20) == 2
    assert f"viewer_port: {port} cannot be listened on" in graph.log("viewer")
    assert "Traceback" not in graph.log("viewer")
    assert not rclpy.ok()
