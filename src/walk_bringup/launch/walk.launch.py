# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The node graph for `ros2 launch walk_bringup walk.launch.py`."""

from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

from launch import LaunchDescription

NODES = {"importance": "walk_importance", "sequencer": "walk_sequencer", "trajopt": "walk_trajopt"}


def generate_launch_description() -> LaunchDescription:
    """Returns the nodes, each with the parameter file and the building."""
    share = FindPackageShare("walk_bringup")
    arguments = [
        DeclareLaunchArgument(
            "building", default_value="", description="Building file; empty for the sample building."
        ),
        DeclareLaunchArgument("namespace", default_value="walk", description="Namespace of the nodes and topics."),
        DeclareLaunchArgument(
            "params_file",
            default_value=PathJoinSubstitution([share, "config", "walk.yaml"]),
            description="YAML of parameters, in the form of config/walk.yaml.",
        ),
        DeclareLaunchArgument("log_level", default_value="info", description="debug, info, warn, error or fatal."),
        DeclareLaunchArgument("use_sim_time", default_value="false", description="Take the time from /clock."),
    ]
    overrides = {
        # A path of digits alone would otherwise be read as a number.
        "building": ParameterValue(LaunchConfiguration("building"), value_type=str),
        "use_sim_time": ParameterValue(LaunchConfiguration("use_sim_time"), value_type=bool),
    }
    nodes = [
        Node(
            package=package,
            executable=name,
            name=name,
            namespace=LaunchConfiguration("namespace"),
            parameters=[LaunchConfiguration("params_file"), overrides],
            arguments=["--ros-args", "--log-level", LaunchConfiguration("log_level")],
            output="screen",
            emulate_tty=True,
        )
        for name, package in NODES.items()
    ]
    return LaunchDescription([*arguments, *nodes])
