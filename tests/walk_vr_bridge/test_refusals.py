# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What is wrong with an edit or a call is told to whoever waits for its answer, with the reason."""

import json

import pytest
from bridge_server import receive, receive_until, serving

from walk_vr_bridge.refusing import edit_of, gist

EDITS, RESULTS = "/walk/keypoint_edits", "/walk/edit_results"


def edit(**fields):
    header = {"frame_id": "map", "stamp": {"sec": 12, "nanosec": 34}}
    return {"header": header, "marker_name": "3", "event_type": 5} | fields


def at(x):
    return {"position": {"x": x, "y": 0.0, "z": 1.6}}


@pytest.mark.parametrize(
    ("msg", "reason"),
    [
        (edit(pose=at(float("nan"))), "NaN"),
        (edit(pose=at(float("-inf"))), "infinite"),
        (edit(pose=at(None)), "finite"),
        (edit(pose=at("here")), "msg.pose.position.x is 'here'; expected a number"),
        (edit(event_type=256), "msg.event_type"),
        (edit(event_type=99), "event type 99 is no edit"),
        (edit(menu_entry_id=-1), "msg.menu_entry_id"),
        (edit(colour="red"), "has no field 'colour'"),
        (edit(pose=[1.0]), "msg.pose"),
        (edit(), "msg.pose.position has no x, y, z; expected"),
        (edit(event_type=1, pose={"position": {"x": 1.0, "y": 2.0}}), "msg.pose.position has no z; expected"),
        (edit(event_type=2, menu_entry_id=1), "msg.pose.position has no x, y, z; expected"),
    ],
)
def test_a_wrong_edit_is_refused_under_its_own_stamp(run, tmp_path, msg, reason):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:
            await ws.send_json({"op": "subscribe", "topic": RESULTS})
            # As text by Python's own writer, which writes NaN and Infinity as words.
            await ws.send_str(json.dumps({"op": "publish", "topic": EDITS, "msg": msg}))
            answer = await receive(ws)
            values = {pair["key"]: pair["value"] for pair in answer["msg"]["values"]}
            assert (answer["topic"], answer["msg"]["level"]) == (RESULTS, 1)
            assert reason in answer["msg"]["message"]
            assert (values["outcome"], values["keypoint"]) == ("refused", "3")
            assert values["edit_stamp_ns"] == "12000000034"
            assert served.graph.published == []
            # Told once: some clients take a `status` for an error of their own.
            await ws.send_json({"op": "publish", "topic": EDITS, "msg": edit(event_type=99)})
            assert (await receive(ws))["topic"] == RESULTS

    run(scene())


def test_an_edit_of_the_wrong_type_is_refused(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:
            await ws.send_json({"op": "subscribe", "topic": RESULTS})
            await ws.send_json({"op": "publish", "topic": EDITS, "type": "std_msgs/String", "msg": edit()})
            assert "is of type" in (await receive(ws))["msg"]["message"]

    run(scene())


def test_a_client_that_hears_no_results_is_told_in_a_status(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:
            await ws.send_str(json.dumps({"op": "publish", "topic": EDITS, "msg": edit(pose=at(float("nan")))}))
            answer = await receive(ws)
            assert (answer["op"], answer["level"]) == ("status", "error")
            assert "NaN" in answer["msg"]

    run(scene())


@pytest.mark.parametrize("kind", ["set_parameters", "set_parameters_atomically"])
@pytest.mark.parametrize(
    ("value", "reason"),
    [
        ({"type": 3, "double_value": float("nan")}, "NaN"),
        ({"type": 3, "double_value": None}, "trajopt.clearance_m: the value is NaN or infinite"),
        ({"type": 8, "double_array_value": [1.0, None]}, "NaN or infinite"),
        ({"type": 3, "double_value": "wide"}, "double_value is 'wide'"),
        ({"type": 300}, "type"),
    ],
)
def test_a_wrong_parameter_is_answered_with_the_reason(run, tmp_path, kind, value, reason):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:
            args = {"parameters": [{"name": "trajopt.clearance_m", "value": value}]}
            call = {"op": "call_service", "id": "7", "service": f"/walk/trajopt/{kind}", "args": args}
            await ws.send_str(json.dumps(call))
            answer = await receive(ws)
            assert (answer["op"], answer["id"], answer["result"]) == ("service_response", "7", False)
            assert answer["service"] == call["service"]
            assert reason in answer["values"]
            assert served.graph.called == []

    run(scene())


def test_a_wrong_edit_in_fragments_is_refused_too(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:
            await ws.send_json({"op": "subscribe", "topic": RESULTS})
            text = json.dumps({"op": "publish", "topic": EDITS, "msg": edit(pose=at(float("nan")))})
            for num, part in enumerate((text[:40], text[40:])):
                await ws.send_json({"op": "fragment", "id": "f", "num": num, "total": 2, "data": part})
            answer = await receive_until(ws, lambda said: said.get("topic") == RESULTS)
            assert "NaN" in answer["msg"]["message"]

    run(scene())


@pytest.mark.parametrize(
    "frame", ["", "{", "[NaN]", '{"op": 1}', '{"id": NaN, "x": "\\ud800"}', f'{{"a": NaN, "b": {10**30}}}']
)
def test_of_other_frames_nothing_is_made(frame):
    assert gist(frame) == {}


@pytest.mark.parametrize(
    "said",
    [
        {},
        {"msg": 1},
        {"msg": {"header": []}},
        {"msg": {"header": {"stamp": 3}}},
        {"msg": {"header": {"stamp": {"sec": "x"}}}},
    ],
)
def test_an_edit_that_does_not_name_itself_is_answered_for_none(said):
    assert edit_of(said) == ("", 0)
