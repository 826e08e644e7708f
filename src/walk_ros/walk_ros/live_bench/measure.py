# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The measurement: strokes of a hand on a running graph, null round trips between them, and what came of it."""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_building.pipeline import load_building
from walk_ros.conversions import EditKind, Outcome
from walk_ros.live_bench.figures import match, ratios, summary_ms, verdict
from walk_ros.live_bench.hand import BenchError, Hand
from walk_ros.live_bench.options import Options, Seen
from walk_ros.live_bench.paths import colliding, flaw
from walk_ros.live_bench.processes import Processes, take_own_domain
from walk_ros.live_bench.strokes import stroke
from walk_ros.node import sample_building

Say = Callable[[str], None]

NODES = ("importance", "sequencer", "trajopt")
GOALS = {"ratio_p50": 4.0, "ratio_p99": 4.0, "p50_ms": 8.0, "p99_ms": 22.0, "lost": 0, "invalid": 0, "colliding": 0}
"""Upper limits of what counts, for 100 points."""

_START_S = 120.0
_ANSWER_S = 20.0
_SETTLE_S = 0.3  # from a release's new path to the null trips: the legs of all pairs are published in between
_SWEPT = 60  # paths that the body is swept along afterwards; a sweep takes tenths of a second


def measure(options: Options, say: Say) -> dict[str, Any]:
    """Returns the report of one measurement on a graph of its own; raises BenchError where there is none to take."""
    with tempfile.TemporaryDirectory(prefix="walk_bench_") as folder:
        take_own_domain()
        processes = Processes(Path(folder))
        try:
            return _measured(options, processes, say)
        finally:
            processes.close()


def _measured(options: Options, processes: Processes, say: Say) -> dict[str, Any]:
    for name in NODES:
        points = {"trajopt.points": options.points} if name == "trajopt" else {}
        processes.start(name, {"building": options.building, **points} if options.building else points)
    processes.start("null", {})
    hand = Hand()
    try:
        say("loading the building and waiting for the first path")
        building = load_building(_file(options))
        _settle(hand, processes)
        bench = _Bench(options, building, hand, processes)
        say("one stroke that does not count")
        bench.strokes(1.0)
        bench.begin()
        while bench.dragged_s < options.seconds:
            say(f"dragged {bench.dragged_s:.0f} of {options.seconds:.0f} s")
            bench.strokes(min(options.stroke_s, options.seconds - bench.dragged_s))
        return bench.report(say)
    finally:
        hand.close()


def _file(options: Options) -> Path:
    if options.building:
        return Path(options.building)
    return sample_building()


def _settle(hand: Hand, processes: Processes) -> None:
    """Waits until every node has done what there is to do without a hand."""

    def check() -> None:
        _check(processes)

    def still() -> bool:
        states = {name: hand.state(name).get("state") for name in NODES}
        tour = hand.keypoints.poses.stamp_ns if hand.keypoints is not None else 0
        walked = hand.state("trajopt").get("tour_revision_ns") == str(tour)
        return set(states.values()) == {"ready"} and walked and bool(hand.paths) and hand.ready()

    hand.wait(still, "a graph at rest", _START_S, check)
    hand.pause(1.5)
    hand.wait(still, "a graph at rest", _START_S, check)


def _number(values: Mapping[str, str], key: str) -> float | None:
    return float(values[key]) if key in values else None


def _check(processes: Processes) -> None:
    ended = processes.ended()
    if ended:
        raise BenchError(f"a node has ended: {'; '.join(ended)}")


class _Bench:
    """Strokes and what they came to."""

    def __init__(self, options: Options, building: Building, hand: Hand, processes: Processes) -> None:
        self._options = options
        self._building = building
        self._hand = hand
        self._processes = processes
        self._dice = np.random.default_rng(options.seed)
        # Apart, or how many paths come in would decide about the next move.
        self._draw = np.random.default_rng(options.seed)
        self._turn = 0
        self._seen = Seen()
        self.dragged_s = 0.0

    def begin(self) -> None:
        """From here on it counts."""
        self._seen = Seen()
        self._hand.forget()
        self._rss = self._processes.rss_mib()
        self._cpu = self._processes.cpu_s()
        self._began_s = time.perf_counter()
        self.dragged_s = 0.0

    def strokes(self, seconds: float) -> None:
        """Drags one keypoint per hand for some time and releases it; then null round trips."""
        options, hand = self._options, self._hand
        count = max(int(seconds * options.rate_hz), 1)
        shown = hand.keypoints
        assert shown is not None
        held = {(self._turn + i) % len(shown.ids): f"hand {i + 1}" for i in range(options.hands)}
        self._turn += options.hands
        moves = [(client, shown.ids[k], self._way(shown.poses.positions[k], count)) for k, client in held.items()]
        for client, identity, eyes in moves:
            hand.touch(EditKind.GRAB, identity, eyes[0], client)
        hand.drag(moves, options.rate_hz)
        self.dragged_s += count / options.rate_hz
        hand.pause(0.1)
        self._take_paths(shown.poses.positions, frozenset(held))
        for client, identity, eyes in moves:
            self._release(client, identity, eyes[-1])
        hand.pause(_SETTLE_S)
        trips = max(count // 5, 30)
        newest = hand.raw.pop(max(hand.raw), None) if hand.raw else None
        sample = newest or self._seen.samples[-1]
        self._seen.null_s += hand.null_trips(sample, moves[0][2][0], trips, options.rate_hz)
        hand.raw.clear()

    def _way(self, eye: NDArray[np.float64], count: int) -> NDArray[np.float64]:
        options = self._options
        return stroke(self._building, eye, count, options.speed_mps, options.rate_hz, self._dice)

    def _take_paths(self, keypoints: NDArray[np.float64], held: frozenset[int]) -> None:
        """Checks what has come in and keeps a few for the sweep."""
        seen = self._seen
        for data in self._hand.raw.values():
            seen.received += 1
            seen.path_bytes = len(data)
            reason = flaw(data, keypoints, held)
            if reason:
                seen.flaws.append(reason)
            if self._draw.random() < 0.05:
                seen.samples.append(data)
        if self._hand.raw:
            seen.samples.append(self._hand.raw[max(self._hand.raw)])
        self._hand.raw.clear()

    def _release(self, client: str, identity: int, eye: NDArray[np.float64]) -> None:
        """Releases a keypoint and waits for the answer and the path that goes with it."""
        hand, seen = self._hand, self._seen
        began = time.perf_counter()
        stamp_ns = hand.touch(EditKind.RELEASE, identity, eye, client)

        def check() -> None:
            _check(self._processes)

        result, answered = hand.wait(lambda: hand.answer(stamp_ns), "the answer to a release", _ANSWER_S, check)
        if result.outcome is not Outcome.ACCEPTED:
            seen.release_refused.append(result.reason)
            return
        seen.release_s.append(answered - began)
        hand.wait(
            lambda: hand.keypoints is not None and hand.keypoints.poses.stamp_ns >= result.revision_ns,
            "the new keypoints",
            _ANSWER_S,
            check,
        )
        # Stamps are of one clock: a path that is later than the new tour leads through it.
        hand.wait(lambda: max(hand.paths, default=0) > result.revision_ns, "its path", _ANSWER_S, check)
        seen.walked_s.append(min(at for stamp, at in hand.paths.items() if stamp > result.revision_ns) - began)

    def report(self, say: Say) -> dict[str, Any]:
        """Returns what has been measured since `begin`."""
        options, hand, seen = self._options, self._hand, self._seen
        wall_s = time.perf_counter() - self._began_s
        rss, cpu = self._processes.rss_mib(), self._processes.cpu_s()
        say("sweeping the body along a sample of the paths")
        samples = self._swept()
        answers = match(hand.sent, hand.told(), hand.paths)
        ours, null = summary_ms(answers.latency_s), summary_ms(seen.null_s)
        ratio = ratios(ours, null)
        bad = colliding(self._building, samples)
        flat = {
            "ratio_p50": ratio.get("p50", np.inf),
            "ratio_p99": ratio.get("p99", np.inf),
            "p50_ms": ours.get("p50", np.inf),
            "p99_ms": ours.get("p99", np.inf),
            "lost": answers.lost,
            "invalid": len(seen.flaws),
            "colliding": bad,
        }
        return {
            "building": Path(options.building).name or "the sample building",
            "keypoints": len(hand.keypoints.ids) if hand.keypoints else 0,
            "points": options.points,
            "path_bytes": seen.path_bytes,
            "hands": options.hands,
            "rate_hz": options.rate_hz,
            "dragged_s": round(self.dragged_s, 2),
            "edit_to_path_ms": ours,
            "of_which_trajopt_ms": {key: _number(hand.state("trajopt"), f"latency_{key}_ms") for key in ("p50", "p99")},
            "null_ms": null,
            "ratio": ratio,
            "edits": {
                "sent": len(hand.sent),
                "superseded": answers.superseded,
                "refused": answers.refused,
                "lost": answers.lost,
                "reasons": list(answers.reasons),
            },
            "release_to_answer_ms": summary_ms(seen.release_s),
            "release_to_new_tour_ms": summary_ms(seen.walked_s),
            "releases_refused": seen.release_refused,
            "paths": {
                "received": seen.received,
                "invalid": len(seen.flaws),
                "flaws": sorted(set(seen.flaws))[:5],
                "swept": len(samples),
                "colliding": bad,
            },
            "rss_mib": {name: {"start": self._rss.get(name), "end": rss.get(name)} for name in NODES},
            "cpu_share": {name: round((cpu[name] - self._cpu[name]) / wall_s, 3) for name in cpu},
            "cores": os.cpu_count(),
            "goals_met": verdict(flat, GOALS),
        }

    def _swept(self) -> Sequence[bytes]:
        samples = self._seen.samples
        keep = np.unique(np.linspace(0, len(samples) - 1, min(_SWEPT, len(samples))).astype(int)) if samples else []
        return [samples[i] for i in keep]
