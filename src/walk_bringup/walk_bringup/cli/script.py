# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk python`: a script in the environment in which the packages run."""

from __future__ import annotations

import os
import sys

import click

from walk_bringup.bootstrap.commands import COMMANDS

# Everything behind the script is its own, --help included.
_PASS_ON = {"ignore_unknown_options": True, "allow_interspersed_args": False}


@click.command(short_help=COMMANDS["python"], context_settings=_PASS_ON)
@click.argument("arguments", nargs=-1, type=click.UNPROCESSED)
def python(arguments: tuple[str, ...]) -> int:
    """Run a Python script that uses the project's packages; without one, an interactive Python.

    \b
    Examples:
      ./walk python examples/1_building.py
      ./walk python examples/5_trajectory.py building.ifc
      ./walk python -c "from walk_building import load_building; print(load_building('house.ifc').rooms)"
    """
    sys.stdout.flush()
    return os.execv(sys.executable, [sys.executable, *arguments])
