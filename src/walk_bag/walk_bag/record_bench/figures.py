# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From the edits of recorded and unrecorded rounds to figures."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np

from walk_ros.live_bench.figures import Answers, summary_ms

GOAL_RATIO_P99 = 1.05
"""Of the 99th percentile of edits with a recorder to that without."""

_DRAWS = 2000


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Round:
    """Some seconds of editing."""

    recorded: bool
    strokes_s: tuple[tuple[float, ...], ...]  # latencies of each stroke's edits, in the order of the strokes
    answers: Answers
    edits: int  # sent, with grabs and releases
    paths: int  # that came

    @property
    def latencies_s(self) -> list[float]:
        """Returns the latencies of all edits."""
        return [latency for stroke in self.strokes_s for latency in stroke]


def overhead(rounds: Sequence[Round]) -> dict[str, Any]:
    """Returns the latencies with and without a recorder, their ratios, and how sure those are.

    Rounds come in pairs of one recorded and one not; all make the same moves. `ratio` is of all edits; `ratio_95` its
    interval by drawing strokes anew, since edits of one stroke are alike; `ratio_of_pairs` is pair by pair.
    `noise` is the same ratio between the even and the odd unrecorded rounds, where there are two: what two
    measurements of the same differ by.
    """
    plain = [r for r in rounds if not r.recorded]
    recorded = [r for r in rounds if r.recorded]
    both = {"without": summary_ms(_all(plain)), "with": summary_ms(_all(recorded))}
    found: dict[str, Any] = {"edit_to_path_ms": both}
    for key, percent in (("p50", 50.0), ("p99", 99.0)):
        pairs = [_ratio([a], [b], percent) for a, b in zip(recorded, plain, strict=True)]
        found[key] = {
            "ratio": round(_ratio(recorded, plain, percent), 4),
            "ratio_95": _interval(recorded, plain, percent),
            "ratio_of_pairs": [round(p, 4) for p in pairs],
            "noise": round(_ratio(plain[::2], plain[1::2], percent), 4) if len(plain) > 1 else None,
        }
    return found


def _all(rounds: Sequence[Round]) -> list[float]:
    return [latency for one in rounds for latency in one.latencies_s]


def _ratio(above: Sequence[Round], below: Sequence[Round], percent: float) -> float:
    return float(np.percentile(_all(above), percent) / np.percentile(_all(below), percent))


def _interval(above: Sequence[Round], below: Sequence[Round], percent: float) -> list[float]:
    """Returns the middle 95 % of the ratio when strokes are drawn anew, with replacement."""
    dice = np.random.default_rng(0)
    tops, bottoms = (_drawn(rounds, percent, dice) for rounds in (above, below))
    return [round(v, 4) for v in np.percentile(tops / bottoms, [2.5, 97.5]).tolist()]


def _drawn(rounds: Sequence[Round], percent: float, dice: np.random.Generator) -> Any:
    strokes = [np.array(stroke) for one in rounds for stroke in one.strokes_s]
    draws = dice.integers(0, len(strokes), (_DRAWS, len(strokes)))
    return np.array([np.percentile(np.concatenate([strokes[i] for i in draw]), percent) for draw in draws])
