# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""When each message of a bag is due: the time of the recording, run at another rate, held, or set."""

from __future__ import annotations

import threading
import time


class Pace:
    """Maps the steady clock to the time of a recording; one thread waits, others may hold, seek and end."""

    def __init__(self, rate: float) -> None:
        self._rate = rate
        self._changed = threading.Condition()
        self._ended = False
        self._held = False
        self._sought: int | None = None
        self._origin: tuple[float, int] | None = None  # a steady time [s] and the bag's time then [ns]

    @property
    def ended(self) -> bool:
        """Whether `end` was called."""
        return self._ended

    def rest(self, seconds: float) -> None:
        """Waits, unless ended."""
        with self._changed:
            self._changed.wait_for(lambda: self._ended, seconds)

    def set_out(self, at_ns: int) -> None:
        """Sets the time of the bag to the moment and lets it run."""
        with self._changed:
            self._origin = (time.monotonic(), at_ns)

    def now_ns(self) -> int | None:
        """Returns the time of the bag, None before it has set out."""
        if self._origin is None:
            return None
        since_s, at_ns = self._origin
        return at_ns if self._held else at_ns + round(1e9 * self._rate * (time.monotonic() - since_s))

    def wait_for(self, stamp_ns: int) -> bool:
        """Waits until the bag's time is there; returns whether it came, not whether something else came between."""
        with self._changed:
            while not self._ended and self._sought is None:
                left_s = (stamp_ns - (self.now_ns() or 0)) / 1e9 / self._rate
                if left_s <= 0 and not self._held:
                    return True
                self._changed.wait(None if self._held else left_s)
            return False

    def hold(self, held: bool) -> None:
        """Stops the bag's time, or lets it go on."""
        with self._changed:
            now_ns = self.now_ns()
            self._held = held
            if now_ns is not None:
                self._origin = (time.monotonic(), now_ns)
            self._changed.notify_all()

    def seek(self, at_ns: int) -> None:
        """Ends the waiting, so that the player goes to another moment."""
        with self._changed:
            self._sought = at_ns
            self._changed.notify_all()

    def take_sought(self) -> int | None:
        """Returns the moment that was asked for, once; None if none was."""
        with self._changed:
            sought, self._sought = self._sought, None
            return sought

    def end(self) -> None:
        """Ends all waiting for good."""
        with self._changed:
            self._ended = True
            self._changed.notify_all()
