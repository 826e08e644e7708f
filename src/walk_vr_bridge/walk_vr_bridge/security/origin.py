# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a request's Host and Origin must be, and the headers that every answer has."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

CSP = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; font-src 'self'; "
    "connect-src 'self'; worker-src 'self'; manifest-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'; object-src 'none'"
)
"""Only what comes from the bridge; the GLB files need no decoder, so there is no WASM to allow."""

HEADERS: Mapping[str, str] = {
    "Content-Security-Policy": CSP,
    "Cross-Origin-Embedder-Policy": "require-corp",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "xr-spatial-tracking=(self), camera=(), microphone=(), geolocation=()",
    "Referrer-Policy": "no-referrer",
    "Server": "walk",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
}

_HOST = re.compile(r"(?P<name>\[[0-9a-fA-F:.]+\]|[A-Za-z0-9._-]+)(:(?P<port>[0-9]{1,5}))?")


class Hosts:
    """The names under which clients may reach the bridge: others come from a rebound DNS name."""

    def __init__(self, names: Iterable[str]) -> None:
        self._names = frozenset(name.strip().strip("[]").lower() for name in names if name.strip())

    def knows(self, host: str) -> bool:
        """Returns whether a Host header names the bridge; the port may be another one, as behind `adb reverse`."""
        match = _HOST.fullmatch(host)
        return match is not None and match["name"].strip("[]").lower().rstrip(".") in self._names


def same_origin(origin: str | None, host: str, *, tls: bool) -> bool:
    """Returns whether an Origin header, if there is one, is the page that this Host serves."""
    if origin is None:
        return True
    scheme, _, rest = origin.lower().partition("://")
    # A bridge without TLS that is reached by a name of the user's stands behind a proxy that has it.
    local = host.lower().rsplit(":", 1)[0] in ("localhost", "127.0.0.1", "[::1]")
    schemes = ("https",) if tls else ("http",) if local else ("http", "https")
    return scheme in schemes and rest == host.lower()
