# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What is measured, and what has been seen of it so far."""

from __future__ import annotations

import dataclasses


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """What is measured."""

    building: str  # path; empty for the sample building
    seconds: float = 10.0  # of dragging
    points: int = 100  # that are optimised
    rate_hz: float = 90.0  # edits of each hand a second
    hands: int = 1  # editors that drag at once, each a keypoint of its own
    stroke_s: float = 3.0  # from grab to release
    speed_mps: float = 0.6  # of a hand, on average
    seed: int = 1


@dataclasses.dataclass(slots=True, kw_only=True)
class Seen:
    """What the strokes have come to so far."""

    null_s: list[float] = dataclasses.field(default_factory=list)
    release_s: list[float] = dataclasses.field(default_factory=list)  # to the sequencer's answer
    walked_s: list[float] = dataclasses.field(default_factory=list)  # to the path through the new tour
    release_refused: list[str] = dataclasses.field(default_factory=list)
    received: int = 0
    path_bytes: int = 0
    flaws: list[str] = dataclasses.field(default_factory=list)
    samples: list[bytes] = dataclasses.field(default_factory=list)
