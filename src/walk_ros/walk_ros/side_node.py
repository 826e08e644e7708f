# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A hidden node with a thread of its own: for what may wait without keeping its node, and for what must not wait."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import rclpy
from rclpy.executors import ExternalShutdownException, ShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription

_END_S = 2.0


class SideNode:
    """A hidden node beside another one, with an executor and a thread of its own.

    A service that waits for the node's worker belongs here, so that the node hears on meanwhile. (A coroutine would not
    do: this executor asks an unfinished one again and again instead of sleeping.) So does a topic whose messages are to
    be answered at once: an executor looks through all topics, services and timers of its node at every message, in
    Python, and here there is little to look through.
    """

    def __init__(self, node: Node, purpose: str) -> None:
        """Makes the hidden node; services and topics are added, then `start` begins to answer."""
        self._beside = node
        self._node = rclpy.create_node(
            f"_{node.get_name()}_{purpose}",
            context=node.context,
            namespace=node.get_namespace(),
            use_global_arguments=False,
            enable_rosout=False,
            start_parameter_services=False,
        )
        self._executor = SingleThreadedExecutor(context=node.context)
        self._executor.add_node(self._node)
        self._thread = threading.Thread(target=self._spin, name=f"{node.get_name()} {purpose}", daemon=True)

    def offer(self, kind: Any, name: str, callback: Callable[[Any, Any], Any]) -> None:
        """Adds a service under the name that it has at the node beside, remapped as there."""
        self._node.create_service(kind, self._beside.resolve_service_name(name), callback)

    def hear(
        self, kind: Any, name: str, callback: Callable[[Any], None], qos: QoSProfile, *, raw: bool = False
    ) -> Subscription:
        """Subscribes to the topic under the name that it has at the node beside, remapped as there."""
        return self._node.create_subscription(kind, self._beside.resolve_topic_name(name), callback, qos, raw=raw)

    def start(self) -> None:
        """Starts the thread."""
        self._thread.start()

    def stop(self) -> None:
        """Ends the thread and the hidden node."""
        self._executor.shutdown(_END_S)
        if self._thread.ident is not None:
            self._thread.join(_END_S)
        self._node.destroy_node()

    def _spin(self) -> None:
        try:
            self._executor.spin()
        except (ExternalShutdownException, ShutdownException):
            pass
        except RuntimeError:  # of the layers below, where the end comes between two looks at the context
            if self._node.context.ok():
                raise
