# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk bench live [BUILDING]`: from an edit published to the new path received, as JSON."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path

from walk_building.errors import WalkError
from walk_ros.live_bench.hand import BenchError
from walk_ros.live_bench.measure import measure
from walk_ros.live_bench.options import Options

_DEFAULT = Options(building="")


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
        prog="./walk bench live",
        description="Start the three nodes on BUILDING (default: the sample building), drag keypoints at a steady "
        "rate, and measure from an edit published to the new path received by another process, beside a node that "
        "only copies. Prints JSON.",
    )
    parser.add_argument("building", nargs="?", default="", metavar="BUILDING")
    parser.add_argument("--seconds", type=float, default=_DEFAULT.seconds, help="of dragging; 60 for the figure")
    parser.add_argument("--points", type=int, default=_DEFAULT.points, help="points that are optimised")
    parser.add_argument("--rate", type=float, default=_DEFAULT.rate_hz, help="edits a second of each hand")
    parser.add_argument("--hands", type=int, default=_DEFAULT.hands, help="editors at once, a keypoint each")
    parser.add_argument("--seed", type=int, default=_DEFAULT.seed, help="of the moves")
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
