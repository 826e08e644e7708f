# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk bench record [BUILDING]`: the latency of edits with a recorder and without, and the size of bags, as JSON."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from walk_bag.record_bench.editor import Pattern
from walk_bag.record_bench.measure import Options, measure
from walk_ros.live_bench.command import parser_of, run

_DEFAULT = Options()


def main(arguments: Sequence[str] | None = None) -> int:
    """Measures and prints; returns the exit code: 2 where the input cannot be used."""
    return run(_options(arguments), measure)


def _options(arguments: Sequence[str] | None) -> Options:
    pattern = _DEFAULT.pattern
    does = "make the same edits in rounds with a recorder and without, in turn; or record one session."
    parser = parser_of("record", does, _DEFAULT, pattern.rate_hz)
    parser.add_argument("--pairs", type=int, default=_DEFAULT.pairs, help="of a round with and one without")
    parser.add_argument("--session", type=float, default=_DEFAULT.session_s, help="seconds; record one session instead")
    parser.add_argument("--previews", type=float, default=_DEFAULT.previews_hz, help="as of ./walk record")
    parser.add_argument("--keep", default="", metavar="BAG", help="where to keep the session's bag")
    parser.add_argument("--stroke", type=float, default=pattern.stroke_s, help="seconds from grab to release")
    parser.add_argument("--rest", type=float, default=pattern.rest_s, help="seconds between two strokes")
    parser.add_argument(
        "--insert-every",
        type=int,
        default=pattern.insert_every,
        metavar="STROKES",
        help="insert a keypoint after so many strokes and undo that (default: never)",
    )
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
