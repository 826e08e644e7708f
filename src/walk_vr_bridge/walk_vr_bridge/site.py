# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Everything that a running bridge consists of beside the graph: who is let in, what is served, who is connected."""

from __future__ import annotations

import dataclasses
import hashlib
import logging
import re
import secrets
import time
from collections.abc import Callable
from pathlib import Path

from walk_vr_bridge.allowed import Allowed
from walk_vr_bridge.config import BridgeConfig
from walk_vr_bridge.content import Page
from walk_vr_bridge.files import Files
from walk_vr_bridge.hub import Hub
from walk_vr_bridge.operations import GraphLike, Operations
from walk_vr_bridge.security.access import Access
from walk_vr_bridge.security.addresses import LOOPBACK, host_names, lan_addresses
from walk_vr_bridge.security.certificate import Certificate, certificate
from walk_vr_bridge.security.invitation import code_line, invitation
from walk_vr_bridge.security.origin import Hosts
from walk_vr_bridge.security.pairing import Pairing

COOKIE = "walk_session"
_SECRET = re.compile(r"[A-Za-z0-9_-]{16,64}")


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Door:
    """Who is let in."""

    hosts: Hosts
    access: Access
    pairing: Pairing | None  # None on loopback
    tls: Certificate | None  # None on loopback
    addresses: tuple[str, ...]  # of the machine, the one to show first

    @property
    def lan(self) -> bool:
        """Whether other machines are let in, and everybody needs a token."""
        return self.tls is not None

    def role(self, *, token: str = "", cookie: str = "") -> str:
        """Returns the role of a request, "" for none."""
        if not self.lan:
            return "editor"
        return (token and self.access.role_of_token(token)) or (cookie and self.access.role_of_session(cookie)) or ""


class Site:
    """What the web server serves."""

    def __init__(self, allowed: Allowed, files: Files, graph: GraphLike, page: Path) -> None:
        self.files = files
        self.page = Page(page)
        self.hub = Hub(allowed)
        self.operations = Operations(self.hub, graph)


def open_door(config: BridgeConfig, folder: Path, show: Callable[[str], None]) -> Door:
    """Returns who is let in under a config; makes the certificate where it is needed.

    Args:
        config: Of the bridge.
        folder: Where the certificate is kept.
        show: Shows a secret to who sits at the machine.
    """
    further = [name for name in config.hosts.split(",") if name.strip()]
    access = Access(time.monotonic)
    if not config.lan:
        hosts = Hosts([*LOOPBACK, *further])
        return Door(hosts=hosts, access=access, pairing=None, tls=None, addresses=("localhost",))
    addresses = (*lan_addresses(), *host_names())
    names = [*dict.fromkeys([*addresses, *LOOPBACK, *(name.strip() for name in further)])]
    return Door(
        hosts=Hosts(names),
        access=access,
        pairing=Pairing(time.monotonic, lambda code: show(code_line(code))),
        tls=certificate(folder, names),
        addresses=(*addresses, "localhost"),
    )


def welcome(door: Door, port: int) -> str:
    """Returns what the user is shown once the bridge listens; with `lan` it holds secrets."""
    if door.tls is None:
        return f"Page, on this machine: http://localhost:{port} (--lan lets headsets in)\n"

    def address(name: str, role: str) -> str:
        return f"https://{name}:{port}/#token={door.access.tokens[role]}"

    first, *others = door.addresses
    bare = [f"https://{name}:{port}/" for name in others]
    return invitation(address(first, "editor"), bare, address(first, "viewer"), door.tls.fingerprint)


def identity(secret: str | None) -> str:
    """Returns the `client_id` that belongs to the secret of a client, a new one where it names none."""
    text = secret if secret is not None and _SECRET.fullmatch(secret) else secrets.token_urlsafe(24)
    return "web-" + hashlib.sha256(text.encode()).hexdigest()[:12]


def silent_logger() -> logging.Logger:
    """Returns a logger that keeps everything to itself, for the library that serves."""
    # What clients send wrong is theirs to hear, and a request line in a log could hold a token.
    logger = logging.Logger("walk_vr_bridge.http")
    logger.addHandler(logging.NullHandler())
    logger.propagate = False
    return logger
