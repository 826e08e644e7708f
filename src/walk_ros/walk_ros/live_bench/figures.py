# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From what was sent and what came back to figures: which path answers which edit, and how late."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Sent:
    """An edit as it was published."""

    stamp_ns: int  # names it
    keypoint: int
    at_s: float  # steady time just before it was published


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Told:
    """What trajopt said about an edit that it has worked on."""

    edit_stamp_ns: int
    path_stamp_ns: int  # of the path that shows it; of a refusal the path that stays
    refused: bool
    reason: str = ""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Answers:
    """What became of the edits."""

    latency_s: tuple[float, ...]  # of each edit that a path answers
    superseded: int  # of those, edits answered by the path of a later edit of the same keypoint
    refused: int
    lost: int  # neither: there is no path with it or a later one, and no refusal
    reasons: tuple[str, ...]  # of refusals, each once


def match(sent: Sequence[Sent], told: Sequence[Told], paths: Mapping[int, float]) -> Answers:
    """Returns what became of each edit.

    An edit is answered by the first path that shows it, or that shows a later edit of the same keypoint where it was
    superseded: its own wait then ends with that path too, and counts in full.

    Args:
        sent: In the order they were published.
        told: In any order.
        paths: When each path came in, by its stamp; one that was named but never came answers with the next that did.
    """
    by_edit = {t.edit_stamp_ns: t for t in told}
    latency, superseded, refused = [], 0, 0
    reasons: dict[str, None] = {}
    waiting: dict[int, list[Sent]] = {}
    for edit in sent:
        waiting.setdefault(edit.keypoint, []).append(edit)
        answer = by_edit.get(edit.stamp_ns)
        # Of a path only the newest is kept for its reader: where the next one came first, that one shows the edit.
        if answer is None or not (answer.refused or answer.path_stamp_ns in paths):
            continue
        answered = waiting.pop(edit.keypoint)
        if answer.refused:
            refused += len(answered)
            reasons[answer.reason] = None
        else:
            latency += [paths[answer.path_stamp_ns] - e.at_s for e in answered]
            superseded += len(answered) - 1
    lost = sum(map(len, waiting.values()))
    return Answers(latency_s=tuple(latency), superseded=superseded, refused=refused, lost=lost, reasons=tuple(reasons))


def replaced_trips(began: Mapping[int, float], came: Mapping[int, float]) -> list[float]:
    """Returns the round trips [s] of messages by stamp; where a later copy has replaced the copy, until that came.

    Of a path only the newest counts, so the middleware may leave out the one before; an edit that is superseded waits
    in the same way. The last ones have no trip where no copy came at all.
    """
    trips: list[float] = []
    arrival = None
    for stamp in sorted(began, reverse=True):
        arrival = came.get(stamp, arrival)
        if arrival is not None:
            trips.append(arrival - began[stamp])
    return trips[::-1]


def summary_ms(seconds: Sequence[float]) -> dict[str, float]:
    """Returns count, median, 99th percentile and maximum [ms]; only the count where there is nothing."""
    if not len(seconds):
        return {"count": 0}
    p50, p99, most = np.percentile(np.asarray(seconds) * 1e3, [50, 99, 100]).tolist()
    return {"count": len(seconds), "p50": round(p50, 3), "p99": round(p99, 3), "max": round(most, 3)}


def ratios(ours: Mapping[str, float], null: Mapping[str, float]) -> dict[str, float]:
    """Returns how many null round trips an answer takes, for the median and the 99th percentile."""
    return {key: round(ours[key] / null[key], 2) for key in ("p50", "p99") if key in ours and null.get(key)}


def verdict(report: Mapping[str, Any], goals: Mapping[str, float]) -> dict[str, bool]:
    """Returns which of the goals, given by name as upper limits, a flat report keeps; what is missing is not kept."""
    return {name: name in report and report[name] <= limit for name, limit in goals.items()}
