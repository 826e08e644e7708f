# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Malformed frames and requests: nothing ends the bridge, nothing looks like a fault in its log.

WALK_FUZZ says how many; 100000 is the figure of the acceptance, the suite takes fewer.
"""

import asyncio
import contextlib
import logging
import os
import random

import orjson
from bridge_server import receive_until, serving

from walk_vr_bridge.client import Client

COUNT = int(os.environ.get("WALK_FUZZ", "4000"))
SEEDS = [
    {
        "op": "subscribe",
        "topic": "/walk/path",
        "id": "1",
        "throttle_rate": 10,
        "queue_length": 1,
        "compression": "cbor",
    },
    {
        "op": "publish",
        "topic": "/walk/keypoint_edits",
        "msg": {"marker_name": "1", "event_type": 1, "pose": {"position": {"x": 1.0}}},
    },
    {"op": "call_service", "service": "/walk/undo", "type": "std_srvs/Trigger", "args": {}, "id": "7"},
    {
        "op": "call_service",
        "service": "/walk/trajopt/set_parameters",
        "args": {"parameters": [{"name": "trajopt.x", "value": {"type": 3}}]},
    },
    {"op": "fragment", "id": "f", "num": 0, "total": 2, "data": "{}"},
    {
        "op": "publish",
        "topic": "/walk/study_events",
        "msg": {"status": [{"name": "a", "values": [{"key": "k", "value": "v"}]}]},
    },
    {"op": "unsubscribe", "topic": "/walk/path"},
    {"op": "advertise", "topic": "/walk/playback/seek", "type": "std_msgs/Float64"},
]
VALUES = [
    None,
    True,
    -1,
    0,
    2**70,
    1e308,
    "",
    "x" * 300,
    [],
    {},
    [[]],
    {"a": 1},
    "/walk/path",
    "\ud7ff",
    -0.5,
    "none",
    1e999,
]
LINES = [
    b"GET / HTTP/1.1",
    b"POST /api/pair HTTP/1.1",
    b"GET /ws HTTP/1.1",
    b"BREW / HTTP/1.1",
    b"GET /importance.bin?revision=%00 HTTP/1.1",
]
HEADERS = [
    b"Host: localhost",
    b"Content-Length: 5",
    b"Content-Length: -1",
    b"Transfer-Encoding: chunked",
    b"Upgrade: websocket",
    b"Connection: Upgrade",
    b"Sec-WebSocket-Version: 13",
    b"Sec-WebSocket-Key: x",
    b"Cookie: walk_session=\xff;=;",
    b"Origin: ",
    b"Host: evil",
    b"Authorization: Bearer",
    b"Expect: 100-continue",
    b"Range: bytes=0-",
    b"If-None-Match: W/",
    b"X: " + b"y" * 5000,
]


def spoilt(rng):
    """A frame that was one, with something in it that does not belong."""
    frame = orjson.loads(orjson.dumps(rng.choice(SEEDS)))
    for _ in range(rng.randrange(1, 4)):
        at = frame
        while isinstance(at, dict | list) and at and rng.random() < 0.7:
            key = rng.choice(list(at)) if isinstance(at, dict) else rng.randrange(len(at))
            if isinstance(at[key], dict | list) and at[key]:
                at = at[key]
                continue
            at[key] = rng.choice(VALUES) if rng.random() < 0.8 else rng.choice(list(SEEDS[0].values()))
            break
        if isinstance(at, dict) and rng.random() < 0.2:
            at[rng.choice(["", "op", "x", "id", "type"])] = rng.choice(VALUES)
    with contextlib.suppress(TypeError):
        data = orjson.dumps(frame)
        if rng.random() < 0.3:
            at = rng.randrange(len(data))
            data = data[:at] + rng.randbytes(rng.randrange(4)) + data[at + rng.randrange(3) :]
        return data
    return rng.randbytes(rng.randrange(200))


def request(rng):
    """Something like an HTTP request."""
    if rng.random() < 0.2:
        return rng.randbytes(rng.randrange(400)) + b"\r\n\r\n"
    lines = [rng.choice(LINES), *rng.choices(HEADERS, k=rng.randrange(6))]
    data = b"\r\n".join(lines) + b"\r\n\r\n" + rng.randbytes(rng.randrange(30))
    at = rng.randrange(len(data))
    return data if rng.random() < 0.5 else data[:at] + rng.randbytes(3) + data[at:]


def assert_quiet(caplog):
    loud = [r for r in caplog.records if r.levelno >= logging.WARNING or r.exc_info]
    assert not loud, loud[:3]


def test_malformed_frames_are_answered_and_forgotten(run, tmp_path, caplog):
    rng = random.Random(5)

    async def scene():
        async with serving(tmp_path) as served:
            operations, client = served.site.operations, Client("web-fuzz", "editor")
            served.site.hub.clients.add(client)
            for number in range(COUNT):
                operations.receive(client, spoilt(rng))
                if number % 500 == 0:
                    await asyncio.sleep(0)
            assert len(client.fragments) <= 4
            assert served.graph.published  # some of it was sound all the same
            client.close()
            async with served.ws() as ws:
                for _ in range(60):
                    await ws.send_bytes(spoilt(rng))
                await ws.send_json({"op": "call_service", "service": "/rosapi/get_time", "id": "alive"})
                await receive_until(ws, lambda m: isinstance(m, dict) and m.get("id") == "alive")

    run(scene())
    assert_quiet(caplog)


def test_malformed_requests_leave_the_server_alone(run, tmp_path, caplog):
    rng = random.Random(6)

    async def ask(port, data):
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        with contextlib.suppress(ConnectionError):
            writer.write(data)
            if rng.random() < 0.5:
                writer.write_eof()
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(reader.read(4096), 0.1)
        writer.transport.abort()

    async def scene():
        async with serving(tmp_path) as served:
            for _ in range(max(1, COUNT // 10 // 20)):
                await asyncio.gather(*(ask(served.port, request(rng)) for _ in range(20)))
            async with served.get("/") as response:
                assert response.status == 200
            assert not served.graph.published

    run(scene())
    assert_quiet(caplog)
