# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What `./walk` does first: help and doctor at once, everything else after the set-up."""

from __future__ import annotations

import difflib
import os
import sys

from walk_bringup.bootstrap import doctor
from walk_bringup.bootstrap.commands import COMMANDS, overview
from walk_bringup.bootstrap.environment import built_environment
from walk_bringup.bootstrap.errors import SetupError
from walk_bringup.bootstrap.layout import Layout
from walk_bringup.bootstrap.machine import look
from walk_bringup.bootstrap.setup import set_up


def main(arguments: list[str]) -> int:
    """Runs the command; returns the exit code where it does not hand the process over."""
    if not arguments or arguments[0] in ("-h", "--help", "help"):
        print(overview(), end="")
        return 0
    try:
        return _run(arguments)
    except SetupError as error:
        print(f"walk: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("\nwalk: interrupted; the next call goes on from here.", file=sys.stderr)
        return 130


def _run(arguments: list[str]) -> int:
    command = arguments[0]
    if command not in COMMANDS:
        raise SetupError(unknown_command(command))
    if command == "doctor":
        return doctor.main(arguments[1:])
    layout = Layout.here()
    did = set_up(layout, look(layout.root))
    if command == "setup" and "--help" not in arguments:
        print("The set-up is complete." if did else "There was nothing to do.")
        return 0
    sys.stdout.flush()
    env = built_environment(layout, os.environ)
    return os.execve(layout.python, [str(layout.python), "-m", "walk_bringup.cli", *arguments], env)


def unknown_command(command: str) -> str:
    """Returns the sentence for a command that does not exist, with the one that may be meant."""
    close = difflib.get_close_matches(command, COMMANDS, n=1)
    meant = f"; is {close[0]!r} meant?" if close else ";"
    return f"there is no command {command!r}{meant} ./walk --help lists them."
