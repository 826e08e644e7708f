# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What the bridge answers to what a client says, over a real socket, with a graph that only remembers."""

import asyncio

import cbor2
import orjson
import pytest
from bridge_server import receive, receive_until, serving, text
from geometry_msgs.msg import PoseArray
from nav_msgs.msg import OccupancyGrid

from walk_vr_bridge.limits import MAX_SUBSCRIPTIONS
from walk_vr_bridge.outbox import Frame, Outbox

PLAYBACK, STRING = "/walk/playback", "std_msgs/String"


def test_a_late_client_gets_the_last_message_at_once(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served:
            served.say("playback", STRING, text("first"))
            served.say("playback", STRING, text("second"))
            async with served.ws() as ws:
                await ws.send_json({"op": "subscribe", "topic": PLAYBACK, "type": "std_msgs/msg/String"})
                assert (await receive(ws)) == {"op": "publish", "topic": PLAYBACK, "msg": {"data": "second"}}

    run(scene())


def test_all_storeys_of_the_newest_map_come_at_once(run, tmp_path):
    def storey(stamp, z):
        grid = OccupancyGrid()
        grid.header.stamp.sec, grid.info.origin.position.z = stamp, z
        return grid

    async def scene():
        async with serving(tmp_path) as served:
            for stamp, z in ((1, 0.0), (1, 3.0), (2, 0.0), (2, 3.0), (2, 6.0)):
                served.say("importance_map/storeys", "nav_msgs/OccupancyGrid", storey(stamp, z))
            async with served.ws() as ws:
                await ws.send_json({"op": "subscribe", "topic": "/walk/importance_map/storeys"})
                seen = [(await receive(ws))["msg"] for _ in range(3)]
                assert [m["info"]["origin"]["position"]["z"] for m in seen] == [0.0, 3.0, 6.0]
                assert {m["header"]["stamp"]["sec"] for m in seen} == {2}

    run(scene())


@pytest.mark.parametrize("name", ["playback", "/walk/playback"])
@pytest.mark.parametrize("type_name", [None, "", "std_msgs/String", "std_msgs/msg/String"])
def test_names_and_types_in_every_spelling(run, tmp_path, name, type_name):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:
            served.say("playback", STRING, text("x"))
            # In a binary frame with a null for an id, as ROS# sends it.
            await ws.send_bytes(orjson.dumps({"op": "subscribe", "topic": name, "type": type_name, "id": None}))
            assert (await receive(ws))["msg"]["data"] == "x"

    run(scene())


def test_two_listeners_of_a_client_cost_one_message(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:
            for identity in ("a", "b"):
                await ws.send_json({"op": "subscribe", "topic": PLAYBACK, "id": identity})
            await ws.send_json({"op": "unsubscribe", "topic": PLAYBACK, "id": "a"})
            await ws.send_json({"op": "subscribe", "topic": "/walk/bridge/session"})
            await receive(ws)
            served.say("playback", STRING, text("1"))
            assert (await receive(ws))["msg"]["data"] == "1"
            await ws.send_json({"op": "unsubscribe", "topic": PLAYBACK})
            await ws.send_json({"op": "call_service", "service": "/rosapi/topics", "id": "done"})
            assert (await receive(ws))["id"] == "done"
            served.say("playback", STRING, text("2"))
            with pytest.raises(TimeoutError):
                await receive(ws, 0.2)

    run(scene())


def test_throttled_messages_end_with_the_newest(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:
            await ws.send_json({"op": "subscribe", "topic": PLAYBACK, "throttle_rate": 200})
            await ws.send_json({"op": "call_service", "service": "/rosapi/topics"})
            await receive(ws)
            for number in range(20):
                served.say("playback", STRING, text(str(number)))
            seen = [(await receive(ws))["msg"]["data"] for _ in range(2)]
            assert seen == ["0", "19"]

    run(scene())


@pytest.mark.parametrize("form", ["cbor", "cbor-raw"])
def test_binary_forms(run, tmp_path, form):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:
            served.say("keypoints", "geometry_msgs/PoseArray", PoseArray())
            await ws.send_json({"op": "subscribe", "topic": "/walk/keypoints", "compression": form})
            said = cbor2.loads(await receive(ws))
            assert said["topic"] == "/walk/keypoints"
            assert ("bytes" in said["msg"]) == (form == "cbor-raw")

    run(scene())


def test_fragments_go_both_ways(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:
            served.say("playback", STRING, text("long " * 1000))
            whole = orjson.dumps({"op": "subscribe", "topic": PLAYBACK, "fragment_size": 1024}).decode()
            parts = [whole[:20], whole[20:50], whole[50:]]
            for num in (2, 0, 1):
                await ws.send_json({"op": "fragment", "id": "f", "num": num, "total": 3, "data": parts[num]})
            got = [await receive(ws)]
            while len(got) < got[0]["total"]:
                got.append(await receive(ws))
            joined = orjson.loads("".join(part["data"] for part in sorted(got, key=lambda p: p["num"])))
            assert joined["msg"]["data"] == "long " * 1000

    run(scene())


def test_answers_to_an_edit_go_to_its_client_alone_with_its_own_stamp(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as mine, served.ws() as other:
            for ws in (mine, other):
                await ws.send_json({"op": "subscribe", "topic": "/walk/edit_results"})
            edit = {"marker_name": "3", "event_type": 5, "header": {"stamp": {"sec": 12}}}
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
                edit = {"marker_name": "3", "event_type": 5 if x == 19 else 1, "pose": {"position": {"x": x}}}
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
                edit = {"marker_name": "3", "event_type": 5, "pose": {"position": {"x": x}}}
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
            edit = {"marker_name": "3", "event_type": 5, "header": {"stamp": {"sec": 7}}}
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
            edit = {"marker_name": "3", "event_type": 5, "pose": {"position": {"x": None}}}
            await ws.send_json({"op": "publish", "topic": "/walk/keypoint_edits", "msg": edit})
            answer = (await receive(ws))["msg"]
            assert answer["level"] == 1
            assert "not finite" in answer["message"]
            assert not served.graph.published

    run(scene())


def test_a_service_that_nobody_offers_is_answered(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:
            await ws.send_json(
                {"op": "call_service", "service": "/walk/undo", "type": "std_srvs/srv/Trigger", "id": "u"}
            )
            answer = await receive(ws)
            assert (answer["id"], answer["result"]) == ("u", True)
            assert answer["values"] == {"success": False, "message": ""}
            await ws.send_json({"op": "call_service", "service": "/walk/nothing"})
            assert (await receive(ws))["result"] is False
            await ws.send_json({"op": "call_service", "service": "/walk/play", "args": [True]})
            assert (await receive(ws))["result"] is True
            assert served.graph.called[-1][1].data is True

    run(scene())


def test_study_events_carry_time_and_client(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:
            event = {"status": [{"name": "answer", "values": [{"key": "sus_1", "value": "4"}]}]}
            await ws.send_json({"op": "publish", "topic": "/walk/study_events", "msg": event})
            await ws.send_json({"op": "publish", "topic": "/walk/study_events", "msg": {}})
            assert (await receive(ws))["op"] == "status"
            (msg,) = served.graph.on("/walk/study_events")
            assert msg.header.stamp.sec > 10**9
            assert msg.status[0].hardware_id.startswith("web-")

    run(scene())


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
                await ws.send_json({"op": "subscribe", "topic": PLAYBACK, "id": str(number)})
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


def test_files_are_named_by_their_content(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served:
            async with served.get("/assets/app-1.js", headers={"Accept-Encoding": "gzip"}) as response:
                assert response.headers["Content-Encoding"] == "gzip"
                assert "immutable" in response.headers["Cache-Control"]
                tag = response.headers["ETag"]
            async with served.get("/assets/app-1.js", headers={"If-None-Match": tag}) as response:
                assert response.status == 304
            async with served.get("/building.json") as response:
                assert (response.status, response.headers["Retry-After"]) == (503, "1")
                assert "loaded" in (await response.json())["error"]

    run(scene())
