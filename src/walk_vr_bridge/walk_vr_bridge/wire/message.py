# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A message on its way to clients: converted once for each form that somebody asks for."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import cbor2
import orjson

from walk_ros.raw import from_bytes
from walk_vr_bridge.wire.cbor_rows import path_to_cbor, trajectory_to_cbor
from walk_vr_bridge.wire.encoding import encoder
from walk_vr_bridge.wire.rows import path_to_dict, trajectory_to_dict
from walk_vr_bridge.wire.schema import message_class

FORMS = ("none", "cbor", "cbor-raw")
"""The compressions of rosbridge v2 that are known here."""

_FROM_BYTES: dict[str, Callable[[bytes], dict[str, Any] | None]] = {
    "nav_msgs/Path": path_to_dict,
    "trajectory_msgs/MultiDOFJointTrajectory": trajectory_to_dict,
}
"""Ways around the message class for those that an edit waits for."""

_CBOR_FROM_BYTES: dict[str, Callable[[bytes], bytes | None]] = {
    "nav_msgs/Path": path_to_cbor,
    "trajectory_msgs/MultiDOFJointTrajectory": trajectory_to_cbor,
}


class Message:
    """A message of a topic.

    Attributes:
        topic: Full name.
        type_name: As pkg/Type.
        data: The CDR bytes.
    """

    __slots__ = ("_frames", "_received_ns", "data", "topic", "type_name")

    def __init__(self, topic: str, type_name: str, data: bytes) -> None:
        self.topic = topic
        self.type_name = type_name
        self.data = data
        self._received_ns = time.time_ns()
        self._frames: dict[str, bytes] = {}

    @property
    def size(self) -> int:
        """How large it is, before any conversion [bytes]."""
        return len(self.data)

    def values(self, form: str = "json") -> dict[str, Any]:
        """Returns the message as plain values, in the form "json" or "cbor"."""
        quick = _FROM_BYTES.get(self.type_name)
        values = quick(self.data) if quick is not None else None
        if values is not None:
            return values
        cls = message_class(self.type_name)
        return encoder(cls, form)(from_bytes(self.data, self.type_name))

    def frame(self, form: str) -> bytes:
        """Returns the whole frame in one of FORMS: a JSON text for "none", binary otherwise."""
        if form not in self._frames:
            self._frames[form] = self._make(form)
        return self._frames[form]

    def _make(self, form: str) -> bytes:
        if form == "none":
            return text_frame(self.topic, self.values())
        if form == "cbor":
            quick = _CBOR_FROM_BYTES.get(self.type_name)
            body = quick(self.data) if quick is not None else None
            return _cbor_frame(self.topic, cbor2.dumps(self.values("cbor")) if body is None else body)
        secs, nsecs = divmod(self._received_ns, 10**9)
        raw = {"secs": secs, "nsecs": nsecs, "bytes": self.data}
        return _cbor_frame(self.topic, cbor2.dumps(raw))


def _cbor_frame(topic: str, body: bytes) -> bytes:
    """Returns the CBOR frame of a message that is encoded already: a map of three."""
    return b"\xa3" + b"".join(map(cbor2.dumps, ("op", "publish", "topic", topic, "msg"))) + body


def text_frame(topic: str, values: Any) -> bytes:
    """Returns the JSON frame of a message of plain values."""
    return b'{"op":"publish","topic":%b,"msg":%b}' % (orjson.dumps(topic), orjson.dumps(values))
