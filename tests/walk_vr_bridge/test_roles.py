# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a client may do once it is in: viewers nothing, editors what is on the list, nobody in another's name."""

from types import SimpleNamespace

from bridge_server import receive, serving

from walk_vr_bridge.allowed import Allowed
from walk_vr_bridge.client import Client
from walk_vr_bridge.hub import Hub
from walk_vr_bridge.wire.message import Message


def test_viewers_change_nothing(run, tmp_path):
    async def scene():
        async with serving(tmp_path, lan=True) as served:
            token = served.door.access.tokens["viewer"]
            async with served.ws(f"/ws?token={token}") as ws:
                await ws.send_json({"op": "subscribe", "topic": "/walk/edit_results"})
                edit = {"marker_name": "1", "event_type": 5, "header": {"stamp": {"sec": 7}}}
                await ws.send_json({"op": "publish", "topic": "/walk/keypoint_edits", "msg": edit})
                answer = await receive(ws)
                assert answer["msg"]["message"].startswith("publish on /walk/keypoint_edits")
                assert {"key": "edit_stamp_ns", "value": "7000000000"} in answer["msg"]["values"]
                for topic in ("playback/seek", "playback/speed", "study_events"):
                    await ws.send_json({"op": "publish", "topic": "/walk/" + topic, "msg": {}})
                    assert (await receive(ws))["level"] == "error"
                for service in (
                    "undo",
                    "redo",
                    "replan",
                    "play",
                    "trajopt/set_parameters",
                    "trajopt/set_parameters_atomically",
                ):
                    await ws.send_json({"op": "call_service", "service": "/walk/" + service, "id": "1"})
                    assert (await receive(ws))["result"] is False
                await ws.send_json({"op": "call_service", "service": "/walk/trajopt/list_parameters", "id": "1"})
                assert (await receive(ws))["result"] is True
            assert not served.graph.published
            assert [name for name, _ in served.graph.called] == ["/walk/trajopt/list_parameters"]

    run(scene())


def test_editors_reach_only_what_is_on_the_list(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:
            for topic in (
                "/walk/path",
                "/walk/keypoints",
                "/rosout",
                "/walk/../rosout",
                "/walk/viewpoint",
                "/parameter_events",
            ):
                await ws.send_json({"op": "publish", "topic": topic, "msg": {}})
                assert (await receive(ws))["op"] == "status"
            for topic in ("/rosout", "/walk/keypoint_edits", "/parameter_events"):
                await ws.send_json({"op": "subscribe", "topic": topic})
                assert (await receive(ws))["op"] == "status"
            for service in (
                "/walk/trajopt/get_parameter_types",
                "/other/undo",
                "/walk/sequencer/../trajopt/set_parameters",
            ):
                await ws.send_json({"op": "call_service", "service": service})
                assert (await receive(ws))["result"] is False
            for name in (
                "building",
                "load.doors",
                "cache_dir",
                "state_dir",
                "keypoints_file",
                "bridge.lan",
                "bridge.hosts",
                "use_sim_time",
            ):
                value = {"type": 4, "string_value": "/etc/passwd"}
                for service in ("set_parameters", "set_parameters_atomically"):
                    args = {"parameters": [{"name": name, "value": value}]}
                    await ws.send_json({"op": "call_service", "service": f"/walk/trajopt/{service}", "args": args})
                    answer = await receive(ws)
                    assert answer["result"] is False
                    assert name in answer["values"]
            assert not served.graph.published
            assert not served.graph.called

    run(scene())


def test_nobody_edits_in_another_name(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served, served.ws("/ws?client=0123456789abcdef") as ws:
            edit = {"marker_name": "1", "event_type": 4, "client_id": "somebody else"}
            await ws.send_json({"op": "publish", "topic": "/walk/keypoint_edits", "msg": edit})
            await ws.send_json({"op": "subscribe", "topic": "/walk/bridge/session"})
            answer = await receive(ws)
            (msg,) = served.graph.on("/walk/keypoint_edits")
            assert msg.client_id in answer["msg"]["data"]
            assert msg.client_id.startswith("web-")

    run(scene())


def test_who_edits_hears_before_those_who_look_on():
    hub, heard = Hub(Allowed("walk")), []
    for name in "abcdefgh":
        client = Client(name, "editor")
        client.edits = name in "ce"
        client.listening["/walk/path"] = SimpleNamespace(offer=lambda message, name=name: heard.append(name))
        hub.clients.add(client)
    hub.publish(Message("/walk/path", "nav_msgs/Path", b""))
    assert set(heard[:2]) == {"c", "e"}
    assert sorted(heard) == list("abcdefgh")
