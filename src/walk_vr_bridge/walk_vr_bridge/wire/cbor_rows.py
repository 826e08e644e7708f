# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Paths and trajectories as CBOR: rows of a fixed stride, which numpy writes at once.

A row's names, and the heads of its numbers, are the same bytes in every row where whole numbers take four bytes and
others eight, which CBOR allows (RFC 8949). Encoding row by row takes fifteen times as long.
"""

from __future__ import annotations

import dataclasses
import functools
from typing import Any

import cbor2
import numpy as np
from numpy.typing import NDArray

from walk_vr_bridge.wire.rows import header_stamp_ns, path_rows, trajectory_rows

_NS = 10**9
_TWIST = ("linear", "angular")


@dataclasses.dataclass(frozen=True, slots=True)
class _Slot:
    """Where a number of a row goes: column `at` of the field `name`."""

    name: str
    at: int = -1  # -1: the field is a single whole number


def _places(name: str, start: int, axes: str) -> dict[str, _Slot]:
    return {axis: _Slot(name, start + k) for k, axis in enumerate(axes)}


_TIME = {"sec": _Slot("sec"), "nanosec": _Slot("nanosec")}
_POSE = {
    "header": {"stamp": _TIME, "frame_id": "map"},
    "pose": {"position": _places("pose", 0, "xyz"), "orientation": _places("pose", 3, "xyzw")},
}
_POINT = {
    "transforms": [{"translation": _places("transform", 0, "xyz"), "rotation": _places("transform", 3, "xyzw")}],
    "velocities": [{part: _places("velocity", 3 * k, "xyz") for k, part in enumerate(_TWIST)}],
    "accelerations": [{part: _places("acceleration", 3 * k, "xyz") for k, part in enumerate(_TWIST)}],
    "time_from_start": _TIME,
}


class _Template:
    """A row's bytes, and where its numbers stand in them."""

    def __init__(self, row: Any) -> None:
        self._bytes = bytearray()
        self._slots: list[tuple[_Slot, int]] = []
        self._add(row)

    def _add(self, value: Any) -> None:
        if isinstance(value, _Slot):
            self._bytes += b"\x1a" if value.at < 0 else b"\xfb"
            self._slots.append((value, len(self._bytes)))
            self._bytes += bytes(4 if value.at < 0 else 8)
        elif isinstance(value, dict):
            self._bytes.append(0xA0 + len(value))
            for name, item in value.items():
                self._bytes += cbor2.dumps(name)
                self._add(item)
        elif isinstance(value, list):
            self._bytes += _list_head(len(value))
            for item in value:
                self._add(item)
        else:
            self._bytes += cbor2.dumps(value)

    def fill(self, rows: NDArray[np.void]) -> bytes:
        """Returns the rows as the items of a list."""
        names = [f"{slot.name}{slot.at}" for slot, _ in self._slots]
        kinds = [">u4" if slot.at < 0 else ">f8" for slot, _ in self._slots]
        offsets = [at for _, at in self._slots]
        dtype = np.dtype({"names": names, "formats": kinds, "offsets": offsets, "itemsize": len(self._bytes)})
        filled = np.frombuffer(bytes(self._bytes) * len(rows), np.uint8).copy()
        view = filled.view(dtype)
        for (slot, _), name in zip(self._slots, names, strict=True):
            view[name] = rows[slot.name] if slot.at < 0 else rows[slot.name][:, slot.at]
        return filled.tobytes()


@functools.cache
def _template(kind: str) -> _Template:
    return _Template(_POSE if kind == "pose" else _POINT)


def _list_head(count: int) -> bytes:
    return bytes([0x80 + count]) if count < 24 else b"\x9a" + count.to_bytes(4, "big")


def _encode(kind: str, head: dict[str, Any], name: str, rows: NDArray[np.void] | None) -> bytes | None:
    """Returns a message of these fields whose last one, `name`, is the list of rows; None where times are below 0."""
    if rows is None or (rows["sec"] < 0).any():
        return None
    fields = b"".join(cbor2.dumps(key) + cbor2.dumps(value) for key, value in head.items())
    items = _template(kind).fill(rows) if len(rows) else b""
    return bytes([0xA1 + len(head)]) + fields + cbor2.dumps(name) + _list_head(len(rows)) + items


def _header(data: bytes) -> dict[str, Any]:
    sec, nanosec = divmod(header_stamp_ns(data), _NS)
    return {"stamp": {"sec": sec, "nanosec": nanosec}, "frame_id": "map"}


def path_to_cbor(data: bytes) -> bytes | None:
    """Returns a serialised nav_msgs/Path as CBOR; None where its rows have no fixed stride."""
    rows = path_rows(data)
    return None if rows is None else _encode("pose", {"header": _header(data)}, "poses", rows)


def trajectory_to_cbor(data: bytes) -> bytes | None:
    """Returns a serialised MultiDOFJointTrajectory as CBOR; None where its rows have no fixed stride."""
    rows = trajectory_rows(data)
    if rows is None:
        return None
    return _encode("point", {"header": _header(data), "joint_names": ["eye"]}, "points", rows)
