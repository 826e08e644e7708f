# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a node tells about itself at 1 Hz on /diagnostics."""

from __future__ import annotations

import re
import threading
from collections import deque
from collections.abc import Mapping

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from walk_ros.conversions.stamps import stamp_to_msg

LEVELS = {"ok": DiagnosticStatus.OK, "warn": DiagnosticStatus.WARN, "error": DiagnosticStatus.ERROR}
WINDOW = 1000
"""Latencies the percentiles are over: eleven seconds of dragging at 90 edits a second."""


def error_code(error: BaseException) -> str:
    """Returns the code of an error: its class name in snake case, such as `building_error`."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", type(error).__name__).lower()


class Diagnostics:
    """The state of a node; every method may be called from any thread."""

    def __init__(self, name: str) -> None:
        """Starts with the state "starting".

        Args:
            name: Full name of the node, as the status is called.
        """
        self._name = name
        self._lock = threading.Lock()
        self._level = "ok"
        self._message = "starting"
        self._hardware_id = ""
        self._values: dict[str, str] = {"state": "starting", "error_code": "", "dropped_edits": "0"}
        self._latency_s: deque[float] = deque(maxlen=WINDOW)
        self._dropped = 0

    def state(self, state: str, message: str = "", *, level: str = "ok", code: str = "") -> None:
        """Sets the state (one word), the sentence about it, its level (a key of LEVELS) and the error code."""
        with self._lock:
            self._level, self._message = level, message or state
            self._values.update(state=state, error_code=code)

    def building(self, path: str, building_hash: str) -> None:
        """Sets the building that the node works on; "" for a hash says that there is none."""
        with self._lock:
            self._hardware_id = building_hash
            self._values.update(building=path, building_hash=building_hash)

    def note(self, **values: object) -> None:
        """Sets further values, such as `solver_status`."""
        with self._lock:
            self._values.update({key: str(value) for key, value in values.items()})

    def latency(self, seconds: float) -> None:
        """Adds the time from an input to what was published for it."""
        with self._lock:
            self._latency_s.append(seconds)

    def dropped(self, count: int = 1) -> None:
        """Counts edits that were superseded by a later one of the same keypoint before they were worked on."""
        with self._lock:
            self._dropped += count
            self._values["dropped_edits"] = str(self._dropped)

    def to_msg(self, stamp_ns: int) -> DiagnosticArray:
        """Returns the array of the node's one status."""
        with self._lock:
            values = dict(self._values)
            if self._latency_s:
                p50, p99 = np.percentile(self._latency_s, [50, 99])
                values.update(latency_p50_ms=f"{1e3 * p50:.2f}", latency_p99_ms=f"{1e3 * p99:.2f}")
            status = DiagnosticStatus(
                level=LEVELS[self._level],
                name=self._name,
                message=self._message,
                hardware_id=self._hardware_id,
                values=[KeyValue(key=key, value=value) for key, value in sorted(values.items())],
            )
        msg = DiagnosticArray(status=[status])
        msg.header.stamp = stamp_to_msg(stamp_ns)
        return msg


def diagnostic_values(status: DiagnosticStatus) -> Mapping[str, str]:
    """Returns the values of a status by key."""
    return {pair.key: pair.value for pair in status.values}
