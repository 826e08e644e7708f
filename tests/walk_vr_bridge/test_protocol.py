# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What the bridge answers to what a client says, over a real socket, with a graph that only remembers."""

import cbor2
import orjson
import pytest
from bridge_server import receive, serving, text
from geometry_msgs.msg import PoseArray
from nav_msgs.msg import OccupancyGrid

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
