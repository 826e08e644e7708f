# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Editing sessions that can be repeated move by move: each stroke ends where it began."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from walk_bag.record_bench.figures import Round
from walk_building.building import Building
from walk_ros.conversions import Change, EditKind, Outcome
from walk_ros.live_bench.figures import match
from walk_ros.live_bench.hand import Hand
from walk_ros.live_bench.strokes import stroke

_ANSWER_S = 20.0
_SPEED_MPS = 0.6
_CLIENT = "hand"


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Pattern:
    """How somebody edits."""

    rate_hz: float = 90.0  # drags a second while a keypoint is held
    stroke_s: float = 3.0  # from grab to release
    rest_s: float = 0.3  # from the new path to the next grab
    insert_every: int = 0  # strokes after which a keypoint is inserted and the insertion undone; 0 for never

    @property
    def period_s(self) -> float:
        """Returns the mean time from one grab to the next, without the wait for answers [s]."""
        rests = 1 + (2 / self.insert_every if self.insert_every else 0)
        return self.stroke_s + self.rest_s * rests


class Editor:
    """Drags one keypoint after the other, there and back."""

    def __init__(self, hand: Hand, building: Building, pattern: Pattern, check: Callable[[], None]) -> None:
        """Begins.

        Args:
            hand: Sends the edits.
            building: In which they are made.
            pattern: How often and how long.
            check: Raises BenchError where the graph is no more.
        """
        self._hand = hand
        self._building = building
        self._pattern = pattern
        self._check = check

    def round(self, strokes: int, seed: int, *, recorded: bool) -> Round:
        """Makes some strokes, a keypoint after the other; returns what came of them. A seed stands for its moves."""
        self._hand.forget()
        dice = np.random.default_rng(seed)
        ends: list[int] = []
        others = 0
        for turn in range(strokes):
            there = self._stroke(turn, dice)
            if self._pattern.insert_every and (turn + 1) % self._pattern.insert_every == 0:
                self._change(Change.INSERT, there)
                self._change(Change.UNDO, there)
                others += 2
            ends.append(len(self._hand.sent))
        told = self._hand.told()
        begins = [0, *ends[:-1]]
        latencies = [
            match(self._hand.sent[a:b], told, self._hand.paths).latency_s for a, b in zip(begins, ends, strict=True)
        ]
        return Round(
            recorded=recorded,
            strokes_s=tuple(s for s in latencies if s),
            answers=match(self._hand.sent, told, self._hand.paths),
            edits=len(self._hand.sent) + 2 * len(ends) + others,
            paths=len(self._hand.paths),
        )

    def _stroke(self, turn: int, dice: np.random.Generator) -> NDArray[np.float64]:
        """Drags a keypoint out and back; returns the eye position farthest out."""
        hand, pattern = self._hand, self._pattern
        shown = hand.keypoints
        assert shown is not None
        index = turn % len(shown.ids)
        identity, eye = shown.ids[index], shown.poses.positions[index]
        eyes = self._there_and_back(eye, dice)
        hand.touch(EditKind.GRAB, identity, eye, _CLIENT)
        hand.drag([(_CLIENT, identity, eyes)], pattern.rate_hz)
        hand.pause(0.1)
        stamp_ns = hand.touch(EditKind.RELEASE, identity, eye, _CLIENT)
        self._see(stamp_ns)
        return eyes[len(eyes) // 2]

    def _change(self, change: Change, eye: NDArray[np.float64]) -> None:
        self._see(self._hand.touch(EditKind.CHANGE, -1, eye, _CLIENT, change))

    def _see(self, stamp_ns: int) -> None:
        """Waits until an edit is answered and its path is there, then rests."""
        hand = self._hand
        result, _ = hand.wait(lambda: hand.answer(stamp_ns), "the answer to an edit", _ANSWER_S, self._check)
        if result.outcome is Outcome.ACCEPTED:
            hand.wait(lambda: max(hand.paths, default=0) > result.revision_ns, "its path", _ANSWER_S, self._check)
        hand.pause(self._pattern.rest_s)
        hand.raw.clear()

    def _there_and_back(self, eye: NDArray[np.float64], dice: np.random.Generator) -> NDArray[np.float64]:
        pattern = self._pattern
        half = max(int(pattern.stroke_s * pattern.rate_hz / 2), 1)
        out = stroke(self._building, eye, half, _SPEED_MPS, pattern.rate_hz, dice)
        return np.concatenate([out, out[::-1]])
