# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a client or a user of the bridge can do wrong."""

from __future__ import annotations

from typing import Any

from walk_building.errors import WalkError


class ProtocolError(WalkError, ValueError):
    """Something a client said that is not understood; the text is what it is told.

    Attributes:
        reason: What was found and what was expected.
    """

    def __init__(self, reason: str) -> None:
        self.reason = reason
        super().__init__(reason)


class UnreadableError(ProtocolError):
    """A frame that is no JSON object.

    Attributes:
        said: What it seems to say all the same, empty where nothing can be made of it.
    """

    def __init__(self, reason: str, said: dict[str, Any]) -> None:
        self.said = said
        super().__init__(reason)


class NotAllowedError(WalkError):
    """Something a client may not do.

    Attributes:
        what: What it tried.
        reason: Why not.
    """

    def __init__(self, what: str, reason: str) -> None:
        self.what = what
        self.reason = reason
        super().__init__(f"{what}: {reason}")


class PortError(WalkError):
    """A port that cannot be listened on.

    Attributes:
        host: The address.
        port: The port.
    """

    def __init__(self, host: str, port: int, reason: str) -> None:
        self.host = host
        self.port = port
        super().__init__(f"cannot listen on {host}:{port}: {reason}; set another port with -p bridge.port:=NUMBER")
