# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The node graph as the web server sees it: raw messages in, messages and service calls out, across two threads."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from walk_ros.node import WalkNode
from walk_vr_bridge.allowed import PUBLISHED, Allowed
from walk_vr_bridge.limits import CALL_TIMEOUT_S
from walk_vr_bridge.operations import OnAnswer
from walk_vr_bridge.wire.message import Message

OnMessage = Callable[[Message], None]

QUICK = ("path", "edit_results", "path_results")
"""What an edit waits for: heard in a thread of its own."""


class Graph:
    """Publishes and calls for clients. Publishing is safe from any thread; answers come in the loop's."""

    def __init__(self, node: WalkNode, allowed: Allowed, loop: asyncio.AbstractEventLoop) -> None:
        self._node = node
        self._loop = loop
        self._allowed = allowed
        self._callers: dict[str, Any] = {}
        node.offer(*PUBLISHED)
        self._publishers = {publisher.topic_name: publisher for publisher in node.publishers}

    def listen(self, short: str, on_message: OnMessage) -> None:
        """Subscribes to a topic of the table; the callback runs in the thread of an executor."""
        full = self._allowed.full(short)
        type_name = self._allowed.heard[full]

        def callback(data: bytes) -> None:
            on_message(Message(full, type_name, bytes(data)))

        self._node.hear(short, callback, raw=True, aside=short in QUICK)

    def publish(self, topic: str, msg: Any) -> None:
        """Publishes a message of a client."""
        self._node.publish(self._allowed.short(topic), msg)

    def is_heard(self, topic: str) -> bool:
        """Returns whether a topic that clients publish on has a subscriber that has been discovered."""
        return self._publishers[topic].get_subscription_count() > 0

    def now_ns(self) -> int:
        """Returns the graph's time [ns]."""
        return int(self._node.get_clock().now().nanoseconds)

    def call(self, service: str, cls: Any, request: Any, done: OnAnswer) -> None:
        """Calls a service; `done` is called once, in the loop's thread, with the answer or the reason for none."""
        caller = self._callers.get(service)
        if caller is None:
            caller = self._callers[service] = self._node.create_client(cls, service)
        self._wait(caller, service, request, done, self._loop.time() + 1.0)

    def _wait(self, caller: Any, service: str, request: Any, done: OnAnswer, until_s: float) -> None:
        """Waits a moment for a service that was asked for the first time, then calls it."""
        if caller.service_is_ready():
            self._send(caller, service, request, done)
        elif self._loop.time() < until_s:
            self._loop.call_later(0.02, self._wait, caller, service, request, done, until_s)
        else:
            done(None, f"nobody offers {service}: its node does not run")

    def _send(self, caller: Any, service: str, request: Any, done: OnAnswer) -> None:
        future = caller.call_async(request)
        open_calls = [done]

        def finish(response: Any, reason: str) -> None:
            if open_calls:
                open_calls.pop()(response, reason)

        def late() -> None:
            caller.remove_pending_request(future)
            finish(None, f"{service} has not answered for {CALL_TIMEOUT_S:g} s")

        timer = self._loop.call_later(CALL_TIMEOUT_S, late)

        def answered(answer: Any) -> None:
            self._in_loop(timer.cancel)
            error = answer.exception()
            if answer.cancelled() or error is not None:
                self._in_loop(finish, None, f"{service} failed: {error or 'cancelled'}")
            else:
                self._in_loop(finish, answer.result(), "")

        future.add_done_callback(answered)

    def _in_loop(self, what: Callable[..., object], *args: Any) -> None:
        if not self._loop.is_closed():
            self._loop.call_soon_threadsafe(what, *args)
