# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The legs of all pairs straight as CDR bytes: 1770 of them take a fifth of a second as Python messages.

The bytes decode to what `pairwise_paths_to_msg` returns; a test holds them to it.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Sequence

import numpy as np
from visualization_msgs.msg import Marker

from walk_ros.conversions.checks import FRAME
from walk_ros.conversions.legs import GREEN, LEGS, NO_WAY, RED, WIDTH_M, WORD_M, LegLike
from walk_ros.conversions.stamps import NS

_LITTLE_ENDIAN = b"\x00\x01\x00\x00"


def pairwise_paths_to_bytes(
    legs: Iterable[LegLike],
    ids: Sequence[int],
    stamp_ns: int,
    no_way: Iterable[tuple[int, int, str]] = (),
) -> bytes:
    """Returns the serialised MarkerArray that `pairwise_paths_to_msg` of the same arguments is."""
    out = bytearray(4)
    _Shape(stamp_ns, "", 0, Marker.DELETEALL, _NO_TURN, (0.0, 0.0, 0.0), (0.0,) * 4).append(out, 0, b"", 0, "")
    count = 1
    lines = _Shape(stamp_ns, LEGS, Marker.LINE_STRIP, Marker.ADD, _NO_TURN, (WIDTH_M, 0.0, 0.0), (*GREEN, 1.0))
    for number, leg in enumerate(legs):
        points = np.ascontiguousarray(leg.points, "<f8")
        text = f"{ids[leg.start]} to {ids[leg.goal]}: {leg.length_m!r} m"
        lines.append(out, number, points.tobytes(), len(points), text)
        count += 1
    words = _Shape(stamp_ns, NO_WAY, Marker.TEXT_VIEW_FACING, Marker.ADD, _NO_TURN, (0.0, 0.0, WORD_M), (*RED, 1.0))
    for number, (start, goal, reason) in enumerate(no_way):
        words.append(out, number, b"", 0, f"{ids[start]} to {ids[goal]}: {reason}")
        count += 1
    struct.pack_into("<I", out, 0, count)
    return _LITTLE_ENDIAN + bytes(out)


_NO_TURN = (0.0, 0.0, 0.0, 1.0)


class _Shape:
    """Markers that differ in number, points and text only. Numbers are aligned to their own size, as CDR has it."""

    def __init__(
        self,
        stamp_ns: int,
        namespace: str,
        kind: int,
        action: int,
        turn: tuple[float, ...],
        scale: tuple[float, float, float],
        colour: tuple[float, ...],
    ) -> None:
        self._header = struct.pack("<iI", stamp_ns // NS, stamp_ns % NS) + _text(FRAME)
        self._namespace = _text(namespace)
        self._kind = struct.pack("<ii", kind, action)
        # Pose, scale, colour, lifetime, whether it is locked to its frame.
        self._body = struct.pack("<7d3d4fiI?", 0.0, 0.0, 0.0, *turn, *scale, *colour, 0, 0, False)
        # No colours, texture (resource; header, format, data) or texture coordinates.
        self._middle = _joined(b"\0" * 4, _text(""), b"\0" * 8, _text(""), _text(""), b"\0" * 4, b"\0" * 4)
        # No mesh: resource, file name, data, materials.
        self._tail = _joined(_text(""), _text(""), b"\0" * 4, b"\0")

    def append(self, out: bytearray, number: int, points: bytes, count: int, text: str) -> None:
        """Appends a marker to a message of which `out` is the part behind the encoding's name."""
        for part in (self._header, self._namespace, struct.pack("<i", number) + self._kind):
            _align(out, 4)
            out += part
        _align(out, 8)
        out += self._body
        _align(out, 4)
        out += struct.pack("<I", count)
        if count:
            _align(out, 8)
            out += points
        for part in (self._middle, _text(text), self._tail):
            _align(out, 4)
            out += part


def _text(text: str) -> bytes:
    raw = text.encode() + b"\0"
    return struct.pack("<I", len(raw)) + raw


def _joined(*parts: bytes) -> bytes:
    """Returns parts that all begin with a number of four bytes, or are the last."""
    out = bytearray()
    for part in parts:
        if len(part) >= 4:
            _align(out, 4)
        out += part
    return bytes(out)


def _align(out: bytearray, size: int) -> None:
    out += b"\0" * (-len(out) % size)
