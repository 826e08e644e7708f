# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk bench live [BUILDING]`: from an edit published to the new path received, as JSON."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from walk_ros.live_bench.command import parser_of, run
from walk_ros.live_bench.measure import measure
from walk_ros.live_bench.options import Options

_DEFAULT = Options(building="")


def main(arguments: Sequence[str] | None = None) -> int:
    """Measures and prints; returns the exit code: 2 where the input cannot be used."""
    return run(_options(arguments), measure)


def _options(arguments: Sequence[str] | None) -> Options:
    does = (
        "drag keypoints at a steady rate, and measure from an edit published to the new path received by another "
        "process, beside a node that only copies."
    )
    parser = parser_of("live", does, _DEFAULT, _DEFAULT.rate_hz)
    parser.add_argument("--hands", type=int, default=_DEFAULT.hands, help="editors at once, a keypoint each")
    given = parser.parse_args(arguments)
    return Options(
        building=given.building,
        seconds=given.seconds,
        points=given.points,
        rate_hz=given.rate,
        hands=given.hands,
        seed=given.seed,
    )


if __name__ == "__main__":
    sys.exit(main())
