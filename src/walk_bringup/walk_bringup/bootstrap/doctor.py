# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk doctor`: what this machine has and lacks, and what to do about it."""

from __future__ import annotations

import dataclasses
import json

from walk_bringup.bootstrap.checks import Check, all_checks
from walk_bringup.bootstrap.layout import Layout
from walk_bringup.bootstrap.machine import look

USAGE = """Usage: ./walk doctor [--json]

  Report what this machine has and lacks, and what to do about it.

  Works before the set-up and changes nothing. Exit code 0 where the project can be set up and run, 1 where not.

Examples:
  ./walk doctor
  ./walk doctor --json
"""


def main(arguments: list[str]) -> int:
    """Prints the report and returns the exit code."""
    if "--help" in arguments or "-h" in arguments:
        print(USAGE, end="")
        return 0
    unknown = [argument for argument in arguments if argument != "--json"]
    if unknown:
        print(f"walk: doctor does not know {unknown[0]!r}; it takes --json.")
        return 2
    layout = Layout.here()
    checks = all_checks(layout, look(layout.root))
    fit = all(check.ok or not check.required for check in checks)
    if "--json" in arguments:
        print(json.dumps({"fit": fit, "checks": [dataclasses.asdict(check) for check in checks]}, indent=2))
    else:
        print(report(checks))
    return 0 if fit else 1


def report(checks: list[Check]) -> str:
    """Returns the checks as text, a line each and a line of advice under what is not as it should be."""
    lines = []
    for check in checks:
        mark = "ok" if check.ok else "NO" if check.required else "--"
        lines.append(f"{mark}  {check.name:<13} {check.state}")
        if not check.ok:
            lines.append(f"    {'':<13} → {check.advice}")
    bad = [check.name for check in checks if check.required and not check.ok]
    lines.append("")
    lines.append("This machine lacks: " + ", ".join(bad) + "." if bad else "This machine is fit.")
    return "\n".join(lines)
