# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What is wrong or too much: told, bounded, and in nobody else's way."""

import asyncio

import pytest
from bridge_server import receive, receive_until, serving

from walk_vr_bridge.limits import MAX_SUBSCRIPTIONS
from walk_vr_bridge.outbox import Frame, Outbox


@pytest.mark.parametrize(
    "said",
    [
        "",
        "{",
        "[]",
        "3",
        '{"op": 3}',
        '{"op": "subscribe"}',
        '{"op": "subscribe", "topic": "/walk/path", "compression": "png"}',
        '{"op": "subscribe", "topic": "/walk/path", "type": "std_msgs/String"}',
        '{"op": "publish", "topic": "/walk/keypoint_edits", "msg": 3}',
        '{"op": "subscribe", "topic": "/walk/path", "throttle_rate": "x"}',
        '{"op": "fragment", "id": "1", "num": 0, "total": 0, "data": ""}',
        '{"op": "fragment", "id": "1", "num": 0, "total": 1, "data": "{}"}',
        '{"op": "set_level", "level": "loud"}',
        "[" * 5000,
        '{"op": "subscribe", "topic": "/walk/path", "id": {"x": 1}}',
        "\x00",
        b"\xff\xfe",
    ],
)
def test_what_is_wrong_is_told_and_the_connection_lives_on(run, tmp_path, said):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:
            await (ws.send_bytes(said) if isinstance(said, bytes) else ws.send_str(said))
            answer = await receive(ws)
            assert (answer["op"], answer["level"]) == ("status", "error")
            await ws.send_json({"op": "call_service", "service": "/rosapi/get_time", "id": "alive"})
            assert (await receive_until(ws, lambda m: m.get("id") == "alive"))["result"] is True

    run(scene())


def test_subscriptions_are_bounded(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:
            for number in range(MAX_SUBSCRIPTIONS + 1):
                await ws.send_json({"op": "subscribe", "topic": "/walk/playback", "id": str(number)})
            assert (await receive(ws))["op"] == "status"

    run(scene())


def test_a_client_that_floods_is_slowed_and_then_closed(run, tmp_path, monkeypatch):
    monkeypatch.setattr("walk_vr_bridge.limits.OVERRUN_S", 0.5)

    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:

            async def flood():
                while not ws.closed:
                    await ws.send_str('{"op": "status"}')

            flooding = asyncio.create_task(flood())
            with pytest.raises(AssertionError, match="1008"):
                await receive_until(ws, lambda m: False, 20.0)
            flooding.cancel()
            await asyncio.gather(flooding, return_exceptions=True)

    run(scene())


def test_a_slow_client_keeps_the_newest_and_loses_no_answer(run):
    async def scene():
        box = Outbox()
        for number in range(1000):
            box.put("path", Frame(b"%d" % number, text=True), 1)
            box.put("events", Frame(b"e%d" % number, text=True), 64)
            if number < 100:
                box.answer(Frame(b"a%d" % number, text=True))
        seen = [(await box.get()).data for _ in range(165)]
        assert seen.count(b"999") == 1
        assert [d for d in seen if d.startswith(b"a")] == [b"a%d" % n for n in range(100)]
        assert [d for d in seen if d.startswith(b"e")] == [b"e%d" % n for n in range(936, 1000)]
        assert box.dropped == 999 + 936
        # In turns: the path does not wait for a hundred answers.
        assert b"999" in seen[:3]

    run(scene())
