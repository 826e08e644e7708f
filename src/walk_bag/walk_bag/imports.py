# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What comes in: rides recorded in bags, and keypoints from tables and JSON."""

from __future__ import annotations

import csv
import dataclasses
import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from walk_bag.errors import BagError, ExportError
from walk_bag.exports.ride import Ride
from walk_bag.storage import read_bag
from walk_building.errors import WalkError
from walk_building.model import LoadOptions
from walk_ros.conversions.checks import finite_array
from walk_ros.conversions.poses import keypoints_from_msg, viewpoint_from_msg
from walk_ros.conversions.trajectories import trajectory_from_msg
from walk_ros.raw import from_bytes
from walk_ros.topics import absolute_name

SOURCES = ("trajectory", "viewpoint")
"""What of a bag can be a ride: what was planned last, and what was looked at."""

# Slower is standing.
_STANDING_MPS = 0.02
_UNIT_TOLERANCE = 1e-3


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class ImportedKeypoints:
    """Keypoints of a file, in the coordinates of the building's file. Arrays are read-only."""

    positions: NDArray[np.float64]  # (K, 3) of the eye [m]
    quat_xyzw: NDArray[np.float64]  # (K, 4); level, along x, where the file does not say
    labels: tuple[str, ...]  # (K,) "" where the file does not say


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
    if not views:
        raise BagError(bag, "holds no viewpoint: nobody played the walk while it was recorded")
    poses = [viewpoint_from_msg(msg) for _, msg in views]
    t_s = np.array([stamp - views[0][0] for stamp, _ in views]) / 1e9
    return t_s, np.vstack([p.positions for p in poses]), np.vstack([p.quat_xyzw for p in poses])


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
    offset_m: NDArray[np.float64] | None = None  # (3,) see Model


def recorded_building(bag: Path | str) -> RecordedBuilding:
    """Returns the building that a plan, or the nodes while they were recorded, told of in a bag's diagnostics.

    Raises:
        BagError: The bag cannot be read, or what it says of the building is not sound.
    """
    told: dict[str, str] = {}
    for message in read_bag(bag, {"/diagnostics"}):
        for status in from_bytes(message.data, message.topic.type_name).status:
            values = {entry.key: entry.value for entry in status.values if entry.value}
            if "building" in values or "building_hash" in values:
                told |= values
    try:
        load = LoadOptions(**json.loads(told["load"])) if "load" in told else None
        offset = finite_array("/diagnostics", "offset_m", [json.loads(told.get("offset_m", "[0, 0, 0]"))], 3)[0]
    except (ValueError, TypeError, WalkError) as error:
        raise BagError(bag, f"what it says of the building cannot be used: {error}") from error
    return RecordedBuilding(
        path=told.get("building", ""),
        hash=told.get("building_hash", ""),
        content_hash=told.get("content_hash", ""),
        load=load,
        offset_m=offset if "offset_m" in told else None,
    )


def read_keypoints(path: Path | str) -> ImportedKeypoints:
    """Returns the keypoints of a CSV or JSON file: eye positions in metres, z up, in the building file's coordinates.

    CSV: a header with `x,y,z` and, if wished, `qx,qy,qz,qw` or `yaw_deg`, and `label`; other columns are passed over.
    JSON: a list, or `{"keypoints": [...]}`, of `[x, y, z]` or of objects with `position` and, if wished, `quat_xyzw`
    or `yaw_deg`, and `label`.

    Raises:
        ExportError: There is no such file, or it says something else; the message says in which row.
    """
    path = Path(path)
    readers = {".csv": _csv_rows, ".json": _json_rows}
    if path.suffix.lower() not in readers:
        raise ExportError(path, "keypoints are read from .csv and .json files")
    try:
        rows = readers[path.suffix.lower()](path, path.read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise ExportError(path, f"cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise ExportError(path, "is not text in UTF-8") from error
    if not rows:
        raise ExportError(path, "holds no keypoint")
    checked = [_checked(path, number, row) for number, row in enumerate(rows, start=1)]
    positions, quats = np.array([c[0] for c in checked]), np.array([c[1] for c in checked])
    positions.setflags(write=False)
    quats.setflags(write=False)
    return ImportedKeypoints(positions=positions, quat_xyzw=quats, labels=tuple(c[2] for c in checked))


def _csv_rows(path: Path, text: str) -> list[dict[str, Any]]:
    table = csv.DictReader(text.splitlines(), skipinitialspace=True)
    names = [name.strip() for name in table.fieldnames or ()]
    missing = [name for name in "xyz" if name not in names]
    if missing:
        raise ExportError(path, f"has no column {missing[0]!r}; the first line names the columns: x,y,z")
    table.fieldnames = names
    rows = []
    for row in table:
        found: dict[str, Any] = {"position": [row[name] for name in "xyz"], "label": row.get("label") or ""}
        if row.get("qx"):
            found["quat_xyzw"] = [row.get(name) for name in ("qx", "qy", "qz", "qw")]
        if row.get("yaw_deg"):
            found["yaw_deg"] = row["yaw_deg"]
        rows.append(found)
    return rows


def _json_rows(path: Path, text: str) -> list[dict[str, Any]]:
    try:
        document = json.loads(text)
    except ValueError as error:
        raise ExportError(path, f"is not JSON: {error}") from error
    rows = document.get("keypoints") if isinstance(document, dict) else document
    if not isinstance(rows, list):
        raise ExportError(path, 'holds no list of keypoints; expected [[x, y, z], …] or {"keypoints": […]}')
    return [row if isinstance(row, dict) else {"position": row} for row in rows]


def _checked(path: Path, number: int, row: dict[str, Any]) -> tuple[list[float], list[float], str]:
    """Returns position, orientation and label of a row."""
    position = _numbers(path, number, "position", row.get("position"), 3)
    if "quat_xyzw" in row:
        quat = _numbers(path, number, "quat_xyzw", row["quat_xyzw"], 4)
        length = float(np.linalg.norm(quat))
        if abs(length - 1.0) > _UNIT_TOLERANCE:
            raise ExportError(path, f"keypoint {number}: quat_xyzw has the length {length:.4g}; expected 1")
        quat = [value / length for value in quat]
    else:
        (yaw_deg,) = _numbers(path, number, "yaw_deg", [row.get("yaw_deg", 0.0)], 1)
        half = np.deg2rad(yaw_deg) / 2
        quat = [0.0, 0.0, float(np.sin(half)), float(np.cos(half))]
    label = row.get("label", "")
    if not isinstance(label, str):
        raise ExportError(path, f"keypoint {number}: label is {label!r}; expected a text")
    return position, quat, label


def _numbers(path: Path, number: int, name: str, values: Any, count: int) -> list[float]:
    wrong = ExportError(path, f"keypoint {number}: {name} is {values!r}; expected {count} finite numbers")
    if not isinstance(values, list) or len(values) != count or any(isinstance(v, bool) for v in values):
        raise wrong
    try:
        numbers = [float(value) for value in values]
    except (TypeError, ValueError):
        raise wrong from None
    if not np.isfinite(numbers).all():
        raise wrong
    return numbers
