# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A client in Python without ROS: moves a keypoint of a running graph through the bridge.

    ./walk up                                   # in one terminal
    ./walk python examples/edit_live.py         # in another; HOST:PORT behind it for a page that is elsewhere

Any rosbridge client can do this from any machine; this one is roslibpy (pip install roslibpy).
"""

import sys
import threading

import roslibpy

MOUSE_UP = 5  # visualization_msgs/InteractiveMarkerFeedback: a release, the edit that is kept

address = sys.argv[1] if len(sys.argv) > 1 else "localhost:8765"
host, _, port = address.partition(":")
if not (port or "8765").isdigit():
    sys.exit(f"{address!r} is no address; expected HOST or HOST:PORT, such as localhost:8765")
ros = roslibpy.Ros(host=host, port=int(port or 8765))
try:
    ros.run(timeout=10)
except roslibpy.core.RosTimeoutError:
    sys.exit(
        f"no planner answers at {address}: start one with ./walk up in another terminal, wait for the address that it "
        "prints, and give that here where it is another: edit_live.py HOST:PORT"
    )

markers: dict = {}
answer: dict = {}
changed, arrived, answered = threading.Event(), threading.Event(), threading.Event()


def on_markers(message: dict) -> None:
    markers.update(message)
    arrived.set()


def on_result(message: dict) -> None:
    answer.update({pair["key"]: pair["value"] for pair in message["values"]}, reason=message["message"])
    answered.set()


roslibpy.Topic(ros, "/walk/keypoint_markers", "visualization_msgs/MarkerArray").subscribe(on_markers)
roslibpy.Topic(ros, "/walk/edit_results", "diagnostic_msgs/DiagnosticStatus").subscribe(on_result)
roslibpy.Topic(ros, "/walk/path", "nav_msgs/Path").subscribe(
    lambda message: (print(f"a path of {len(message['poses'])} poses"), changed.set())
)
if not (arrived.wait(20) and changed.wait(20)):
    sys.exit("no keypoints came: is ./walk up running, and has it planned its first walk?")

keypoints = [m for m in markers["markers"] if m["ns"] == "keypoints" and m["action"] == 0]
print(f"{len(keypoints)} keypoints: {', '.join(m['text'] or str(m['id']) for m in keypoints)}")

changed.clear()
first = keypoints[0]
pose = {**first["pose"], "position": {**first["pose"]["position"], "x": first["pose"]["position"]["x"] + 0.25}}
edit = {"header": {"frame_id": "map"}, "marker_name": str(first["id"]), "event_type": MOUSE_UP, "pose": pose}
roslibpy.Topic(ros, "/walk/keypoint_edits", "visualization_msgs/InteractiveMarkerFeedback").publish(edit)
if answered.wait(10):
    print("the move was accepted" if answer["outcome"] == "accepted" else f"the move was refused: {answer['reason']}")
    changed.wait(10)
ros.terminate()
