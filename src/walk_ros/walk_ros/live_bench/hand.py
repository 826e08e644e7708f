# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The editor of the measurement: publishes edits at a steady rate and notes when what came back."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeVar

import numpy as np
import rclpy
from numpy.typing import NDArray
from rclpy.executors import SingleThreadedExecutor

from walk_building.errors import WalkError
from walk_ros.conversions import (
    Change,
    EditKind,
    EditResult,
    KeypointEdit,
    LabelledKeypoints,
    Outcome,
    edit_result_from_msg,
    edit_to_msg,
    keypoint_markers_from_msg,
)
from walk_ros.diagnostics import diagnostic_values
from walk_ros.live_bench.figures import Sent, Told, replaced_trips
from walk_ros.live_bench.null_node import EDITS, PATH, SAMPLE
from walk_ros.live_bench.paths import path_stamp_ns
from walk_ros.raw import from_bytes
from walk_ros.topics import TOPICS, absolute_name

R = TypeVar("R")
AHEAD = np.array([0.0, 0.0, 0.0, 1.0])


class BenchError(WalkError):
    """A measurement that cannot be taken.

    Attributes:
        reason: Why, and what to do.
    """

    def __init__(self, reason: str) -> None:
        self.reason = reason
        super().__init__(reason)


class Hand:
    """A node of its own in this process, which works only while one of its methods does.

    Attributes:
        sent: Every drag that was published, in order.
        paths: When each path came in, by its stamp.
        raw: The serialised paths that nobody has taken yet, by stamp.
    """

    def __init__(self) -> None:
        rclpy.init()
        self._node = rclpy.create_node("hand")
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)
        self.sent: list[Sent] = []
        self._told: list[bytes] = []
        self._results: deque[tuple[bytes, float]] = deque()  # not read yet
        self._answers: dict[int, tuple[EditResult, float]] = {}
        self.paths: dict[int, float] = {}
        self.raw: dict[int, bytes] = {}
        self.keypoints: LabelledKeypoints | None = None
        self._states: dict[str, dict[str, str]] = {}
        self._copies: dict[int, float] = {}
        self._stamp_ns = time.time_ns()
        self._edits = self._publisher("keypoint_edits")
        self._null_edits = self._publisher("keypoint_edits", EDITS)
        self._sample = self._publisher("path", SAMPLE)
        self._listen("path", self._on_path, raw=True)
        self._listen("path", self._on_copy, PATH, raw=True)
        # As bytes, read afterwards: the hand's own work must not count as the graph's.
        self._listen("path_results", lambda data: self._told.append(bytes(data)), raw=True)
        self._listen("edit_results", lambda data: self._results.append((bytes(data), time.perf_counter())), raw=True)
        self._listen("keypoint_markers", self._on_markers)
        self._listen("/diagnostics", self._on_diagnostics)

    def close(self) -> None:
        """Ends the node."""
        self._executor.shutdown()
        self._node.destroy_node()
        rclpy.try_shutdown()

    def wait(self, condition: Callable[[], R], what: str, limit_s: float, check: Callable[[], None]) -> R:
        """Works until the condition holds and returns what it returned; raises BenchError after the limit."""
        until = time.perf_counter() + limit_s
        while not (result := condition()):
            if time.perf_counter() > until:
                raise BenchError(f"waited {limit_s:g} s for {what} in vain")
            check()
            self._executor.spin_once(timeout_sec=0.05)
        return result

    def ready(self) -> bool:
        """Returns whether the graph hears edits and the null node both kinds of its messages."""
        heard = self._edits.get_subscription_count() >= 2 and self._null_edits.get_subscription_count() >= 1
        return heard and self._sample.get_subscription_count() >= 1

    def state(self, node: str) -> dict[str, str]:
        """Returns the values of a node's last diagnostics."""
        return self._states.get(f"walk/{node}", {})

    def forget(self) -> None:
        """Drops what was sent and heard so far."""
        for kept in (self.sent, self._told, self._results, self._answers, self.paths, self.raw):
            kept.clear()

    def told(self) -> list[Told]:
        """Returns what trajopt said about edits."""
        return [
            Told(
                edit_stamp_ns=result.edit_stamp_ns,
                path_stamp_ns=result.revision_ns,
                refused=result.outcome is Outcome.REFUSED,
                reason=result.reason,
            )
            for result in map(_result, self._told)
        ]

    def answer(self, stamp_ns: int) -> tuple[EditResult, float] | None:
        """Returns the sequencer's answer to an edit and when it came; None where there is none yet."""
        while self._results:
            data, at_s = self._results.popleft()
            result = _result(data)
            self._answers[result.edit_stamp_ns] = result, at_s
        return self._answers.get(stamp_ns)

    def pause(self, seconds: float) -> None:
        """Works for some time without sending anything."""
        until = time.perf_counter() + seconds
        while (left := until - time.perf_counter()) > 0:
            self._executor.spin_once(timeout_sec=left)

    def touch(
        self, kind: EditKind, identity: int, eye: NDArray[np.float64], client: str, change: Change | None = None
    ) -> int:
        """Publishes one edit; returns its stamp."""
        stamp_ns, msg = self._message(kind, identity, eye, client, change)
        if kind is EditKind.RELEASE:
            # What was said about the drags is not read: that would take longer than the answer waited for.
            self._results.clear()
        if kind is EditKind.DRAG:
            self.sent.append(Sent(stamp_ns=stamp_ns, keypoint=identity, at_s=time.perf_counter()))
        self._edits.publish(msg)
        return stamp_ns

    def drag(self, strokes: Sequence[tuple[str, int, NDArray[np.float64]]], rate_hz: float) -> None:
        """Publishes the drags of one or more hands at once, each at the rate.

        Args:
            strokes: Client, identity and eye positions (n, 3) of each hand.
            rate_hz: Edits of a hand a second.
        """
        for at, hand in self._ticks(len(strokes[0][2]), rate_hz * len(strokes), len(strokes)):
            client, identity, eyes = strokes[hand]
            self.touch(EditKind.DRAG, identity, eyes[at], client)

    def null_trips(self, sample: bytes, eye: NDArray[np.float64], count: int, rate_hz: float) -> list[float]:
        """Returns the times from publishing an edit to receiving its copy of the sample path [s]."""
        self._sample.publish(sample)
        self.pause(0.1)
        began: dict[int, float] = {}
        for _ in self._ticks(count, rate_hz, 1):
            stamp_ns, msg = self._message(EditKind.DRAG, 0, eye, "null")
            began[stamp_ns] = time.perf_counter()
            self._null_edits.publish(msg)
        self.pause(0.1)
        trips = replaced_trips(began, self._copies)
        if len(trips) < len(began):
            raise BenchError(f"the last {len(began) - len(trips)} of {count} null messages never came back")
        self._copies.clear()
        return trips

    def _ticks(self, count: int, rate_hz: float, hands: int) -> Iterator[tuple[int, int]]:
        """Yields row and hand at a steady rate, working in between."""
        began = time.perf_counter()
        for tick in range(count * hands):
            while (left := began + tick / rate_hz - time.perf_counter()) > 0:
                self._executor.spin_once(timeout_sec=left)
            yield divmod(tick, hands)

    def _message(
        self, kind: EditKind, identity: int, eye: NDArray[np.float64], client: str, change: Change | None = None
    ) -> tuple[int, Any]:
        self._stamp_ns = max(time.time_ns(), self._stamp_ns + 1)
        edit = KeypointEdit(
            kind=kind,
            keypoint=identity,
            client_id=client,
            stamp_ns=self._stamp_ns,
            position=eye,
            quat_xyzw=AHEAD,
            change=change,
        )
        return self._stamp_ns, edit_to_msg(edit)

    def _publisher(self, topic: str, name: str = "") -> Any:
        return self._node.create_publisher(TOPICS[topic].type, absolute_name(name or topic), TOPICS[topic].qos)

    def _listen(self, topic: str, store: Callable[[Any], None], name: str = "", raw: bool = False) -> None:
        spec = TOPICS[topic]
        self._node.create_subscription(spec.type, absolute_name(name or topic), store, spec.qos, raw=raw)

    def _on_path(self, data: Any) -> None:
        now, data = time.perf_counter(), bytes(data)
        stamp_ns = path_stamp_ns(data)
        self.paths[stamp_ns], self.raw[stamp_ns] = now, data

    def _on_copy(self, data: Any) -> None:
        now = time.perf_counter()
        self._copies[path_stamp_ns(bytes(data))] = now

    def _on_markers(self, msg: Any) -> None:
        self.keypoints = keypoint_markers_from_msg(msg)

    def _on_diagnostics(self, msg: Any) -> None:
        self._states |= {status.name: dict(diagnostic_values(status)) for status in msg.status}


def _result(data: bytes) -> EditResult:
    return edit_result_from_msg(from_bytes(data, "diagnostic_msgs/msg/DiagnosticStatus"))
