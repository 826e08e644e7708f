# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What comes in from bags: rides, and the building that they lead through."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from rclpy.parameter import parameter_value_to_python

from walk_bag.bag_reader import read_bag
from walk_bag.errors import BagError
from walk_bag.exports.ride import Ride
from walk_building.config import Config
from walk_building.errors import WalkError
from walk_building.model import LoadOptions
from walk_building.walker import Walker
from walk_ros.conversions.checks import finite_array
from walk_ros.conversions.poses import keypoints_from_msg, viewpoint_from_msg
from walk_ros.conversions.trajectories import trajectory_from_msg
from walk_ros.raw import from_bytes
from walk_ros.topics import absolute_name

C = TypeVar("C", bound=Config)

SOURCES = ("trajectory", "viewpoint")
"""What of a bag can be a ride: what was planned last, and what was looked at."""

# Slower is standing.
_STANDING_MPS = 0.02
# A camera that has moved less [m], and turned less, was not looked through.
_MOVED = 0.01


def load_ride(bag: Path | str, source: str = "trajectory", namespace: str = "walk") -> Ride:
    """Returns the last trajectory of a bag, or the camera path that its viewpoints are, with the last keypoints.

    Args:
        bag: A rosbag2 directory or a bare file.
        source: One of `SOURCES`.
        namespace: Of the topics.

    Raises:
        BagError: It cannot be read, or holds no such thing.
        MessageError: A message in it is not sound.
    """
    names = {topic: absolute_name(topic, namespace) for topic in ("trajectory", "viewpoint", "keypoints")}
    last: dict[str, Any] = {}
    views: list[tuple[int, Any]] = []
    for message in read_bag(bag, set(names.values())):
        msg = from_bytes(message.data, message.topic.type_name)
        if message.topic.name == names["viewpoint"]:
            views.append((message.stamp_ns, msg))
        elif message.topic.name == names["keypoints"] or msg.points:
            last[message.topic.name] = msg
    if source == "viewpoint":
        t_s, positions, quat = _watched(Path(bag), views)
    elif names["trajectory"] in last:
        received = trajectory_from_msg(last[names["trajectory"]])
        t_s, positions, quat = received.t_s, received.positions, received.quat_xyzw
    else:
        raise BagError(bag, f"holds no trajectory on {names['trajectory']}; is it a recording of a planned walk?")
    keypoints = keypoints_from_msg(last[names["keypoints"]]) if names["keypoints"] in last else None
    keep = np.concatenate([[True], np.diff(t_s) > 0])
    t_s, positions, quat = t_s[keep] - t_s[0], positions[keep], _continuous(quat[keep])
    return Ride(
        t_s=t_s,
        positions=positions,
        quat_xyzw=quat,
        stop=_standing(t_s, positions),
        keypoints=keypoints.positions if keypoints else np.empty((0, 3)),
        keypoint_quat_xyzw=keypoints.quat_xyzw if keypoints else None,
    )


def _watched(
    bag: Path, views: list[tuple[int, Any]]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    poses = [viewpoint_from_msg(msg) for _, msg in views]
    places = np.array([np.concatenate([p.positions[0], p.quat_xyzw[0]]) for p in poses]).reshape(-1, 7)
    if len(views) < 2 or np.ptp(places, axis=0).max() < _MOVED:
        told = "no viewpoint" if not views else "no viewpoint that moves"
        raise BagError(
            bag,
            f"holds {told}: nobody played the walk while it was recorded; what was planned is in it, which "
            "./walk export takes with --from trajectory",
        )
    t_s = np.array([stamp - views[0][0] for stamp, _ in views]) / 1e9
    return t_s, places[:, :3], places[:, 3:]


def _standing(t_s: NDArray[np.float64], positions: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether the walker stands at each sample: neither the step to it nor the step from it leads anywhere."""
    if len(t_s) < 2:
        return np.ones(len(t_s), bool)
    still = np.linalg.norm(np.diff(positions, axis=0), axis=1) / np.diff(t_s) < _STANDING_MPS
    return np.concatenate([[True], still]) & np.concatenate([still, [True]])


def _continuous(quat: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the quaternions with neighbours on the same side of the double cover."""
    flips = np.where(np.einsum("ij,ij->i", quat[1:], quat[:-1]) < 0, -1.0, 1.0)
    return np.asarray(quat * np.concatenate([[1.0], np.cumprod(flips)])[:, None])


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class RecordedBuilding:
    """The building that a bag names; "" and None where it does not say."""

    path: str = ""
    hash: str = ""
    content_hash: str = ""  # of the file and the load options
    load: LoadOptions | None = None
    walker: Walker | None = None
    offset_m: NDArray[np.float64] | None = None  # (3,) see Model


def recorded_building(bag: Path | str) -> RecordedBuilding:
    """Returns the building that a plan, or the nodes while they were recorded, told of in a bag.

    Path and hash come from the diagnostics. So do the load options of a plan; those of nodes are among the parameters.

    Raises:
        BagError: The bag cannot be read, or what it says of the building is not sound.
    """
    told: dict[str, str] = {}
    parameters: dict[str, Any] = {}
    for message in read_bag(bag, {"/diagnostics", "/parameter_events"}):
        msg = from_bytes(message.data, message.topic.type_name)
        if message.topic.name == "/parameter_events":
            parameters |= _values([*msg.new_parameters, *msg.changed_parameters])
            continue
        for status in msg.status:
            values = {entry.key: entry.value for entry in status.values if entry.value}
            if "building" in values or "building_hash" in values:
                told |= values
    try:
        load = LoadOptions(**json.loads(told["load"])) if "load" in told else _config(LoadOptions, "load", parameters)
        walker = _config(Walker, "walker", parameters)
        offset = finite_array("/diagnostics", "offset_m", [json.loads(told.get("offset_m", "[0, 0, 0]"))], 3)[0]
    except (ValueError, TypeError, WalkError) as error:
        raise BagError(bag, f"what it says of the building cannot be used: {error}") from error
    return RecordedBuilding(
        path=told.get("building", ""),
        hash=told.get("building_hash", ""),
        content_hash=told.get("content_hash", ""),
        load=load,
        walker=walker,
        offset_m=offset if "offset_m" in told else None,
    )


def _values(parameters: list[Any]) -> dict[str, Any]:
    return {p.name: parameter_value_to_python(p.value) for p in parameters}


def _config(kind: type[C], group: str, parameters: Mapping[str, Any]) -> C | None:
    """Returns a config that all nodes share, of the parameters by name; None where none of it was told."""
    names = {field.name: f"{group}.{field.name}" for field in dataclasses.fields(kind)}  # type: ignore[arg-type]
    found = {name: parameters[full] for name, full in names.items() if full in parameters}
    return kind(**found) if found else None
