# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The node graph for `ros2 launch walk_bringup walk.launch.py`."""

import time

from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

from launch import LaunchContext, LaunchDescription

NODES = {
    "importance": "walk_importance",
    "sequencer": "walk_sequencer",
    "trajopt": "walk_trajopt",
    "vr_bridge": "walk_vr_bridge",
}
PLACE = ("x", "y", "z", "yaw", "pitch", "roll")


def generate_launch_description() -> LaunchDescription:
    """Returns the nodes, each with the parameter file and the building."""
    share = FindPackageShare("walk_bringup")
    arguments = [
        DeclareLaunchArgument(
            "building", default_value="", description="Building file; empty for the sample building."
        ),
        DeclareLaunchArgument(
            "keypoints_file", default_value="", description="CSV, JSON or bag of keypoints to begin with; empty: none."
        ),
        DeclareLaunchArgument("namespace", default_value="walk", description="Namespace of the nodes and topics."),
        DeclareLaunchArgument(
            "params_file",
            default_value=PathJoinSubstitution([share, "config", "walk.yaml"]),
            description="YAML of parameters, in the form of config/walk.yaml.",
        ),
        DeclareLaunchArgument("log_level", default_value="info", description="debug, info, warn, error or fatal."),
        DeclareLaunchArgument("use_sim_time", default_value="false", description="Take the time from /clock."),
        DeclareLaunchArgument(
            "respawn", default_value="true", description="Start a node again that died; it picks up where it was."
        ),
        DeclareLaunchArgument("port", default_value="8765", description="Port of the headset page."),
        DeclareLaunchArgument("lan", default_value="false", description="Let other machines in, with TLS and a token."),
        DeclareLaunchArgument(
            "viewer_port", default_value="", description="Port that Foxglove may connect to; empty: none."
        ),
        DeclareLaunchArgument(
            "parent_frame", default_value="", description="Frame of the world that the building stands in; empty: none."
        ),
        DeclareLaunchArgument(
            "pose",
            default_value="0 0 0 0 0 0",
            description="Where the frame map is in parent_frame: x y z [m] yaw pitch roll [rad].",
        ),
    ]
    return LaunchDescription([*arguments, *(OpaqueFunction(function=made) for made in (_nodes, _viewer, _transform))])


def _nodes(context: LaunchContext) -> list[Node]:
    """Returns the planner's nodes."""
    overrides = {
        # A path of digits alone would otherwise be read as a number.
        "building": ParameterValue(LaunchConfiguration("building"), value_type=str),
        "use_sim_time": ParameterValue(LaunchConfiguration("use_sim_time"), value_type=bool),
    }
    bridge = {
        "bridge.port": ParameterValue(LaunchConfiguration("port"), value_type=int),
        "bridge.lan": ParameterValue(LaunchConfiguration("lan"), value_type=bool),
    }
    own = {"importance": [], "sequencer": [], "vr_bridge": [bridge]}
    file = LaunchConfiguration("keypoints_file").perform(context)
    if file:
        # They begin a session, but a sequencer that is started again within it goes on where it was.
        own["importance"] = [{"keypoints_file": ParameterValue(file, value_type=str)}]
        own["sequencer"] = [{"editing.restore": False, "editing.session_start_s": time.time()}]
    return [
        Node(
            package=package,
            executable=name,
            name=name,
            namespace=LaunchConfiguration("namespace"),
            parameters=[LaunchConfiguration("params_file"), overrides, *own.get(name, [])],
            respawn=LaunchConfiguration("respawn"),
            respawn_delay=1.0,
            arguments=["--ros-args", "--log-level", LaunchConfiguration("log_level")],
            output="screen",
            emulate_tty=True,
        )
        for name, package in NODES.items()
    ]


def _viewer(context: LaunchContext) -> list[Node]:
    """Returns the server for Foxglove, none where no port is named."""
    port = LaunchConfiguration("viewer_port").perform(context)
    if not port:
        return []
    return [
        Node(
            package="walk_bag",
            executable="viewer",
            name="viewer",
            namespace=LaunchConfiguration("namespace"),
            parameters=[{"viewer_port": int(port)}],
            output="screen",
        )
    ]


def _transform(context: LaunchContext) -> list[Node]:
    """Returns the publisher of where the building stands in a larger world, none where there is no such world."""
    parent = LaunchConfiguration("parent_frame").perform(context)
    if not parent:
        return []
    numbers = LaunchConfiguration("pose").perform(context).split()
    if len(numbers) != len(PLACE):
        raise ValueError(f"pose:='{' '.join(numbers)}' must have six numbers: {' '.join(PLACE)}")
    placed = [part for name, number in zip(PLACE, numbers, strict=True) for part in (f"--{name}", number)]
    return [
        Node(
            package="tf2_ros",
            executable="static_transform_publisher",
            arguments=[*placed, "--frame-id", parent, "--child-frame-id", "map"],
        )
    ]
