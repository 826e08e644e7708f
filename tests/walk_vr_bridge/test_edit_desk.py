# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Edits of clients: whose they are, in which order they go on, and what comes back."""

import asyncio

import pytest
from bridge_server import receive, serving


def at(x):
    return {"position": {"x": x, "y": 0.0, "z": 0.0}}


def test_answers_to_an_edit_go_to_its_client_alone_with_its_own_stamp(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as mine, served.ws() as other:
            for ws in (mine, other):
                await ws.send_json({"op": "subscribe", "topic": "/walk/edit_results"})
            edit = {"marker_name": "3", "event_type": 5, "header": {"stamp": {"sec": 12}}, "pose": at(1.0)}
            await mine.send_json({"op": "publish", "topic": "/walk/keypoint_edits", "msg": edit})
            await mine.send_json({"op": "call_service", "service": "/rosapi/services", "id": "1"})
            await receive(mine)
            (msg,) = served.graph.on("/walk/keypoint_edits")
            sent_ns = msg.header.stamp.sec * 10**9 + msg.header.stamp.nanosec
            assert sent_ns > 10**18
            assert msg.header.frame_id == "map"
            values = [{"key": "outcome", "value": "accepted"}, {"key": "edit_stamp_ns", "value": str(sent_ns)}]
            answer = {"level": 0, "name": "", "message": "", "hardware_id": msg.client_id, "values": values}
            served.site.operations.answered("/walk/edit_results", answer)
            assert (await receive(mine))["msg"]["values"][1]["value"] == "12000000000"
            with pytest.raises(TimeoutError):
                await receive(other, 0.2)

    run(scene())


def test_of_fast_drags_the_newest_wins_and_the_release_is_last(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:
            for x in range(20):
                edit = {"marker_name": "3", "event_type": 5 if x == 19 else 1, "pose": at(x)}
                await ws.send_json({"op": "publish", "topic": "/walk/keypoint_edits", "msg": edit})
            await asyncio.sleep(0.2)
            xs = [m.pose.position.x for m in served.graph.on("/walk/keypoint_edits")]
            assert xs[0] == 0.0
            assert xs[-1] == 19.0
            assert xs == sorted(xs)
            stamps = [
                m.header.stamp.sec * 10**9 + m.header.stamp.nanosec for m in served.graph.on("/walk/keypoint_edits")
            ]
            assert stamps == sorted(set(stamps))

    run(scene())


def test_edits_wait_in_order_until_the_planner_hears_them(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:
            served.graph.heard = False
            for x in range(3):
                edit = {"marker_name": "3", "event_type": 5, "pose": at(x)}
                await ws.send_json({"op": "publish", "topic": "/walk/keypoint_edits", "msg": edit})
            await asyncio.sleep(0.1)
            assert served.graph.on("/walk/keypoint_edits") == []
            served.graph.heard = True
            await asyncio.sleep(0.1)
            assert [m.pose.position.x for m in served.graph.on("/walk/keypoint_edits")] == [0.0, 1.0, 2.0]

    run(scene())


def test_an_edit_that_nobody_hears_in_time_is_told_and_never_sent(run, tmp_path, monkeypatch):
    monkeypatch.setattr("walk_vr_bridge.edits.EDIT_TIMEOUT_S", 0.05)

    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:
            await ws.send_json({"op": "subscribe", "topic": "/walk/edit_results"})
            served.graph.heard = False
            edit = {"marker_name": "3", "event_type": 5, "header": {"stamp": {"sec": 7}}, "pose": at(1.0)}
            await ws.send_json({"op": "publish", "topic": "/walk/keypoint_edits", "msg": edit})
            await asyncio.sleep(0.2)
            served.site.operations.sweep()
            assert "has not answered" in (await receive(ws))["msg"]["message"]
            served.graph.heard = True
            await asyncio.sleep(0.1)
            assert served.graph.on("/walk/keypoint_edits") == []

    run(scene())


def test_an_unsound_edit_is_refused_with_the_reason(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:
            await ws.send_json({"op": "subscribe", "topic": "/walk/edit_results"})
            edit = {"marker_name": "3", "event_type": 5, "pose": at(None)}
            await ws.send_json({"op": "publish", "topic": "/walk/keypoint_edits", "msg": edit})
            answer = (await receive(ws))["msg"]
            assert answer["level"] == 1
            assert "not finite" in answer["message"]
            assert not served.graph.published

    run(scene())
