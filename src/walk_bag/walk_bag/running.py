# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a running graph holds at this moment: its building, its keypoints, the parameters of its nodes."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import rclpy
from rcl_interfaces.srv import GetParameters, ListParameters
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python

from walk_ros.conversions import (
    KeypointMarks,
    LabelledKeypoints,
    keypoint_markers_from_msg,
    keypoint_marks_from_msg,
)
from walk_ros.diagnostics import diagnostic_values
from walk_ros.runner import use_profiles
from walk_ros.topics import TOPICS, absolute_name

FIND_S = 6.0
"""How long nodes are looked for; on a busy machine they are found after some seconds."""

ALSO_S = 3.0
"""How long the others are looked for, once the sequencer is heard; one that does not run is waited for no longer."""

HEAR_S = 20.0
"""How long what was found may take to answer."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Running:
    """One moment of a running graph."""

    building: str  # path of its file, "" for the sample
    building_hash: str
    keypoints: LabelledKeypoints
    marks: KeypointMarks
    parameters: Mapping[str, Mapping[str, Any]]  # by node and name


class Listener:
    """Asks the nodes of a namespace; made, asked once and closed."""

    def __init__(self, namespace: str) -> None:
        use_profiles()
        self._namespace = "/" + namespace.strip("/")
        self._context = rclpy.Context()
        rclpy.init(context=self._context)
        self._node: Node = rclpy.create_node("project", context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._markers: list[Any] = []
        self._told: dict[str, Mapping[str, str]] = {}
        markers, diagnostics = TOPICS["keypoint_markers"], TOPICS["/diagnostics"]
        topic = absolute_name("keypoint_markers", namespace)
        self._node.create_subscription(markers.type, topic, self._markers.append, markers.qos)
        self._node.create_subscription(diagnostics.type, "/diagnostics", self._hear, diagnostics.qos)

    def close(self) -> None:
        """Ends the node and the middleware."""
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()

    def read(self, nodes: Sequence[str]) -> Running | None:
        """Returns what the graph holds; None where no sequencer runs, or it has no keypoints in time.

        Args:
            nodes: Names of the nodes whose parameters are read; one that does not run is left out.
        """
        own = f"{self._namespace}/sequencer"
        if not self._wait(lambda: own in self._names(), FIND_S):
            return None
        if not self._wait(lambda: bool(self._markers) and bool(self._hash()), HEAR_S):
            return None
        self._wait(lambda: {f"{self._namespace}/{n}" for n in nodes} <= self._names(), ALSO_S)
        parameters = {n: self._parameters(n) for n in nodes if f"{self._namespace}/{n}" in self._names()}
        # What came last meanwhile counts: it is what the journal says too.
        told = self._told[own.strip("/")]
        keypoints = keypoint_markers_from_msg(self._markers[-1])
        if not keypoints.ids:
            return None
        return Running(
            building=told["building"],
            building_hash=told["building_hash"],
            keypoints=keypoints,
            marks=keypoint_marks_from_msg(self._markers[-1]),
            parameters=parameters,
        )

    def _hash(self) -> str:
        return self._told.get(f"{self._namespace}/sequencer".strip("/"), {}).get("building_hash", "")

    def _names(self) -> set[str]:
        pairs = self._node.get_node_names_and_namespaces()
        return {f"{namespace.rstrip('/')}/{name}" for name, namespace in pairs}

    def _hear(self, msg: Any) -> None:
        for status in msg.status:
            self._told[status.name] = diagnostic_values(status)

    def _parameters(self, node: str) -> dict[str, Any]:
        names = list(self._ask(node, ListParameters, "list_parameters", ListParameters.Request()).result.names)
        answer = self._ask(node, GetParameters, "get_parameters", GetParameters.Request(names=names))
        return {n: parameter_value_to_python(value) for n, value in zip(names, answer.values, strict=True)}

    def _ask(self, node: str, kind: Any, service: str, request: Any) -> Any:
        client = self._node.create_client(kind, f"{self._namespace}/{node}/{service}")
        future = None
        if self._wait(client.service_is_ready, HEAR_S):
            future = client.call_async(request)
            self._wait(future.done, HEAR_S)
        self._node.destroy_client(client)
        if future is None or not future.done():
            raise TimeoutError(f"{node} does not tell its parameters")
        return future.result()

    def _wait(self, condition: Callable[[], bool], seconds: float) -> bool:
        until = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > until:
                return False
            self._executor.spin_once(timeout_sec=0.05)
        return True
