# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk bench`: the measurements of walk_plan."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import click

from walk_bringup.bootstrap.commands import COMMANDS

_PASS_ON = {"ignore_unknown_options": True, "allow_extra_args": True}
_OTHERS = {"live": "walk_ros.live_bench", "record": "walk_bag.record_bench", "bridge": "walk_vr_bridge.bench"}
"""Measurements that start nodes, by the word that chooses them."""

_OF_THE_PAGE = {"release": "tests/page/bench_release.py"}
"""Scripts beside the tests of the page, whose browser and emulated headset they use."""


@click.command(short_help=COMMANDS["bench"], context_settings=_PASS_ON, add_help_option=False)
@click.argument("arguments", nargs=-1, type=click.UNPROCESSED)
def bench(arguments: tuple[str, ...]) -> int:
    """Measure every stage, side by side with the plain way; walk_plan.bench explains its options itself."""
    # A fresh process, so that the first stage is not charged with what this one has loaded.
    sys.stdout.flush()
    word, rest = (arguments[0], arguments[1:]) if arguments else ("", ())
    if word in _OF_THE_PAGE:
        script = Path(os.environ["WALK_ROOT"]) / _OF_THE_PAGE[word]
        return os.execv(sys.executable, [sys.executable, str(script), *rest])
    module, rest = (_OTHERS[word], rest) if word in _OTHERS else ("walk_plan.bench", arguments)
    return os.execv(sys.executable, [sys.executable, "-m", module, *rest])
