# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Many clients at once, some of them ill-behaved: what the editors among them notice."""

from __future__ import annotations

import asyncio
import contextlib
import random
import time
from typing import Any

import aiohttp
import cbor2
import orjson

from walk_vr_bridge.bench.graph import BenchGraph
from walk_vr_bridge.bench.trips import EDITS, PATH, figures, frame
from walk_vr_bridge.wire.rows import header_stamp_ns

_EDITORS = 4
_RATE_HZ = 5.0
_WATCHED = ("path", "trajectory", "keypoints", "keypoint_markers", "tour", "edit_results", "playback", "bridge/files")


async def measure_crowd(graph: BenchGraph, clients: int, seconds: float) -> dict[str, Any]:
    """Returns the figures of one editor alone and of the editors in a crowd, and the bridge's memory.

    Of the clients one takes nothing, one sends garbage, one floods, some edit, all others watch.
    """
    # A hundredth of too few is what the machine happened to do.
    alone = await _editors(graph.url, 1, seconds / 3)
    before = graph.memory_mib()
    ending = asyncio.Event()
    others: list[asyncio.Task[Any]] = [
        asyncio.create_task(ill(graph.url, ending)) for ill in (_stalled, _garbage, _flood)
    ]
    others += [asyncio.create_task(_watch(graph.url, ending)) for _ in range(clients - _EDITORS - len(others))]
    await asyncio.sleep(2.0)
    memory = asyncio.create_task(_memory(graph, ending))
    crowd = await _editors(graph.url, _EDITORS, seconds)
    ending.set()
    heard = await asyncio.gather(*others, return_exceptions=True)
    single, many = figures(alone), figures(crowd)
    return {
        "clients": clients,
        "seconds": seconds,
        "one_editor_alone": single,
        "editors_in_the_crowd": many,
        "p99_ratio": round(many["p99_ms"] / single["p99_ms"], 2),
        "watchers_heard": sum(h for h in heard if isinstance(h, int)),
        "failed_clients": [repr(h) for h in heard if isinstance(h, BaseException)],
        "memory_mib": {"before": round(before, 1), "during": await memory},
        "bridge_runs": graph.running(),
    }


async def _editors(url: str, count: int, seconds: float) -> list[float]:
    lists = await asyncio.gather(*(_edit(url, k, count, seconds) for k in range(count)))
    return [trip for trips in lists for trip in trips]


async def _edit(url: str, number: int, editors: int, seconds: float) -> list[float]:
    """Sends releases at a steady rate; returns the times until the path that answers each came [s]."""
    trips: list[float] = []
    async with aiohttp.ClientSession() as session, session.ws_connect(f"{url}/ws", max_msg_size=0) as ws:
        await ws.send_json({"op": "subscribe", "topic": PATH, "compression": "cbor-raw"})
        await asyncio.sleep(0.2)
        until = time.perf_counter() + seconds
        # Editors take turns, so that a path can be told to be the answer to the edit before it.
        due = time.perf_counter() + number / editors / _RATE_HZ
        at = 0
        while due < until:
            await asyncio.sleep(max(0.0, due - time.perf_counter()))
            at += 1
            due += 1 / _RATE_HZ
            since_ns = time.time_ns()
            began = time.perf_counter()
            await ws.send_bytes(frame(at, keypoint=number))
            while (came := await _stamp(ws)) is not None and came < since_ns:
                pass
            trips.append(time.perf_counter() - began)
    return trips


async def _stamp(ws: Any) -> int | None:
    message = await ws.receive(10.0)
    if message.type is not aiohttp.WSMsgType.BINARY:
        return 0
    return header_stamp_ns(cbor2.loads(message.data)["msg"]["bytes"])


async def _watch(url: str, ending: asyncio.Event) -> int:
    heard = 0
    async with aiohttp.ClientSession() as session, session.ws_connect(f"{url}/ws", max_msg_size=0) as ws:
        for topic in _WATCHED:
            await ws.send_json({"op": "subscribe", "topic": f"/walk/{topic}", "compression": "cbor-raw"})
        while not ending.is_set():
            try:
                message = await ws.receive(1.0)
            except TimeoutError:
                continue
            if message.type not in (aiohttp.WSMsgType.TEXT, aiohttp.WSMsgType.BINARY):
                raise ConnectionError(f"a watcher was closed with {ws.close_code}")
            heard += 1
    return heard


async def _stalled(url: str, ending: asyncio.Event) -> None:
    """Subscribes to everything and reads nothing."""
    while not ending.is_set():
        async with aiohttp.ClientSession(read_bufsize=1024) as session:
            ws = await session.ws_connect(f"{url}/ws", max_msg_size=0)
            for topic in _WATCHED:
                await ws.send_json({"op": "subscribe", "topic": f"/walk/{topic}", "queue_length": 1000})
            connection = ws._conn
            if connection is not None and connection.protocol is not None:
                connection.protocol.pause_reading()
            await _sleep(ending, 60.0)


async def _garbage(url: str, ending: asyncio.Event) -> None:
    """Sends what is no message, and comes again when it is thrown out."""
    rng = random.Random(1)
    async with aiohttp.ClientSession() as session:
        while not ending.is_set():
            async with session.ws_connect(f"{url}/ws", max_msg_size=0) as ws:
                while not ws.closed and not ending.is_set():
                    with contextlib.suppress(TimeoutError, ConnectionError):
                        await ws.send_bytes(rng.randbytes(rng.randrange(2000)))
                        await ws.send_str(str(orjson.dumps({"op": rng.choice(["publish", "x", 3]), "topic": EDITS})))
                        await ws.receive(0.02)
            await _sleep(ending, 0.5)


async def _flood(url: str, ending: asyncio.Event) -> None:
    """Sends drags as fast as they go, and comes again when it is thrown out."""
    async with aiohttp.ClientSession() as session:
        while not ending.is_set():
            async with session.ws_connect(f"{url}/ws", max_msg_size=0) as ws:
                at = 0
                while not ws.closed and not ending.is_set():
                    at += 1
                    try:
                        # To a place that is none: the graph itself is not what is to be flooded here.
                        await ws.send_bytes(frame(at, keypoint=-1))
                    except ConnectionError:
                        break
                    if at % 20 == 0:
                        await asyncio.sleep(0.01)
            await _sleep(ending, 0.5)


async def _memory(graph: BenchGraph, ending: asyncio.Event) -> list[float]:
    """Returns the bridge's memory, ten times over the whole stay [MiB]."""
    found = []
    while not ending.is_set():
        found.append(round(graph.memory_mib(), 1))
        await _sleep(ending, 5.0)
    return found[:: max(1, len(found) // 10)]


async def _sleep(ending: asyncio.Event, seconds: float) -> None:
    with contextlib.suppress(TimeoutError):
        await asyncio.wait_for(ending.wait(), seconds)
