# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What the measurement prints."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Sequence
from typing import Any

from walk_bag.record_bench.figures import GOAL_RATIO_P99, Round, overhead
from walk_bag.record_bench.recorder import Recorded
from walk_ros.live_bench.figures import summary_ms
from walk_ros.topics import absolute_name

GOAL_SESSION_MB = 50.0
"""Of a session of ten minutes."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Measured:
    """A round; with what its recorder left where there was one."""

    round: Round
    wall_s: float
    bag: Recorded | None = None


def pairs_report(rounds: Sequence[Measured]) -> dict[str, Any]:
    """Returns what recording cost: latencies with and without, and what the recorders wrote."""
    latency = overhead([m.round for m in rounds])
    return {
        "rounds": len(rounds),
        "round_s": [round(m.wall_s, 1) for m in rounds],
        **latency,
        **_edits(rounds),
        "recording": _recording(rounds),
        "cores": os.cpu_count(),
        "goals_met": {"ratio_p99": latency["p99"]["ratio"] <= GOAL_RATIO_P99},
    }


def session_report(session: Measured) -> dict[str, Any]:
    """Returns how large the bag of one session has become, and of what."""
    recording = _recording([session])
    return {
        "session_s": round(session.wall_s, 1),
        "edit_to_path_ms": summary_ms(session.round.latencies_s),
        **_edits([session]),
        "recording": recording,
        "cores": os.cpu_count(),
        "goals_met": {"session_mb": sum(recording["mb"]) <= GOAL_SESSION_MB},
    }


def _edits(rounds: Sequence[Measured]) -> dict[str, Any]:
    answers = [m.round.answers for m in rounds]
    return {
        "edits": {
            "sent": sum(m.round.edits for m in rounds),
            "refused": sum(a.refused for a in answers),
            "superseded": sum(a.superseded for a in answers),
            "lost": sum(a.lost for a in answers),
        }
    }


def _recording(rounds: Sequence[Measured]) -> dict[str, Any]:
    """Returns what the recorders wrote and used; of the first bag what it is made of."""
    bags = [(m, m.bag) for m in rounds if m.bag is not None]
    counts = [bag.counts() for _, bag in bags]
    first = bags[0][1]
    payload = first.payload_bytes()
    return {
        "cpu_share": round(sum(bag.cpu_s for _, bag in bags) / sum(m.wall_s for m, _ in bags), 3),
        "edits": {
            "sent": sum(m.round.edits for m, _ in bags),
            "in_bags": sum(c[absolute_name("keypoint_edits")] for c in counts),
        },
        "paths": {
            "received": sum(m.round.paths for m, _ in bags),
            "in_bags": sum(c[absolute_name("path")] for c in counts),
        },
        "mb": [round(bag.size_bytes / 1e6, 2) for _, bag in bags],
        "messages": sum(counts[0].values()),
        "payload_mb": {name: round(size / 1e6, 2) for name, size in payload.items()},
        "compressed_to": round(first.size_bytes / max(sum(payload.values()), 1), 3),
    }
