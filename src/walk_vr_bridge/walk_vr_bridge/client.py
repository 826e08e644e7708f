# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""One client of the WebSocket: its role, what it listens to, what waits for it."""

from __future__ import annotations

import math
import time
from typing import Any

import orjson

from walk_vr_bridge.allowed import EVENTS
from walk_vr_bridge.errors import ProtocolError
from walk_vr_bridge.limits import MAX_SUBSCRIPTIONS, Intake
from walk_vr_bridge.outbox import ANSWERS, Frame, Outbox
from walk_vr_bridge.subscriptions import Listening, Wish, frames_of
from walk_vr_bridge.wire.message import Message, text_frame

LEVELS = ("none", "error", "warning", "info")


class Client:
    """A connection that was let in; used in the thread of the web server only.

    Attributes:
        identity: The `client_id` of its edits.
        role: One of the roles; "" before it has named its token.
        outbox: What waits to be sent.
        intake: The rate at which it sends.
        too_many_errors: Whether it has said too much that is wrong.
        sending_since_s: When the frame on its way now was given to the transport; inf between frames.
        calls: How many of its service calls wait for their answers.
        edits: Whether it has made an edit: it then waits for what the others look at.
    """

    def __init__(self, identity: str, role: str) -> None:
        self.identity = identity
        self.role = role
        self.outbox = Outbox()
        self.intake = Intake()
        self.calls = 0
        self.edits = False
        self.level = "warning"
        self.listening: dict[str, Listening] = {}
        self.fragments: dict[str, dict[int, str]] = {}
        self.too_many_errors = False
        self.sending_since_s = math.inf
        self._sent = 0

    def subscribe(self, topic: str, short: str, identity: str, wish: Wish) -> Listening:
        """Adds a subscription.

        Raises:
            ProtocolError: There are too many.
        """
        if sum(len(listening) for listening in self.listening.values()) >= MAX_SUBSCRIPTIONS:
            raise ProtocolError(f"no more than {MAX_SUBSCRIPTIONS} subscriptions are possible")
        if topic not in self.listening:
            self.listening[topic] = Listening(topic, self.deliver)
        depth = max(wish.depth, EVENTS.get(short, 1))
        self.listening[topic].add(
            identity, Wish(throttle_s=wish.throttle_s, depth=depth, form=wish.form, fragment=wish.fragment)
        )
        return self.listening[topic]

    def unsubscribe(self, topic: str, identity: str | None) -> None:
        """Removes a subscription, or all of the topic for None."""
        listening = self.listening.get(topic)
        if listening is not None and listening.remove(identity):
            del self.listening[topic]
            self.outbox.forget(topic)

    def deliver(self, listening: Listening, message: Message) -> None:
        """Puts a message of a subscription into the outbox."""
        self._sent += 1
        frames = frames_of(message, listening.wish, self._sent)
        for frame in frames:
            self.outbox.put(listening.topic, frame, listening.wish.depth * len(frames))

    def deliver_snapshot(self, listening: Listening, message: Message) -> None:
        """Puts what a new subscriber finds into the outbox, all messages of the topic."""
        self._sent += 1
        for frame in frames_of(message, listening.wish, self._sent):
            self.outbox.put(listening.topic, frame, ANSWERS)

    def deliver_values(self, topic: str, values: Any) -> bool:
        """Puts a message of plain values, for this client alone, into the outbox; False if it does not listen."""
        listening = self.listening.get(topic)
        if listening is None:
            return False
        self.outbox.put(topic, Frame(text_frame(topic, values), text=True), listening.wish.depth)
        return True

    def answer(self, values: dict[str, Any]) -> None:
        """Sends an answer."""
        self.outbox.answer(Frame(orjson.dumps(values), text=True))

    def status(self, level: str, text: str, identity: object = None) -> None:
        """Says what was not understood or not allowed, if the client wants to know."""
        if LEVELS.index(level) <= LEVELS.index(self.level):
            self.answer({"op": "status", "level": level, "msg": text, "id": identity})

    def wrong(self) -> None:
        """Counts something that was not understood or not allowed."""
        self.too_many_errors |= self.intake.too_many_errors(time.monotonic())

    def close(self) -> None:
        """Stops the timers."""
        for listening in self.listening.values():
            listening.close()
        self.listening.clear()
