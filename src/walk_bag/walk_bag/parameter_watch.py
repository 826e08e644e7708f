# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of the nodes for the record: all of them once, then whatever changes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rcl_interfaces.msg import Parameter, ParameterEvent
from rcl_interfaces.srv import GetParameters, ListParameters
from rclpy.node import Node
from rclpy.qos import qos_profile_parameter_events

from walk_ros.raw import to_bytes
from walk_ros.topics import Topic

TOPIC = "/parameter_events"
SPEC = Topic(type=ParameterEvent, qos=qos_profile_parameter_events)
LOOK_S = 1.0
"""How often new nodes are looked for."""


class ParameterWatch:
    """Asks each node of a namespace for its parameters, once, in the form in which it would announce them."""

    def __init__(self, node: Node, namespace: str, on_event: Callable[[bytes], None]) -> None:
        self._node = node
        self._namespace = "/" + namespace.strip("/")
        self._on_event = on_event
        self._asked: set[str] = set()
        node.create_timer(LOOK_S, self._look)

    def _look(self) -> None:
        for name, namespace in self._node.get_node_names_and_namespaces():
            full = f"{namespace.rstrip('/')}/{name}"
            if namespace == self._namespace and full not in self._asked:
                self._ask(full)

    def _ask(self, full: str) -> None:
        client = self._node.create_client(ListParameters, f"{full}/list_parameters")
        if not client.service_is_ready():
            self._node.destroy_client(client)
            return
        self._asked.add(full)
        client.call_async(ListParameters.Request()).add_done_callback(
            lambda future: self._get(full, client, list(future.result().result.names))
        )

    def _get(self, full: str, used: Any, names: list[str]) -> None:
        self._node.destroy_client(used)
        client = self._node.create_client(GetParameters, f"{full}/get_parameters")
        client.call_async(GetParameters.Request(names=names)).add_done_callback(
            lambda future: self._tell(full, client, names, future.result().values)
        )

    def _tell(self, full: str, used: Any, names: list[str], values: Any) -> None:
        self._node.destroy_client(used)
        event = ParameterEvent(stamp=self._node.get_clock().now().to_msg(), node=full)
        event.new_parameters = [Parameter(name=n, value=v) for n, v in zip(names, values, strict=True)]
        self._on_event(to_bytes(event))
