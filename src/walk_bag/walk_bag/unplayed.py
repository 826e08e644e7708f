# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What of a bag a replay does not publish, and why, in words."""

from __future__ import annotations

from collections.abc import Mapping

from walk_bag import parameter_watch


def account(published: int, counts: Mapping[str, int], topics: Mapping[str, str], start_s: float) -> str:
    """Returns how many of a bag's messages were published to its end, and which were not.

    Args:
        published: How many were.
        counts: Messages of the bag by topic.
        topics: By topic that was not played, why.
        start_s: Where it began [s].
    """
    whole = sum(counts.values())
    if published == whole:
        return f"published all {whole} messages"
    parts = [f"{counts[name]} on {name} ({why})" for name, why in topics.items() if counts.get(name)]
    before = whole - published - sum(counts.get(name, 0) for name in topics)
    if before > 0:
        parts.append(f"{before} from before {start_s:g} s, which held no longer")
    return f"published {published} of {whole} messages; not {', '.join(parts)}"


def reason(topic: str, type_name: str, installed: bool, chosen: bool) -> str:
    """Returns why a topic is not played; "" if it is."""
    if not chosen:
        return "not among --topics"
    if topic == parameter_watch.TOPIC:
        return "it would speak for nodes that are not there"
    return "" if installed else f"its type, {type_name}, is not installed"
