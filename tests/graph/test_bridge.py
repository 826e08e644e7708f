# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Client libraries as they are installed drive a whole session through the bridge, over real DDS."""

import contextlib
import json
import shutil
import signal
import subprocess
import sys
import threading
import time
import urllib.request
from pathlib import Path

import numpy as np
import pytest

from walk_ros import conversions as c

pytestmark = pytest.mark.ros

WEB = Path(__file__).resolve().parents[2] / "src" / "walk_vr_bridge" / "web"
EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "edit_live.py"
LIMIT_S = 40.0


@pytest.fixture(scope="module")
def port(graph, observer):
    """The port of a bridge beside the whole graph, which has planned."""
    for name in ("trajopt", "sequencer", "importance"):
        graph.start(name)
    ros = ["-p", f"building:={graph.building}", "-p", "bridge.port:=0"]
    graph.run("vr_bridge", "walk_vr_bridge.main", "--ros-args", *ros)
    observer.wait_for_all()
    address = observer.wait(lambda: observer.state("vr_bridge").get("address"), "the bridge's address")
    return int(address.rpartition(":")[2])


def wait(condition, what):
    end = time.monotonic() + LIMIT_S
    while not (found := condition()):
        assert time.monotonic() < end, f"waited {LIMIT_S:g} s for {what}"
        time.sleep(0.02)
    return found


def read(port, path):
    with urllib.request.urlopen(f"http://localhost:{port}{path}", timeout=10) as response:
        return response.read()


class Session:
    """What a person does with roslibpy."""

    def __init__(self, roslibpy, ros):
        self.roslibpy, self.ros = roslibpy, ros
        self.heard = {}
        self.lock = threading.Lock()
        for topic, kind in (
            ("keypoint_markers", "visualization_msgs/MarkerArray"),
            ("path", "nav_msgs/Path"),
            ("edit_results", "diagnostic_msgs/DiagnosticStatus"),
            ("viewpoint", "geometry_msgs/PoseStamped"),
        ):
            self.heard[topic] = []
            roslibpy.Topic(ros, f"/walk/{topic}", kind).subscribe(self.heard[topic].append)
        self.edits = roslibpy.Topic(ros, "/walk/keypoint_edits", "visualization_msgs/InteractiveMarkerFeedback")
        self.stamp = 0

    def keypoints(self):
        markers = self.heard["keypoint_markers"][-1]["markers"]
        return {m["id"]: m["pose"]["position"] for m in markers if m["ns"] == "keypoints" and m["action"] == 0}

    def edit(self, **fields):
        """Publishes an edit, waits for its answer and for a path that comes after it."""
        self.stamp += 1
        paths = len(self.heard["path"])
        header = {"stamp": {"sec": self.stamp, "nanosec": 0}, "frame_id": "map"}
        self.edits.publish(self.roslibpy.Message({"header": header, **fields}))
        label = str(self.stamp * 10**9)

        def find():
            for msg in list(self.heard["edit_results"]):
                values = {pair["key"]: pair["value"] for pair in msg["values"]}
                if values["edit_stamp_ns"] == label:
                    return values | {"reason": msg["message"]}
            return None

        answer = wait(find, f"the answer to {fields}")
        if answer["outcome"] == "accepted":
            wait(lambda: len(self.heard["path"]) > paths, "a path after the edit")
        return answer

    def call(self, name, kind, **args):
        service = self.roslibpy.Service(self.ros, f"/walk/{name}", kind)
        return service.call(self.roslibpy.ServiceRequest(args), timeout=10)


@pytest.fixture
def session(port):
    roslibpy = pytest.importorskip("roslibpy", reason="roslibpy is not installed: ./walk setup does it")
    ros = roslibpy.Ros("localhost", port, transport="asyncio")
    ros.run(timeout=10)
    yield Session(roslibpy, ros)
    with contextlib.suppress(Exception):
        ros.close()


def test_roslibpy_drives_a_whole_session(session):
    wait(lambda: session.heard["keypoint_markers"] and session.heard["path"], "the snapshot")
    before = session.keypoints()
    assert len(before) >= 3
    assert "/walk/path" in session.ros.get_topics()
    first = next(iter(before))
    place = {"x": before[first]["x"] + 0.1, "y": before[first]["y"], "z": 1.6}

    moved = session.edit(marker_name=str(first), event_type=5, pose={"position": place})
    assert moved["outcome"] == "accepted", moved
    wait(lambda: abs(session.keypoints()[first]["x"] - place["x"]) < 0.06, "the moved keypoint")

    inserted = session.edit(event_type=2, menu_entry_id=1, pose={"position": {"x": 10.5, "y": 0.8, "z": 1.6}})
    assert inserted["outcome"] == "accepted", inserted
    new = int(inserted["keypoint"])
    wait(lambda: new in session.keypoints(), "the new keypoint")

    deleted = session.edit(event_type=2, menu_entry_id=2, marker_name=str(new))
    assert deleted["outcome"] == "accepted", deleted
    wait(lambda: new not in session.keypoints(), "the keypoint to go")

    assert session.call("undo", "std_srvs/srv/Trigger")["success"]
    wait(lambda: new in session.keypoints(), "the keypoint back")
    refused = session.edit(marker_name="999", event_type=5, pose={"position": {"x": 10.5, "y": 0.8, "z": 1.6}})
    assert refused["outcome"] == "refused"
    assert "999" in refused["reason"]


def test_parameters_are_described_and_set_through_the_bridge(session):
    names = ["trajopt.clearance_m"]
    told = session.call("trajopt/describe_parameters", "rcl_interfaces/DescribeParameters", names=names)
    (limits,) = told["descriptors"][0]["floating_point_range"]
    assert limits["from_value"] == 0.0
    value = {"name": names[0], "value": {"type": 3, "double_value": limits["to_value"] + 1.0}}
    kind = "rcl_interfaces/SetParametersAtomically"
    refused = session.call("trajopt/set_parameters_atomically", kind, parameters=[value])["result"]
    assert not refused["successful"]
    assert refused["reason"]
    paths = len(session.heard["path"])
    value["value"]["double_value"] = 0.45
    assert session.call("trajopt/set_parameters_atomically", kind, parameters=[value])["result"]["successful"]
    wait(lambda: len(session.heard["path"]) > paths, "a path with the other clearance")


@pytest.mark.parametrize("kind", ["SetParameters", "SetParametersAtomically"])
def test_a_parameter_that_the_node_has_not_is_named(session, kind):
    service = "set_parameters" + kind.removeprefix("SetParameters").lower().replace("atomically", "_atomically")
    value = {"name": "trajopt.clearence_m", "value": {"type": 3, "double_value": 0.4}}
    said = session.call(f"trajopt/{service}", f"rcl_interfaces/{kind}", parameters=[value])
    result = said["result"] if "result" in said else said["results"][0]
    assert not result["successful"]
    assert result["reason"].startswith("trajopt has no parameter trajopt.clearence_m; ")


def test_playback_is_seen_by_everybody(session, observer):
    wait(lambda: session.heard["path"], "the snapshot")
    assert session.call("play", "std_srvs/SetBool", data=True)["success"]
    wait(lambda: len(session.heard["viewpoint"]) > 5, "viewpoints")
    observer.wait(lambda: len(observer.heard["viewpoint"]) > 5, "viewpoints on the graph")
    seek = session.roslibpy.Topic(session.ros, "/walk/playback/seek", "std_msgs/Float64")
    seek.publish(session.roslibpy.Message({"data": 1e6}))
    states = observer.heard["playback"]
    observer.wait(lambda: states and (s := json.loads(states[-1].data))["t_s"] == s["duration_s"] > 0, "the end")
    assert session.call("play", "std_srvs/SetBool", data=False)["success"]
    end = observer.last("path").poses[-1].pose.position
    observer.wait(lambda: abs(observer.last("viewpoint").pose.position.x - end.x) < 0.05, "the eye at the end")


def test_study_events_reach_the_graph(session, observer):
    topic = session.roslibpy.Topic(session.ros, "/walk/study_events", "diagnostic_msgs/DiagnosticArray")
    topic.publish(session.roslibpy.Message({"status": [{"name": "answer", "message": "SUS 1", "level": 0}]}))
    msg = observer.wait(lambda: observer.last("study_events"), "the event")
    assert msg.status[0].name == "answer"
    assert msg.header.stamp.sec > 0


def test_the_files_are_of_the_building_and_map_of_the_graph(port, observer):
    told = json.loads(read(port, "/building.json"))
    for name in ("vr_bridge", "trajopt"):
        # A node tells its building once a second, so the telling may be behind the file.
        same = lambda name=name: observer.state(name).get("building_hash") == told["hash"]  # noqa: E731
        observer.wait(same, f"{name} to name the same building")
    volume = json.loads(wait(lambda: _quiet(port, "/importance.json"), "the volume"))
    nx, ny, nz = volume["shape"]
    assert len(read(port, volume["url"])) == 4 * nx * ny * nz == volume["bytes"]
    assert nx * ny * nz == observer.last("importance_map").width


def _quiet(port, path):
    try:
        return read(port, path)
    except OSError:
        return None


def test_roslib_drives_a_whole_session(port):
    node = shutil.which("node")
    if node is None or not (WEB / "node_modules" / "roslib").is_dir():
        pytest.skip("node or the npm package roslib is missing: npm ci in src/walk_vr_bridge/web installs it")
    script = Path(__file__).parent / "roslib_session.mjs"
    done = subprocess.run([node, script, str(WEB), str(port)], capture_output=True, text=True, timeout=90)
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout.strip().splitlines()[-1])
    assert told["outcomes"] == ["accepted"] * 3
    assert told["undone"] is True
    assert told["paths"] >= 4


def edit_live(graph, *arguments):
    """Runs the example as a user does, from a folder of their own."""
    command = [sys.executable, str(EXAMPLE), *arguments]
    return subprocess.run(
        command, cwd=graph.folder, env=graph.environment(), capture_output=True, text=True, timeout=2 * LIMIT_S
    )


def test_the_example_of_a_client_moves_a_keypoint(graph, observer, port):
    for _ in range(100):  # what the tests before have said is still on its way
        observer.executor.spin_once(timeout_sec=0.01)
    before = c.keypoint_markers_from_msg(observer.last("keypoint_markers"))
    done = edit_live(graph, f"localhost:{port}")
    assert done.returncode == 0, done.stderr
    assert f"{len(before.ids)} keypoints: " in done.stdout
    # Two paths: the one that there was, and the one after the edit.
    assert done.stdout.count("a path of ") >= 2 and "the move was accepted" in done.stdout
    observer.wait(
        lambda: (
            not np.allclose(
                c.keypoint_markers_from_msg(observer.last("keypoint_markers")).poses.positions, before.poses.positions
            )
        ),
        "the keypoint elsewhere",
    )


@pytest.mark.parametrize(
    ("address", "said"), [("localhost:9", "start one with ./walk up"), ("localhost:x", "expected HOST or HOST:PORT")]
)
def test_the_example_says_what_to_do_where_no_planner_is(graph, address, said):
    done = edit_live(graph, address)
    assert done.returncode == 1
    assert said in done.stderr and "Traceback" not in done.stderr and done.stderr.count("\n") == 1


def test_a_bridge_that_is_told_to_end_ends_with_0(graph, port):
    assert read(port, "/")
    assert graph.interrupt("vr_bridge", signal.SIGTERM) == 0
    log = graph.log("vr_bridge")
    assert "Traceback" not in log
    assert "never" not in log
