# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The time from an edit to the path that answers it: straight over DDS, and through the bridge."""

from __future__ import annotations

import asyncio
import time
from typing import Any

import aiohttp
import cbor2
import numpy as np
import orjson
import rclpy
from rclpy.executors import SingleThreadedExecutor

from walk_ros.conversions import EditKind, KeypointEdit, edit_to_msg
from walk_ros.topics import TOPICS, absolute_name
from walk_vr_bridge.bench.graph import BenchError
from walk_vr_bridge.wire.rows import header_stamp_ns

EDITS, PATH = absolute_name("keypoint_edits"), absolute_name("path")
_LIMIT_S = 10.0
_FORMS = ("none", "cbor", "cbor-raw")


def direct_trips(count: int, rate_hz: float) -> list[float]:
    """Returns the times from publishing an edit to receiving the path, by a node in this process [s]."""
    rclpy.init()
    node = rclpy.create_node("direct")
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    came: dict[int, float] = {}
    edits, path = TOPICS["keypoint_edits"], TOPICS["path"]
    publisher = node.create_publisher(edits.type, EDITS, edits.qos)

    def heard(data: Any) -> None:
        came[header_stamp_ns(bytes(data))] = time.perf_counter()

    node.create_subscription(path.type, PATH, heard, path.qos, raw=True)
    try:
        _wait(executor, lambda: publisher.get_subscription_count() >= 1, "the node that copies")
        # The way back is found a little later: until then an answer does not arrive.
        _wait(executor, lambda: publisher.publish(_edit(1)) or 1 in came, "its first answer")
        sent = {}
        began = time.perf_counter()
        for k in range(count):
            while (left := began + k / rate_hz - time.perf_counter()) > 0:
                executor.spin_once(timeout_sec=left)
            stamp_ns = 10**9 * (k + 1)
            sent[stamp_ns] = time.perf_counter()
            publisher.publish(_edit(stamp_ns))
        # A path is kept one deep: on a busy machine some are replaced before they are read.
        _wait(executor, lambda: len(sent.keys() & came.keys()) >= 0.5 * count, "its answers")
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()
    return [came[stamp] - at for stamp, at in sent.items() if stamp in came]


async def bridge_trips(url: str, count: int, rate_hz: float, form: str) -> list[float]:
    """Returns the times from sending an edit to having read the path, by a client of the bridge [s].

    The path carries the time at which the bridge took the edit: that tells which edit it answers.
    """
    came: list[tuple[float, int]] = []
    sent: list[tuple[float, int]] = []
    async with aiohttp.ClientSession() as session, session.ws_connect(f"{url}/ws", max_msg_size=0) as ws:
        await ws.send_json({"op": "subscribe", "topic": PATH, "compression": form, "queue_length": 100})
        reader = asyncio.create_task(_read(ws, came))
        began = time.perf_counter() + 0.5
        for k in range(count):
            await asyncio.sleep(max(0.0, began + k / rate_hz - time.perf_counter()))
            sent.append((time.perf_counter(), time.time_ns()))
            await ws.send_bytes(frame(k + 1))
        await asyncio.sleep(0.5)
        reader.cancel()
    stamps = np.array([stamp for _, stamp in sent])
    answers = [(int(np.searchsorted(stamps, stamp)) - 1, at) for at, stamp in came]
    trips = [at - sent[k][0] for k, at in answers if k >= 0]
    if len(trips) < 0.5 * count:
        raise BenchError(f"only {len(trips)} of {count} edits were answered through the bridge")
    return trips


async def _read(ws: Any, came: list[tuple[float, int]]) -> None:
    """Notes when each path had been read, and its stamp: whoever draws a path has to read it."""
    while True:
        message = await ws.receive()
        if message.type is aiohttp.WSMsgType.TEXT:
            stamp = orjson.loads(message.data)["msg"]["header"]["stamp"]
        elif message.type is aiohttp.WSMsgType.BINARY:
            msg = cbor2.loads(message.data)["msg"]
            if "bytes" in msg:
                came.append((time.perf_counter(), header_stamp_ns(msg["bytes"])))
                continue
            stamp = msg["header"]["stamp"]
        else:
            raise BenchError(f"the bridge closed the connection with {ws.close_code}")
        came.append((time.perf_counter(), 10**9 * stamp["sec"] + stamp["nanosec"]))


def frame(number: int, keypoint: int | None = None) -> bytes:
    """Returns a drag as a client sends it; each is of another keypoint, so that none replaces another."""
    position = {"x": 1.0 + number % 100 / 100, "y": 2.0, "z": 1.6}
    name = str(number if keypoint is None else keypoint)
    msg = {"header": {"stamp": {"sec": number}}, "marker_name": name, "event_type": 1, "pose": {"position": position}}
    return orjson.dumps({"op": "publish", "topic": EDITS, "msg": msg})


def figures(trips: list[float]) -> dict[str, float]:
    """Returns p50, p95 and p99 [ms] and how many there were."""
    p50, p95, p99 = np.percentile(trips, [50, 95, 99]) * 1e3
    return {"p50_ms": round(p50, 3), "p95_ms": round(p95, 3), "p99_ms": round(p99, 3), "count": len(trips)}


def measure_trips(url: str, count: int, rate_hz: float) -> dict[str, Any]:
    """Returns figures of the way over DDS alone, of the way through the bridge, and what the bridge adds."""
    straight = figures(direct_trips(count, rate_hz))
    report: dict[str, Any] = {"edits": count, "rate_hz": rate_hz, "dds_alone": straight}
    for form in _FORMS:
        through = figures(asyncio.run(bridge_trips(url, count, rate_hz, form)))
        added = {key: round(through[key] - straight[key], 3) for key in ("p50_ms", "p95_ms", "p99_ms")}
        report[f"bridge_{form.replace('-', '_')}"] = {**through, "added": added}
    return report


def _edit(stamp_ns: int) -> Any:
    edit = KeypointEdit(
        kind=EditKind.DRAG,
        keypoint=1,
        client_id="direct",
        stamp_ns=stamp_ns,
        position=np.array([1.0, 2.0, 1.6]),
        quat_xyzw=np.array([0.0, 0.0, 0.0, 1.0]),
    )
    return edit_to_msg(edit)


def _wait(executor: Any, condition: Any, what: str) -> None:
    until = time.perf_counter() + _LIMIT_S
    while not condition():
        if time.perf_counter() > until:
            raise BenchError(f"waited {_LIMIT_S:g} s for {what}")
        executor.spin_once(timeout_sec=0.05)
