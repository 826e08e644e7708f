# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Keypoints that come in: from tables, JSON and bags."""

from __future__ import annotations

import csv
import dataclasses
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from walk_bag.bag_reader import read_bag
from walk_bag.errors import BagError, ExportError
from walk_bag.imports import recorded_building
from walk_building.building import Building
from walk_ros.conversions.poses import keypoints_from_msg
from walk_ros.raw import from_bytes
from walk_ros.topics import absolute_name

_UNIT_TOLERANCE = 1e-3
_NO_LOOK = [0.0, 0.0, 0.0, 1.0]


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class ImportedKeypoints:
    """Keypoints of a file. Arrays are read-only."""

    source: str  # name of the file
    positions: NDArray[np.float64]  # (K, 3) of the eye [m]
    quat_xyzw: NDArray[np.float64]  # (K, 4); level, along x, where the file does not say
    looks: NDArray[np.bool_]  # (K,) whether the file says where to look
    labels: tuple[str, ...]  # (K,) "" where the file does not say
    of_building: bool = True  # whether positions are in the building file's coordinates, else in the planner's

    def name_of(self, index: int) -> str:
        """Returns what a person would call a keypoint."""
        label = f" ({self.labels[index]})" if self.labels[index] else ""
        return f"keypoint {index + 1}{label} of {self.source}"

    def eyes_in(self, building: Building) -> NDArray[np.float64]:
        """Returns the positions (K, 3) in the planner's coordinates of the building [m]."""
        return building.from_file(self.positions) if self.of_building else self.positions


def read_keypoints(path: Path | str) -> ImportedKeypoints:
    """Returns the keypoints of a CSV or JSON file, or of a bag: eye positions in metres, z up.

    They are in the building file's coordinates; those of a bag that does not tell the offset in the planner's.

    CSV: a header with `x,y,z` and, if wished, `qx,qy,qz,qw` or `yaw_deg`, and `label`; other columns are passed over.
    JSON: a list, or `{"keypoints": [...]}`, of `[x, y, z]` or of objects with `position` and, if wished, `quat_xyzw`
    or `yaw_deg`, and `label`. A bag: its last keypoints, in the order of the tour.

    Raises:
        ExportError: There is no such file, or it says something else; the message says in which row.
        BagError: The bag cannot be read, or holds none.
    """
    path = Path(path)
    readers = {".csv": _csv_rows, ".json": _json_rows}
    if path.is_dir() or path.suffix.lower() == ".mcap":
        return _of_bag(path)
    if path.suffix.lower() not in readers:
        raise ExportError(path, "keypoints are read from .csv and .json files and from bags")
    try:
        rows = readers[path.suffix.lower()](path, path.read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise ExportError(path, f"cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise ExportError(path, "is not text in UTF-8") from error
    if not rows:
        raise ExportError(path, "holds no keypoint")
    checked = [_checked(path, number, row) for number, row in enumerate(rows, start=1)]
    return imported(
        path,
        np.array([position for position, _, _ in checked]),
        np.array([_NO_LOOK if quat is None else quat for _, quat, _ in checked]),
        looks=np.array([quat is not None for _, quat, _ in checked]),
        labels=tuple(label for *_, label in checked),
    )


def imported(
    path: Path,
    positions: NDArray[np.float64],
    quat_xyzw: NDArray[np.float64],
    *,
    looks: NDArray[np.bool_] | None = None,
    labels: tuple[str, ...] = (),
    of_building: bool = True,
) -> ImportedKeypoints:
    """Returns keypoints as they came from a file; without `looks` each has a look, without `labels` none a label."""
    looks = np.ones(len(positions), bool) if looks is None else looks
    for array in (positions, quat_xyzw, looks):
        array.setflags(write=False)
    return ImportedKeypoints(
        source=path.name,
        positions=positions,
        quat_xyzw=quat_xyzw,
        looks=looks,
        labels=labels or ("",) * len(positions),
        of_building=of_building,
    )


def _of_bag(bag: Path) -> ImportedKeypoints:
    topic = absolute_name("keypoints")
    last = None
    for message in read_bag(bag, {topic}):
        last = message
    if last is None:
        raise BagError(bag, f"holds no keypoints on {topic}")
    poses = keypoints_from_msg(from_bytes(last.data, last.topic.type_name))
    if not len(poses.positions):
        raise BagError(bag, "holds a walk without a keypoint")
    offset_m = recorded_building(bag).offset_m
    positions = np.array(poses.positions) if offset_m is None else poses.positions + offset_m
    return imported(bag, positions, np.array(poses.quat_xyzw), of_building=offset_m is not None)


def _csv_rows(path: Path, text: str) -> list[dict[str, Any]]:
    table = csv.DictReader(text.splitlines(), skipinitialspace=True)
    if not table.fieldnames:
        raise ExportError(path, "is empty; its first line names the columns, x,y,z, and every other line is a keypoint")
    names = [name.strip() for name in table.fieldnames]
    missing = [name for name in "xyz" if name not in names]
    if missing:
        first = ",".join(names)
        raise ExportError(
            path, f"has no column {missing[0]!r}: its first line reads {first!r}, and it names the columns: x,y,z"
        )
    table.fieldnames = names
    rows = []
    for row in table:
        line = table.line_num
        # DictReader puts what is beyond the last column under None.
        if any(text.strip() for text in row.pop(None, None) or ()):
            raise ExportError(path, f"line {line} has more values than the {len(names)} columns of the first line")
        found: dict[str, Any] = {"position": [_cell(path, line, name, row) for name in "xyz"]}
        found["label"] = row.get("label") or ""
        if row.get("qx"):
            found["quat_xyzw"] = [_cell(path, line, name, row) for name in ("qx", "qy", "qz", "qw")]
        if row.get("yaw_deg"):
            found["yaw_deg"] = _cell(path, line, "yaw_deg", row)
        rows.append(found)
    return rows


def _cell(path: Path, line: int, name: str, row: Mapping[str, str | None]) -> float:
    """Returns the number of a column in a line of the table."""
    text = (row.get(name) or "").strip()
    if not text:
        raise ExportError(path, f"line {line} has no {name}; expected a number")
    try:
        value = float(text)
    except ValueError:
        value = np.nan
    if not np.isfinite(value):
        raise ExportError(path, f"line {line}: {name} is {text!r}; expected a finite number")
    return value


def _json_rows(path: Path, text: str) -> list[dict[str, Any]]:
    try:
        document = json.loads(text)
    except ValueError as error:
        raise ExportError(path, f"is not JSON: {error}") from error
    rows = document.get("keypoints") if isinstance(document, dict) else document
    if not isinstance(rows, list):
        raise ExportError(path, 'holds no list of keypoints; expected [[x, y, z], …] or {"keypoints": […]}')
    return [row if isinstance(row, dict) else {"position": row} for row in rows]


def _checked(path: Path, number: int, row: dict[str, Any]) -> tuple[list[float], list[float] | None, str]:
    """Returns position, orientation, None where it says none, and label of a row."""
    position = _numbers(path, number, "position", row.get("position"), 3)
    quat: list[float] | None
    if "quat_xyzw" in row:
        quat = _numbers(path, number, "quat_xyzw", row["quat_xyzw"], 4)
        length = float(np.linalg.norm(quat))
        if abs(length - 1.0) > _UNIT_TOLERANCE:
            raise ExportError(path, f"keypoint {number}: quat_xyzw has the length {length:.4g}; expected 1")
        quat = [value / length for value in quat]
    elif "yaw_deg" not in row:
        quat = None
    else:
        (yaw_deg,) = _numbers(path, number, "yaw_deg", [row["yaw_deg"]], 1)
        half = np.deg2rad(yaw_deg) / 2
        quat = [0.0, 0.0, float(np.sin(half)), float(np.cos(half))]
    label = row.get("label", "")
    if not isinstance(label, str):
        raise ExportError(path, f"keypoint {number}: label is {label!r}; expected a text")
    return position, quat, label


def _numbers(path: Path, number: int, name: str, values: Any, count: int) -> list[float]:
    expected = f"expected {count} finite numbers" if count > 1 else "expected a finite number"
    shown = values if count > 1 or not isinstance(values, list) else values[0]
    wrong = ExportError(path, f"keypoint {number}: {name} is {json.dumps(shown, ensure_ascii=False)}; {expected}")
    if values is None:
        wrong = ExportError(path, f"keypoint {number} has no {name}; {expected}")
    if not isinstance(values, list) or len(values) != count or any(isinstance(v, bool) for v in values):
        raise wrong
    try:
        numbers = [float(value) for value in values]
    except (TypeError, ValueError):
        raise wrong from None
    if not np.isfinite(numbers).all():
        raise wrong
    return numbers
