# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""How much a client may ask for, and the buckets that measure it."""

from __future__ import annotations

import dataclasses

MAX_MESSAGE = 256 * 2**10
"""Bytes of an incoming message, put together from its fragments."""

MAX_SUBSCRIPTIONS = 64
MAX_FRAGMENTS = 256
MAX_CLIENTS = 64
MAX_CLIENTS_PER_ADDRESS = 16
SILENCE_S = 20.0
"""A client that takes nothing for this long is closed."""

MAX_ERRORS, ERROR_WINDOW_S = 100, 10.0
MAX_CALLS = 32
"""Service calls of a client that wait for their answers."""

CALL_TIMEOUT_S = 10.0
EDIT_TIMEOUT_S = 10.0
OVERRUN_S = 10.0
"""A client that is above its rate for this long is closed."""


@dataclasses.dataclass(slots=True)
class Bucket:
    """Tokens that fill up at a rate, and how many it holds: that many may be taken at once."""

    rate: float  # tokens a second
    size: float = 0.0  # 0: twice what a second brings
    level: float = -1.0
    at_s: float = 0.0

    def take(self, count: float, now_s: float) -> bool:
        """Takes tokens out; returns whether there were enough."""
        full = self.size or 2 * self.rate
        self.level = full if self.level < 0 else min(full, self.level + (now_s - self.at_s) * self.rate)
        self.at_s = now_s
        if self.level < count:
            return False
        self.level -= count
        return True


class Intake:
    """The rate at which a client sends."""

    def __init__(self) -> None:
        self._messages = Bucket(240.0)
        self._bytes = Bucket(2.0**20)
        self._errors = Bucket(MAX_ERRORS / ERROR_WINDOW_S, size=MAX_ERRORS)
        self._over_since_s = 0.0
        self._last_over_s = float("-inf")
        self._told_s = float("-inf")

    def admits(self, size: int, now_s: float) -> bool:
        """Returns whether a message of this size may come in now."""
        if self._messages.take(1, now_s) and self._bytes.take(size, now_s):
            return True
        if now_s - self._last_over_s > 1.0:
            self._over_since_s = now_s
        self._last_over_s = now_s
        return False

    def too_long(self, now_s: float) -> bool:
        """Returns whether the client has sent too much for too long."""
        return now_s - self._last_over_s < 1.0 and now_s - self._over_since_s > OVERRUN_S

    def may_tell(self, now_s: float) -> bool:
        """Returns whether the client is to be told that it is too fast: once a second."""
        if now_s - self._told_s < 1.0:
            return False
        self._told_s = now_s
        return True

    def too_many_errors(self, now_s: float) -> bool:
        """Counts a message that was wrong; returns whether there were too many."""
        return not self._errors.take(1, now_s)
