# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What waits to be sent to one client: bounded, and the newest of each topic wins."""

from __future__ import annotations

import asyncio
from collections import OrderedDict, deque

ANSWERS = 256
"""Answers kept for a client that reads slowly."""

MAX_BYTES = 64 * 2**20
"""Bytes kept for a client that reads slowly: room for the largest importance map, once."""


class Frame:
    """Bytes of one WebSocket frame."""

    __slots__ = ("data", "text")

    def __init__(self, data: bytes, *, text: bool) -> None:
        self.data = data
        self.text = text


class Outbox:
    """A queue per topic, served in turn, so that a large topic does not keep a small one waiting.

    Attributes:
        dropped: How many frames were replaced by newer ones before they were sent.
    """

    def __init__(self) -> None:
        self._queues: OrderedDict[str, deque[Frame]] = OrderedDict()
        self._bytes = 0
        self._filled = asyncio.Event()
        self.dropped = 0

    def put(self, key: str, frame: Frame, depth: int) -> None:
        """Adds a frame; of each key at most `depth` are kept, the newest."""
        queue = self._queues.setdefault(key, deque())
        queue.append(frame)
        self._bytes += len(frame.data)
        while len(queue) > depth:
            self._drop(queue)
        while self._bytes > MAX_BYTES and len(self._queues) + len(queue) > 2:
            self._drop_oldest(keep=frame)
        self._filled.set()

    def answer(self, frame: Frame) -> None:
        """Adds an answer to the client."""
        self.put("", frame, ANSWERS)

    async def get(self) -> Frame:
        """Waits for the next frame and takes it out."""
        while not self._queues:
            self._filled.clear()
            await self._filled.wait()
        key, queue = self._queues.popitem(last=False)
        frame = queue.popleft()
        if queue:
            self._queues[key] = queue
        self._bytes -= len(frame.data)
        return frame

    def forget(self, key: str) -> None:
        """Drops what waits of a key, without counting it."""
        for frame in self._queues.pop(key, ()):
            self._bytes -= len(frame.data)

    def _drop_oldest(self, keep: Frame) -> None:
        for key, queue in list(self._queues.items()):
            if queue[0] is not keep:
                self._drop(queue)
                if not queue:
                    del self._queues[key]
                return

    def _drop(self, queue: deque[Frame]) -> None:
        self._bytes -= len(queue.popleft().data)
        self.dropped += 1
