# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a client is told who wants to be let in: the answers of `/api`, and why a request is not even looked at."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

from walk_vr_bridge.security.origin import same_origin
from walk_vr_bridge.site import Door

_MOST = 200
"""Characters of a token or a code that are looked at; none is longer."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Reply:
    """An answer, and the role that a cookie is to give."""

    status: int
    body: dict[str, Any]
    let_in: str = ""


def refusal(reason: str, status: int) -> Reply:
    """Returns an answer that says why not."""
    return Reply(status=status, body={"error": reason})


def pair(door: Door, body: dict[str, Any]) -> Reply:
    """Returns the answer to a code, or to the wish for another one."""
    pairing = door.pairing
    if pairing is None:
        return Reply(status=200, body={"role": "editor"})
    if body.get("renew") is True:
        if pairing.alive or pairing.renew():
            return Reply(status=200, body={"renewed": True})
        return refusal("a new code is shown once a minute at most", 429)
    if not pairing.alive:
        return refusal("the code is used or too old; ask for a new one", 410)
    if pairing.use(str(body.get("code", ""))[:_MOST]):
        return Reply(status=200, body={"role": "editor"}, let_in="editor")
    return Reply(status=403, body={"error": "this is not the code", "tries_left": pairing.tries_left})


def log_in(door: Door, body: dict[str, Any]) -> Reply:
    """Returns the answer to a token."""
    if not door.lan:
        return Reply(status=200, body={"role": "editor"})
    role = door.role(token=str(body.get("token", ""))[:_MOST])
    if role:
        return Reply(status=200, body={"role": role}, let_in=role)
    return refusal("the token is not of this bridge, or of an earlier start", 403)


def objection(door: Door, hosts: Sequence[str], origins: Sequence[str], site: str, path: str) -> Reply | None:
    """Returns why a request is not even looked at, None if it is.

    Args:
        door: Who is let in.
        hosts: The request's `Host` headers.
        origins: Its `Origin` headers.
        site: Its `Sec-Fetch-Site`, "" for none.
        path: What it asks for.
    """
    if len(hosts) != 1 or not door.hosts.knows(hosts[0]):
        return refusal("this bridge is not known by that name; -p bridge.hosts:=NAME adds one", 421)
    foreign = len(origins) > 1 or not same_origin(origins[0] if origins else None, hosts[0], tls=door.lan)
    # A link to the page may stand anywhere; whatever else is asked for from elsewhere is not.
    if foreign or (site == "cross-site" and path != "/"):
        return refusal("another page may not use this bridge", 403)
    return None
