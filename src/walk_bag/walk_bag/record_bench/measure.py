# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The measurement: rounds of the same edits on one graph, with a recorder and without, in turn."""

from __future__ import annotations

import dataclasses
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from walk_bag.record import PREVIEWS_HZ
from walk_bag.record_bench.editor import Editor, Pattern
from walk_bag.record_bench.recorder import RecorderProcess
from walk_bag.record_bench.report import Measured, pairs_report, session_report
from walk_building.pipeline import load_building
from walk_ros.live_bench.hand import BenchError, Hand
from walk_ros.live_bench.processes import Processes, take_own_domain
from walk_ros.node import sample_building

Say = Callable[[str], None]

NODES = ("importance", "sequencer", "trajopt")

_START_S = 120.0
_SETTLE_S = 2.0  # after a recorder has come or gone: what is discovered, and the latched messages


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """What is measured."""

    building: str = ""  # path; empty for the sample building
    pairs: int = 8
    seconds: float = 7.0  # of a round, about
    session_s: float = 0.0  # of one recorded session in place of the pairs; 0 for the pairs
    previews_hz: float = PREVIEWS_HZ  # of the recorder; 0 records every path
    keep: str = ""  # where the session's bag is kept; empty for nowhere
    points: int = 100  # that are optimised
    pattern: Pattern = dataclasses.field(default_factory=Pattern)
    seed: int = 1

    @property
    def strokes(self) -> int:
        """Returns how many strokes a round, or the session, has."""
        seconds = self.session_s or self.seconds
        return max(round(seconds / self.pattern.period_s), 1)


def measure(options: Options, say: Say) -> dict[str, Any]:
    """Returns the report of one measurement on a graph of its own; raises BenchError where there is none to take."""
    with tempfile.TemporaryDirectory(prefix="walk_record_bench_") as folder:
        take_own_domain()
        processes = Processes(Path(folder))
        try:
            return _measured(options, processes, Path(folder), say)
        finally:
            processes.close()


def _measured(options: Options, processes: Processes, folder: Path, say: Say) -> dict[str, Any]:
    file = Path(options.building) if options.building else sample_building()
    for name in NODES:
        points = {"trajopt.points": options.points} if name == "trajopt" else {}
        processes.start(name, {"building": file, **points})
    processes.start("null", {})
    hand = Hand()

    def check() -> None:
        if ended := processes.ended():
            raise BenchError(f"a node has ended: {'; '.join(ended)}")

    try:
        say("loading the building and waiting for the first path")
        building = load_building(file)
        _settle(hand, check)
        editor = Editor(hand, building, options.pattern, check)
        say("one round that does not count")
        editor.round(1, options.seed, recorded=False)
        about = {
            "building": file.name,
            "points": options.points,
            "previews_hz": options.previews_hz,
            "pattern": dataclasses.asdict(options.pattern),
        }
        if options.session_s:
            say(f"recording a session of {options.session_s:g} s")
            bag = Path(options.keep) if options.keep else folder / "session"
            return about | session_report(_one(editor, hand, options, bag))
        return about | pairs_report(_alternated(options, editor, hand, folder, say))
    finally:
        hand.close()


def _settle(hand: Hand, check: Callable[[], None]) -> None:
    """Waits until every node has done what there is to do without a hand."""

    def still() -> bool:
        states = {hand.state(name).get("state") for name in NODES}
        tour = hand.keypoints.poses.stamp_ns if hand.keypoints is not None else 0
        walked = hand.state("trajopt").get("tour_revision_ns") == str(tour)
        return states == {"ready"} and walked and bool(hand.paths) and hand.ready()

    for _ in range(2):
        hand.wait(still, "a graph at rest", _START_S, check)
        hand.pause(_SETTLE_S)


def _alternated(options: Options, editor: Editor, hand: Hand, folder: Path, say: Say) -> list[Measured]:
    """Returns the rounds: without, with, with, without, … so that what drifts weighs on both alike.

    All make the same moves: a round of others would differ by more than a recorder does.
    """
    rounds = []
    for pair in range(options.pairs):
        for recorded in (False, True) if pair % 2 == 0 else (True, False):
            say(f"pair {pair + 1} of {options.pairs}, {'with' if recorded else 'without'} a recorder")
            bag = folder / f"bag_{pair}" if recorded else None
            rounds.append(_one(editor, hand, options, bag))
    return rounds


def _one(editor: Editor, hand: Hand, options: Options, bag: Path | None) -> Measured:
    recorder = RecorderProcess(bag, hand, options.previews_hz) if bag is not None else None
    try:
        hand.pause(_SETTLE_S)
        began = time.perf_counter()
        found = editor.round(options.strokes, options.seed, recorded=recorder is not None)
        wall_s = time.perf_counter() - began
        return Measured(round=found, wall_s=wall_s, bag=recorder.end() if recorder is not None else None)
    finally:
        if recorder is not None:
            recorder.close()
