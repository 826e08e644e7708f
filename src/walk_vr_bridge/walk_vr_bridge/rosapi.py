# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The few questions of rosapi that client libraries ask: answered from the allow-list, not from the graph."""

from __future__ import annotations

import time
from typing import Any

from walk_vr_bridge.allowed import Allowed
from walk_vr_bridge.errors import ProtocolError


def answer_rosapi(service: object, args: Any, allowed: Allowed) -> dict[str, Any] | None:
    """Returns the answer of a service of rosapi; None where it is another service.

    Raises:
        ProtocolError: It is one that is not answered here.
    """
    if not isinstance(service, str) or not service.lstrip("/").startswith("rosapi/"):
        return None
    name = service.rpartition("/")[2]
    topics = allowed.heard | allowed.said
    if name == "topics":
        return {"topics": list(topics), "types": list(topics.values())}
    if name == "services":
        return {"services": list(allowed.services)}
    if name == "topic_type":
        return {"type": topics.get(_first(args, "topic"), "")}
    if name == "service_type":
        known = allowed.services.get(_first(args, "service"))
        return {"type": known.type_name if known else ""}
    if name == "get_time":
        sec, nanosec = divmod(time.time_ns(), 10**9)
        return {"time": {"sec": sec, "nanosec": nanosec}}
    raise ProtocolError(
        f"{service[:80]} is not answered here; topics, services, topic_type, service_type, get_time are"
    )


def _first(args: Any, name: str) -> str:
    value = args.get(name) if isinstance(args, dict) else args[0] if isinstance(args, list) and args else None
    if not isinstance(value, str):
        raise ProtocolError(f"args needs the text {name!r}")
    return value
