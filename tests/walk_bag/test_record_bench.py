# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The measurement of the recorder counts honestly, on made-up rounds with known figures."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from walk_bag.record_bench.__main__ import main
from walk_bag.record_bench.editor import Pattern
from walk_bag.record_bench.figures import Round, overhead
from walk_bag.record_bench.measure import Options
from walk_bag.record_bench.recorder import Recorded
from walk_bag.record_bench.report import Measured, pairs_report, session_report
from walk_ros.live_bench.figures import Answers


def a_round(scale: float, *, recorded: bool, seed: int = 0, edits: int = 400) -> Round:
    latencies = scale * np.random.default_rng(seed).gamma(4.0, 0.001, (4, 100))
    answers = Answers(latency_s=tuple(latencies.ravel()), superseded=1, refused=2, lost=3, reasons=())
    strokes = tuple(tuple(row) for row in latencies.tolist())
    return Round(recorded=recorded, strokes_s=strokes, answers=answers, edits=edits, paths=edits)


class Bag(Recorded):
    """A bag that says what is in it without a file."""

    def counts(self) -> Counter[str]:
        return Counter({"/walk/keypoint_edits": 400, "/walk/path": 390})

    def payload_bytes(self) -> dict[str, int]:
        return {"/walk/path": 3_000_000, "/walk/keypoint_edits": 1_000_000}


BAG = Bag(bag=Path("bag"), size_bytes=2_000_000, cpu_s=1.0)


def test_a_recorder_that_adds_a_tenth_to_every_edit_is_found_to_add_a_tenth() -> None:
    found = overhead([a_round(s, recorded=s > 1, seed=k) for k in range(6) for s in (1.0, 1.1)])
    for key in ("p50", "p99"):
        assert found[key]["ratio"] == pytest.approx(1.1, abs=1e-4)
        assert found[key]["ratio_of_pairs"] == pytest.approx([1.1] * 6, abs=1e-4)
        low, high = found[key]["ratio_95"]
        assert low < 1.1 < high
        assert 0.9 < found[key]["noise"] < 1.1
    assert found["edit_to_path_ms"]["without"]["count"] == 2400


def test_the_interval_is_that_of_strokes_not_of_edits() -> None:
    """Of two strokes a whole one may be slow: the ratio is not known to a percent, however many edits they have."""
    fast, slow = [0.004] * 5000, [0.008] * 5000

    def mixed(*, recorded: bool) -> Round:
        answers = Answers(latency_s=(*fast, *slow), superseded=0, refused=0, lost=0, reasons=())
        return Round(recorded=recorded, strokes_s=(tuple(fast), tuple(slow)), answers=answers, edits=1, paths=1)

    low, high = overhead([mixed(recorded=False), mixed(recorded=True)])["p99"]["ratio_95"]
    assert low == 0.5
    assert high == 2.0


def test_the_reports_count_what_was_sent_and_what_is_in_the_bags() -> None:
    plain = Measured(round=a_round(1.0, recorded=False), wall_s=10.0)
    recorded = Measured(round=a_round(1.06, recorded=True), wall_s=10.0, bag=BAG)
    report = pairs_report([plain, recorded])
    assert report["goals_met"] == {"ratio_p99": False}
    assert report["edits"] == {"sent": 800, "refused": 4, "superseded": 2, "lost": 6}
    assert report["recording"]["edits"] == {"sent": 400, "in_bags": 400}
    assert report["recording"]["paths"] == {"received": 400, "in_bags": 390}
    assert report["recording"]["cpu_share"] == 0.1
    assert report["recording"]["compressed_to"] == 0.5
    assert session_report(recorded)["goals_met"] == {"session_mb": True}


def test_a_session_has_as_many_strokes_as_fit_beside_its_insertions() -> None:
    """Three strokes of 2.5 s, an insertion and an undo, each with a rest of 10.5 s behind it, are a minute."""
    pattern = Pattern(stroke_s=2.5, rest_s=10.5, insert_every=3)
    assert Options(session_s=600.0, pattern=pattern).strokes == 30


def test_a_building_that_is_not_there_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["nowhere.ifc"]) == 2
    assert "nowhere.ifc: there is no such building" in capsys.readouterr().err
