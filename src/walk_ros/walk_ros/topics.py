# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The table of the walkthrough's topics: what nodes publish, what is recorded, what is documented."""

from __future__ import annotations

import dataclasses
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseArray, PoseStamped
from nav_msgs.msg import OccupancyGrid, Path
from rclpy.qos import QoSProfile
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import Float64, String
from trajectory_msgs.msg import MultiDOFJointTrajectory
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerUpdate, MarkerArray

from walk_ros.qos import best_effort, latched, reliable

NAMESPACE = "walk"
"""Where the relative names below live unless the command line says otherwise."""

STOREY_DEPTH = 64
"""What a subscriber of `importance_map/storeys` keeps; the publisher keeps as many as the building has storeys."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Topic:
    """A topic's type and the profile its publisher offers and its subscribers ask for."""

    type: Any
    qos: QoSProfile


TOPICS: dict[str, Topic] = {
    "importance_map": Topic(type=PointCloud2, qos=latched()),
    "importance_map/storeys": Topic(type=OccupancyGrid, qos=latched(STOREY_DEPTH)),
    "suggested_keypoints": Topic(type=PoseArray, qos=latched()),
    "keypoints": Topic(type=PoseArray, qos=latched()),
    "keypoint_markers": Topic(type=MarkerArray, qos=latched()),
    "pairwise_paths": Topic(type=MarkerArray, qos=latched()),
    "tour": Topic(type=Path, qos=latched()),
    "keypoint_edits": Topic(type=InteractiveMarkerFeedback, qos=reliable()),
    "edit_results": Topic(type=DiagnosticStatus, qos=reliable()),
    "keypoint_editor/update": Topic(type=InteractiveMarkerUpdate, qos=reliable(100)),
    "keypoint_editor/feedback": Topic(type=InteractiveMarkerFeedback, qos=reliable()),
    "path": Topic(type=Path, qos=latched()),
    "path_results": Topic(type=DiagnosticStatus, qos=reliable()),
    "trajectory": Topic(type=MultiDOFJointTrajectory, qos=latched()),
    "viewpoint": Topic(type=PoseStamped, qos=best_effort()),
    "playback": Topic(type=String, qos=latched()),
    "playback/seek": Topic(type=Float64, qos=reliable()),
    "playback/speed": Topic(type=Float64, qos=reliable()),
    "study_events": Topic(type=DiagnosticArray, qos=reliable()),
    "/diagnostics": Topic(type=DiagnosticArray, qos=reliable(10)),
}

BETWEEN_NODES: dict[str, Topic] = {
    "near/requests": Topic(type=InteractiveMarkerFeedback, qos=reliable()),
    "near/refusals": Topic(type=DiagnosticStatus, qos=reliable()),
}
"""What sequencer and importance settle between themselves: clients do not need it, and in a recording it would be said
twice, for it follows from the edits."""


def absolute_name(topic: str, namespace: str = NAMESPACE) -> str:
    """Returns the topic's full name; one that begins with a slash is full already."""
    return topic if topic.startswith("/") else f"/{namespace.strip('/')}/{topic}".replace("//", "/")


def type_name(message_type: Any) -> str:
    """Returns the name of a message class as ROS tools and bags write it, such as `nav_msgs/msg/Path`."""
    return f"{message_type.__module__.split('.')[0]}/msg/{message_type.__name__}"
