# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The walk as a ROS message in YAML, as `ros2 topic echo` shows it and `ros2 topic pub` takes it."""

from __future__ import annotations

from pathlib import Path

import yaml

from walk_bag.exports.motion import motion_of
from walk_bag.exports.ride import ExportConfig, Ride
from walk_building.progress import Progress, no_progress

TYPE = "trajectory_msgs/msg/MultiDOFJointTrajectory"


def write_ros_yaml(
    path: Path,
    ride: Ride,
    config: ExportConfig | None = None,  # noqa: ARG001  (all exporters are called alike)
    progress: Progress = no_progress,
) -> None:
    """Writes a `trajectory_msgs/MultiDOFJointTrajectory` for the joint `eye` in the frame `map`.

    Metres, seconds, z up, in the model's coordinates (near the origin), as the graph publishes them; velocities and
    accelerations are differences of the samples.
    """
    velocities, accelerations = motion_of(ride)
    rows = zip(ride.t_s - ride.t_s[0], ride.positions, ride.quat_xyzw, velocities, accelerations, strict=True)
    points = [
        {
            "transforms": [{"translation": _vector(p), "rotation": _vector(q)}],
            "velocities": [_twist(v)],
            "accelerations": [_twist(a)],
            "time_from_start": dict(zip(("sec", "nanosec"), divmod(round(float(t) * 1e9), 10**9), strict=True)),
        }
        for t, p, q, v, a in rows
    ]
    header = {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": "map"}
    message = {"header": header, "joint_names": ["eye"], "points": points}
    dumper = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
    text = yaml.dump(message, Dumper=dumper, sort_keys=False, default_flow_style=None)
    path.write_text(f"# {TYPE}\n{text}", encoding="utf-8")
    progress("write", 1.0)


def _vector(row: object) -> dict[str, float]:
    return {axis: float(value) for axis, value in zip("xyzw", row, strict=False)}  # type: ignore[call-overload]


def _twist(linear: object) -> dict[str, dict[str, float]]:
    return {"linear": _vector(linear), "angular": {"x": 0.0, "y": 0.0, "z": 0.0}}
