# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`doctor` and `setup`, for callers who come here without the root script."""

from __future__ import annotations

import click

from walk_bringup.bootstrap import doctor as report
from walk_bringup.bootstrap.commands import COMMANDS
from walk_bringup.bootstrap.layout import Layout
from walk_bringup.bootstrap.machine import look
from walk_bringup.bootstrap.setup import set_up


@click.command(short_help=COMMANDS["doctor"])
@click.option("--json", "as_json", is_flag=True, help="Print the report as JSON.")
def doctor(as_json: bool) -> int:
    """Report what this machine has and lacks, and what to do about it.

    \b
    Examples:
      ./walk doctor
      ./walk doctor --json
    """
    return report.main(["--json"] if as_json else [])


@click.command(short_help=COMMANDS["setup"])
def setup() -> int:
    """Install and build what is missing and do nothing else.

    Every other command does the same first; this one is for preparing a machine or an image.

    \b
    Examples:
      ./walk setup
      WALK_PYTHON=python3.12 ./walk setup
    """
    layout = Layout.here()
    did = set_up(layout, look(layout.root))
    print("The set-up is complete." if did else "There was nothing to do.")
    return 0
