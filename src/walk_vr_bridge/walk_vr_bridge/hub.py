# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The last message of each topic, and who gets the next one."""

from __future__ import annotations

from collections.abc import Iterable

from walk_vr_bridge.allowed import LATCHED, OWN, Allowed
from walk_vr_bridge.client import Client
from walk_vr_bridge.wire.message import Message
from walk_vr_bridge.wire.rows import header_stamp_ns

STOREYS = "importance_map/storeys"


class Hub:
    """Hands messages of the graph on to clients; used in the thread of the web server only.

    Attributes:
        clients: All that are connected.
    """

    def __init__(self, allowed: Allowed) -> None:
        self.allowed = allowed
        self.clients: set[Client] = set()
        self._latched = {allowed.full(name) for name in LATCHED}
        self._own = {allowed.full(name) for name in OWN}
        self._storeys = allowed.full(STOREYS)
        self._last: dict[str, list[Message]] = {}

    def publish(self, message: Message) -> None:
        """Keeps the message for those who come later, and offers it to those who listen: who edits is first."""
        topic = message.topic
        if topic in self._own:
            return
        if topic in self._latched:
            self._keep(message)
        for client in sorted(self.clients, key=_looks_on):
            listening = client.listening.get(topic)
            if listening is not None:
                listening.offer(message)

    def snapshot(self, topic: str) -> Iterable[Message]:
        """Returns what a new subscriber of a topic is sent at once."""
        return tuple(self._last.get(topic, ()))

    def last(self, topic: str) -> Message | None:
        """Returns the newest message of a latched topic."""
        kept = self._last.get(topic)
        return kept[-1] if kept else None

    def of(self, identity: str) -> list[Client]:
        """Returns the connections of a client: a page that has just reconnected may have two."""
        return [client for client in self.clients if client.identity == identity]

    def _keep(self, message: Message) -> None:
        kept = self._last.get(message.topic, [])
        # All storeys of a map carry its stamp; the first of a new map ends the old one.
        same_map = (
            message.topic == self._storeys and kept and header_stamp_ns(kept[-1].data) == header_stamp_ns(message.data)
        )
        self._last[message.topic] = [*kept, message] if same_map else [message]


def _looks_on(client: Client) -> bool:
    return not client.edits
