# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The one who listens in the measurement of maps: notes when which of the importance node's topics was heard."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, TypeVar

import rclpy
from rcl_interfaces.srv import SetParameters
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter

from walk_ros.diagnostics import diagnostic_values
from walk_ros.live_bench.hand import BenchError
from walk_ros.runner import use_profiles
from walk_ros.topics import TOPICS, absolute_name

R = TypeVar("R")
MAP, SUGGESTED, STOREYS = "importance_map", "suggested_keypoints", "importance_map/storeys"
LATER_S = 60.0


class Listener:
    """A node of its own in this process that notes when which topic was heard."""

    def __init__(self) -> None:
        use_profiles()
        self._context = rclpy.Context()
        rclpy.init(context=self._context)
        self._node = rclpy.create_node("listener", context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self.heard_s: dict[str, list[float]] = {}
        self._states: dict[str, str] = {}
        for topic in (MAP, SUGGESTED, STOREYS):
            self._listen(topic)
        spec = TOPICS["/diagnostics"]
        self._node.create_subscription(spec.type, "/diagnostics", self._store_state, spec.qos)
        self._client = self._node.create_client(SetParameters, absolute_name("importance/set_parameters"))

    def close(self) -> None:
        """Ends the node."""
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()

    def forget(self) -> None:
        """Drops what was heard so far."""
        for times in self.heard_s.values():
            times.clear()
        self._states.clear()

    def state(self) -> str:
        """Returns the state of the importance node's last diagnostics."""
        return self._states.get("walk/importance", "")

    def wait(self, condition: Callable[[], R], what: str, limit_s: float) -> R:
        """Works until the condition holds and returns what it returned."""
        until = time.perf_counter() + limit_s
        while not (result := condition()):
            if time.perf_counter() > until:
                raise BenchError(f"waited {limit_s:g} s for {what} in vain")
            self._executor.spin_once(timeout_sec=0.05)
        return result

    def pause(self, seconds: float) -> None:
        """Works for some time."""
        until = time.perf_counter() + seconds
        while (left := until - time.perf_counter()) > 0:
            self._executor.spin_once(timeout_sec=left)

    def set_cone(self, radius_m: float) -> float:
        """Sets the cone's radius; returns the seconds from the call to the suggestions it leads to."""
        self.wait(self._client.service_is_ready, "the node's parameters", LATER_S)
        request = SetParameters.Request(
            parameters=[Parameter("keypoints.cone_radius_m", value=radius_m).to_parameter_msg()]
        )
        before = len(self.heard_s[SUGGESTED])
        began = time.perf_counter()
        self._client.call_async(request)
        self.wait(lambda: len(self.heard_s[SUGGESTED]) > before, "suggestions for another cone", LATER_S)
        return self.heard_s[SUGGESTED][-1] - began

    def _listen(self, topic: str) -> None:
        times = self.heard_s.setdefault(topic, [])
        spec = TOPICS[topic]
        self._node.create_subscription(
            spec.type, absolute_name(topic), lambda _data: times.append(time.perf_counter()), spec.qos, raw=True
        )

    def _store_state(self, msg: Any) -> None:
        self._states.update({status.name: diagnostic_values(status).get("state", "") for status in msg.status})
