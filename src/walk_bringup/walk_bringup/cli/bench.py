# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk bench`: the measurements of walk_plan."""

from __future__ import annotations

import difflib
import os
import sys
from pathlib import Path

import click

from walk_bringup.bootstrap.commands import COMMANDS
from walk_bringup.bootstrap.errors import SetupError

_PASS_ON = {"ignore_unknown_options": True, "allow_extra_args": True}
_OTHERS = {"live": "walk_ros.live_bench", "record": "walk_bag.record_bench", "bridge": "walk_vr_bridge.bench"}
"""Measurements that start nodes, by the word that chooses them."""

MEASUREMENTS = {
    "plan": "every stage of a plan, and the plain ways beside them (the default)",
    "load": "reading a building",
    "importance": "the importance map, on a building that is made up",
    "growth": "the visibility map on larger and larger grids",
    "tour": "legs and order, and how far the order is from the best one",
    "trajectory": "the optimiser, and edits of it",
    "live": "an edit to its new path, through the running nodes",
    "record": "what a recorder costs a session, and how large bags become",
    "bridge": "what the page's bridge adds to an edit",
    "release": "a keypoint let go to its path on the screen, in a browser",
}
"""All of them, by the word that chooses them."""

_OF_THE_PAGE = {"release": "tests/page/bench_release.py"}
"""Scripts beside the tests of the page, whose browser and emulated headset they use."""


@click.command(short_help=COMMANDS["bench"], context_settings=_PASS_ON, add_help_option=False)
@click.argument("arguments", nargs=-1, type=click.UNPROCESSED)
def bench(arguments: tuple[str, ...]) -> int:
    """Measure every stage, side by side with the plain way; each measurement explains its options itself."""
    if arguments and arguments[0] in ("-h", "--help"):
        click.echo("usage: ./walk bench [WHAT] [options]; ./walk bench WHAT --help has its options\n\nWHAT:")
        for word, text in MEASUREMENTS.items():
            click.echo(f"  {word:<11} {text}")
        click.echo("\nexamples:\n  ./walk bench\n  ./walk bench load building.ifc\n  ./walk bench live --seconds 20")
        return 0
    if arguments and not arguments[0].startswith("-") and arguments[0] not in MEASUREMENTS:
        near = difflib.get_close_matches(arguments[0], MEASUREMENTS, 1)
        hint = f"did you mean {near[0]}?" if near else f"there are {', '.join(MEASUREMENTS)}"
        raise SetupError(f"there is no measurement {arguments[0]!r}; {hint}")
    # A fresh process, so that the first stage is not charged with what this one has loaded.
    sys.stdout.flush()
    word, rest = (arguments[0], arguments[1:]) if arguments else ("", ())
    if word in _OF_THE_PAGE:
        script = Path(os.environ["WALK_ROOT"]) / _OF_THE_PAGE[word]
        return os.execv(sys.executable, [sys.executable, str(script), *rest])
    module, rest = (_OTHERS[word], rest) if word in _OTHERS else ("walk_plan.bench", arguments)
    return os.execv(sys.executable, [sys.executable, "-m", module, *rest])
