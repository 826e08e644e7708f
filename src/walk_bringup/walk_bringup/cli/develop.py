# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk test` and `./walk check`: what a change has to pass; CI calls the same."""

from __future__ import annotations

import contextlib
import os
import random
import sys
import time

import click

from walk_bringup.bootstrap.commands import COMMANDS
from walk_bringup.bootstrap.errors import SetupError
from walk_bringup.bootstrap.layout import Layout
from walk_bringup.bootstrap.page import node_environment
from walk_bringup.check.browser import ensure_browser
from walk_bringup.check.rules import broken_rules
from walk_bringup.check.tools import TOOLS, check_page, run_tool

_PASS_ON = {"ignore_unknown_options": True, "allow_extra_args": True}
# Above 101 the ports of a domain reach into those that Linux gives to outgoing connections.
_DOMAINS = range(1, 102)


@click.command(short_help=COMMANDS["test"], context_settings=_PASS_ON)
@click.argument("arguments", nargs=-1, type=click.UNPROCESSED)
def test(arguments: tuple[str, ...]) -> int:
    """Run the tests; ARGUMENTS go to pytest.

    Every run has a ROS domain of its own, so that nodes that are running are neither disturbed nor disturbing.

    \b
    Examples:
      ./walk test
      ./walk test tests/walk_building -q
      ./walk test -k importance -x
    """
    root = Layout.here().root
    os.environ["ROS_DOMAIN_ID"] = str(random.choice(_DOMAINS))
    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    os.chdir(root)
    if _touches_the_page(arguments):
        ensure_browser()
        with contextlib.suppress(SetupError):  # without Node the page's tests say that they are skipped
            os.environ["PATH"] = node_environment(Layout.here())["PATH"]
    sys.stdout.flush()
    return os.execv(sys.executable, [sys.executable, "-m", "pytest", *arguments])


def _touches_the_page(arguments: tuple[str, ...]) -> bool:
    named = [argument for argument in arguments if argument.startswith("tests")]
    return not named or any("page" in argument for argument in named)


@click.command(short_help=COMMANDS["check"])
@click.option("--fix", is_flag=True, help="Let ruff format and mend what it can first.")
def check(fix: bool) -> int:
    """Check format, lint, types (Python and the page's TypeScript) and the rules of the house.

    The rules: only node.py files and walk_ros import ROS; each engine is imported in one file; every source file
    begins with the SPDX header.

    \b
    Examples:
      ./walk check
      ./walk check --fix
    """
    layout = Layout.here()
    if fix:
        run_tool(layout, ("ruff", "format", "--quiet"))
        run_tool(layout, ("ruff", "check", "--fix", "--quiet"))
    failed = 0
    for name, command in TOOLS.items():
        started = time.monotonic()
        ok, output = run_tool(layout, command)
        failed += not ok
        _tell(name, ok, output, time.monotonic() - started)
    started = time.monotonic()
    ok, output = check_page(layout)
    failed += not ok
    _tell("tsc --strict", ok, output, time.monotonic() - started)
    started = time.monotonic()
    broken = broken_rules(layout)
    _tell("rules", not broken, "\n".join(broken), time.monotonic() - started)
    return 1 if failed or broken else 0


def _tell(name: str, ok: bool, output: str, seconds: float) -> None:
    if not ok and output:
        print(output)
    print(f"{'ok' if ok else 'FAILED':<7} {name} ({seconds:.1f} s)", flush=True)
