# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The 8 digits that are typed in a headset, where nobody wants to type a token."""

from __future__ import annotations

import hmac
import secrets
from collections.abc import Callable

VALID_S = 300.0
TRIES = 5
RENEW_S = 60.0
"""Least time between two codes: at five guesses a minute, half of all codes are tried after 19 years."""


class Pairing:
    """One code at a time: good for one use, five minutes and five tries, whoever makes them."""

    def __init__(self, now_s: Callable[[], float], show: Callable[[str], None]) -> None:
        """Makes and shows the first code.

        Args:
            now_s: A steady clock [s].
            show: Shows a code to who sits at the machine; it must not end up in a log.
        """
        self._now_s = now_s
        self._show = show
        self._made_s = float("-inf")
        self._code = ""
        self.tries_left = 0
        self.renew()

    @property
    def alive(self) -> bool:
        """Whether there is a code that can be used."""
        return bool(self._code) and self.tries_left > 0 and self._now_s() - self._made_s < VALID_S

    def renew(self) -> bool:
        """Makes and shows another code; returns whether enough time had passed."""
        if self._now_s() - self._made_s < RENEW_S:
            return False
        self._code = f"{secrets.randbelow(10**8):08d}"
        self._made_s = self._now_s()
        self.tries_left = TRIES
        self._show(self._code)
        return True

    def use(self, code: str) -> bool:
        """Returns whether this is the code; a right one is used up, a wrong one costs a try."""
        if not self.alive:
            return False
        self.tries_left -= 1
        digits = "".join(c for c in code if c in "0123456789")
        if not hmac.compare_digest(digits.encode(), self._code.encode()):
            return False
        self._code = ""
        return True
