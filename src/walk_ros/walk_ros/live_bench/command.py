# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What the commands that measure a running graph share: their arguments, and how they say what they found."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Protocol, TypeVar

from walk_building.errors import WalkError
from walk_ros.live_bench.hand import BenchError


class Measured(Protocol):
    """What is said about any of these measurements."""

    @property
    def building(self) -> str:
        """Path; empty for the sample building."""

    @property
    def seconds(self) -> float:
        """How long each round is."""

    @property
    def points(self) -> int:
        """That are optimised."""

    @property
    def seed(self) -> int:
        """Of the moves."""


M = TypeVar("M", bound=Measured)
Say = Callable[[str], None]


def parser_of(word: str, description: str, default: Measured, rate_hz: float) -> argparse.ArgumentParser:
    """Returns the parser of `./walk bench WORD` with the arguments that all of them take."""
    parser = argparse.ArgumentParser(
        prog=f"./walk bench {word}",
        description=f"Start the three nodes on BUILDING (default: the sample building), {description} Prints JSON.",
    )
    parser.add_argument("building", nargs="?", default="", metavar="BUILDING")
    parser.add_argument("--seconds", type=float, default=default.seconds, help="of each round; 60 for a figure")
    parser.add_argument("--points", type=int, default=default.points, help="points that are optimised")
    parser.add_argument("--rate", type=float, default=rate_hz, help="edits a second of each hand that holds a keypoint")
    parser.add_argument("--seed", type=int, default=default.seed, help="of the moves")
    return parser


def run(options: M, measure: Callable[[M, Say], Mapping[str, Any]]) -> int:
    """Measures and prints; returns the exit code: 2 where the input cannot be used."""
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
