# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Tokens and cookies, and the role that each gives."""

from __future__ import annotations

import hashlib
import hmac
import secrets
from collections import OrderedDict
from collections.abc import Callable

SESSION_S = 12 * 3600.0
"""How long a cookie is good: a day of a study."""

MAX_SESSIONS = 256


class Access:
    """Gives roles to tokens and cookies. Secrets are kept as digests and compared in constant time.

    Attributes:
        tokens: The tokens by role, to be shown to the user once.
    """

    def __init__(self, now_s: Callable[[], float]) -> None:
        """Makes the tokens.

        Args:
            now_s: A steady clock [s].
        """
        self._now_s = now_s
        self.tokens = {role: secrets.token_urlsafe(24) for role in ("editor", "viewer")}
        self._sessions: OrderedDict[bytes, tuple[str, float]] = OrderedDict()

    def role_of_token(self, token: str) -> str:
        """Returns the role that a token gives, "" for none."""
        found = ""
        # No way out before the end: the time taken tells nothing.
        for role, known in self.tokens.items():
            if hmac.compare_digest(_digest(known), _digest(token)):
                found = role
        return found

    def open_session(self, role: str) -> str:
        """Returns the value of a cookie that gives the role."""
        value = secrets.token_urlsafe(32)
        self._sessions[_digest(value)] = (role, self._now_s() + SESSION_S)
        while len(self._sessions) > MAX_SESSIONS:
            self._sessions.popitem(last=False)
        return value

    def role_of_session(self, value: str) -> str:
        """Returns the role that a cookie gives, "" for none."""
        # Looked up by its digest: what a guess has in common with a good one shows nowhere.
        role, until_s = self._sessions.get(_digest(value), ("", 0.0))
        return role if self._now_s() < until_s else ""

    def close_session(self, value: str) -> None:
        """Makes a cookie worthless."""
        self._sessions.pop(_digest(value), None)


def _digest(text: str) -> bytes:
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).digest()
