# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk bench record [BUILDING]`: the latency of edits with a recorder and without, and the size of bags, as JSON."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path

from walk_bag.record_bench.editor import Pattern
from walk_bag.record_bench.measure import Options, measure
from walk_building.errors import WalkError
from walk_ros.live_bench.hand import BenchError

_DEFAULT = Options()


def main(arguments: Sequence[str] | None = None) -> int:
    """Measures and prints; returns the exit code: 2 where the input cannot be used."""
    options = _options(arguments)
    try:
        if options.building and not Path(options.building).is_file():
            raise BenchError(f"{options.building}: there is no such building")
        report = measure(options, _say)
    except WalkError as error:
        sys.stderr.write(f"walk: {error}\n")
        return 2
    sys.stdout.write(json.dumps(report, indent=2) + "\n")
    return 0


def _say(text: str) -> None:
    sys.stderr.write(f"bench: {text}\n")
    sys.stderr.flush()


def _options(arguments: Sequence[str] | None) -> Options:
    parser = argparse.ArgumentParser(
        prog="./walk bench record",
        description="Start the three nodes on BUILDING (default: the sample building) and make the same edits in "
        "rounds with a recorder and without, in turn; or record one session. Prints JSON.",
    )
    pattern = _DEFAULT.pattern
    parser.add_argument("building", nargs="?", default="", metavar="BUILDING")
    parser.add_argument("--pairs", type=int, default=_DEFAULT.pairs, help="of a round with and one without")
    parser.add_argument("--seconds", type=float, default=_DEFAULT.seconds, help="of each round")
    parser.add_argument("--session", type=float, default=_DEFAULT.session_s, help="seconds; record one session instead")
    parser.add_argument("--previews", type=float, default=_DEFAULT.previews_hz, help="as of ./walk record")
    parser.add_argument("--keep", default="", metavar="BAG", help="where to keep the session's bag")
    parser.add_argument("--points", type=int, default=_DEFAULT.points, help="points that are optimised")
    parser.add_argument("--rate", type=float, default=pattern.rate_hz, help="edits a second while a keypoint is held")
    parser.add_argument("--stroke", type=float, default=pattern.stroke_s, help="seconds from grab to release")
    parser.add_argument("--rest", type=float, default=pattern.rest_s, help="seconds between two strokes")
    parser.add_argument(
        "--insert-every",
        type=int,
        default=pattern.insert_every,
        metavar="STROKES",
        help="insert a keypoint after so many strokes and undo that (default: never)",
    )
    parser.add_argument("--seed", type=int, default=_DEFAULT.seed, help="of the moves")
    given = parser.parse_args(arguments)
    return Options(
        building=given.building,
        pairs=given.pairs,
        seconds=given.seconds,
        session_s=given.session,
        previews_hz=given.previews,
        keep=given.keep,
        points=given.points,
        pattern=Pattern(rate_hz=given.rate, stroke_s=given.stroke, rest_s=given.rest, insert_every=given.insert_every),
        seed=given.seed,
    )


if __name__ == "__main__":
    sys.exit(main())
