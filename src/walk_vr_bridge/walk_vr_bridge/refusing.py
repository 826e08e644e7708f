# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Who is to be told that a frame was not understood: read from frames that are wrong, so nothing here is relied on."""

from __future__ import annotations

import json
from typing import Any

import orjson

_NS = 10**9


def gist(data: str | bytes) -> dict[str, Any]:
    """Returns what a frame says whose only fault is NaN or Infinity among its numbers; empty for all others.

    Many JSON writers write them as words, which JSON has not; Python's own reader takes them. They are None here.
    """
    words: list[str] = []

    def note(word: str) -> None:
        words.append(word)

    try:
        said = orjson.loads(orjson.dumps(json.loads(data, parse_constant=note)))
    except (ValueError, TypeError, RecursionError):
        return {}
    return said if words and isinstance(said, dict) else {}


def edit_of(said: dict[str, Any]) -> tuple[str, int]:
    """Returns the keypoint and the stamp [ns] of an edit that was not taken; "" and 0 for what it does not say."""
    msg = said.get("msg")
    if not isinstance(msg, dict):
        return "", 0
    keypoint, header = msg.get("marker_name"), msg.get("header")
    stamp = header.get("stamp") if isinstance(header, dict) else None
    values = stamp if isinstance(stamp, dict) else {}
    sec, nanosec = (values.get(name, values.get(old, 0)) for name, old in (("sec", "secs"), ("nanosec", "nsecs")))
    whole = all(type(value) is int and abs(value) < 2**63 for value in (sec, nanosec))
    return keypoint[:80] if isinstance(keypoint, str) else "", sec * _NS + nanosec if whole else 0
