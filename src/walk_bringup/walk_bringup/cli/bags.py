# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk record`, `recover` and `replay`: the executables of walk_bag."""

from __future__ import annotations

import os
import subprocess
import sys

import click

from walk_bringup.bootstrap.commands import COMMANDS
from walk_bringup.cli.executables import find_executable

_EXAMPLES = {
    "record": (
        "./walk record --out tour_bag",
        "./walk record --out tour.mcap --topics path trajectory",
        "./walk record --out session --previews 2",
    ),
    "recover": ("./walk recover tour_bag", "./walk recover tour.part.mcap --out tour.mcap"),
    "replay": ("./walk replay out/building/tour.mcap", "./walk replay tour_bag --start 30 --rate 2 --clock"),
}
# The options are those of the executables, which explain them themselves.
_PASS_ON = {"ignore_unknown_options": True, "allow_extra_args": True}


@click.command(short_help=COMMANDS["record"], context_settings=_PASS_ON, add_help_option=False)
@click.argument("arguments", nargs=-1, type=click.UNPROCESSED)
def record(arguments: tuple[str, ...]) -> int:
    """Record a walkthrough as a rosbag2 (MCAP) bag."""
    return _hand_over("record", arguments)


@click.command(short_help=COMMANDS["recover"], context_settings=_PASS_ON, add_help_option=False)
@click.argument("arguments", nargs=-1, type=click.UNPROCESSED)
def recover(arguments: tuple[str, ...]) -> int:
    """Make a whole bag of one whose recording was cut off."""
    return _hand_over("recover", arguments)


@click.command(short_help=COMMANDS["replay"], context_settings=_PASS_ON, add_help_option=False)
@click.argument("arguments", nargs=-1, type=click.UNPROCESSED)
def replay(arguments: tuple[str, ...]) -> int:
    """Publish a recorded walkthrough again."""
    return _hand_over("replay", arguments)


def _hand_over(name: str, arguments: tuple[str, ...]) -> int:
    path = find_executable("walk_bag", name)
    sys.stdout.flush()
    os.environ["WALK_COMMAND"] = f"./walk {name}"  # what its help and its complaints call it
    if "--help" in arguments or "-h" in arguments:
        code = subprocess.run([path, "--help"]).returncode
        print("\nexamples:", *_EXAMPLES[name], sep="\n  ")
        return code
    return os.execv(path, [str(path), *arguments])
