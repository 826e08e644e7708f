# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What one client listens to, and how: rosbridge's throttling, queues and compressions."""

from __future__ import annotations

import asyncio
import dataclasses
from collections.abc import Callable

import orjson

from walk_vr_bridge.outbox import Frame
from walk_vr_bridge.wire.message import FORMS, Message


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Wish:
    """One `subscribe` of a client."""

    throttle_s: float = 0.0
    depth: int = 1  # messages kept while the client is slow
    form: str = "none"
    fragment: int = 0  # bytes of a frame, 0 for any size


class Listening:
    """All subscriptions of one client to one topic; each message is sent once, whatever their number.

    As rosbridge does it, the most frequent, the longest queue and the most compact form of all of them hold.
    """

    def __init__(self, topic: str, deliver: Callable[[Listening, Message], None]) -> None:
        """Starts without a subscription.

        Args:
            topic: Full name.
            deliver: Hands a message on to the client, now.
        """
        self.topic = topic
        self.wish = Wish()
        self._deliver = deliver
        self._wishes: dict[str, Wish] = {}
        self._due_s = float("-inf")
        self._held: Message | None = None
        self._timer: asyncio.TimerHandle | None = None

    def __len__(self) -> int:
        return len(self._wishes)

    def add(self, identity: str, wish: Wish) -> None:
        """Adds a subscription, or replaces the one of this id."""
        self._wishes[identity] = wish
        self._merge()

    def remove(self, identity: str | None) -> bool:
        """Removes the subscription of an id, all for None; returns whether none is left."""
        if identity is None:
            self._wishes.clear()
        else:
            self._wishes.pop(identity, None)
        if self._wishes:
            self._merge()
            return False
        self.close()
        return True

    def offer(self, message: Message) -> None:
        """Hands the message on when its time has come; what is held back is replaced by the newest."""
        if self.wish.throttle_s <= 0:
            self._deliver(self, message)
            return
        loop = asyncio.get_running_loop()
        if loop.time() >= self._due_s:
            self._due_s = loop.time() + self.wish.throttle_s
            self._deliver(self, message)
            return
        self._held = message
        if self._timer is None:
            self._timer = loop.call_at(self._due_s, self._release)

    def close(self) -> None:
        """Forgets what is held back."""
        self._held = None
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _release(self) -> None:
        self._timer = None
        message, self._held = self._held, None
        if message is not None:
            self.offer(message)

    def _merge(self) -> None:
        wishes = list(self._wishes.values())
        fragments = [w.fragment for w in wishes if w.fragment]
        self.wish = Wish(
            throttle_s=min(w.throttle_s for w in wishes),
            depth=max(w.depth for w in wishes),
            form=max((w.form for w in wishes), key=FORMS.index),
            fragment=min(fragments, default=0),
        )


def frames_of(message: Message, wish: Wish, number: int) -> list[Frame]:
    """Returns the frames in which a message goes to a client; `number` tells fragmented messages apart."""
    data = message.frame(wish.form)
    if wish.form != "none":
        return [Frame(data, text=False)]
    return text_frames(data, wish.fragment, number)


def text_frames(data: bytes, fragment: int, number: int) -> list[Frame]:
    """Returns a JSON text as one frame, or in fragments of about this many characters."""
    if not fragment or len(data) <= fragment:
        return [Frame(data, text=True)]
    text = data.decode()
    parts = [text[at : at + fragment] for at in range(0, len(text), fragment)]
    head = {"op": "fragment", "id": str(number), "total": len(parts)}
    return [Frame(orjson.dumps({**head, "num": at, "data": part}), text=True) for at, part in enumerate(parts)]
