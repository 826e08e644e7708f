# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Writes requirements.lock anew from requirements.in: `.venv/bin/python PATH_OF_THIS_FILE [PYTHON …]`."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[4]
LOCK = ROOT / "requirements.lock"

HEADER = """\
# Every package of requirements.in with all it needs, pinned; the same list serves Python 3.11, 3.12 and 3.13
# on Linux x86_64. Lines that start with ros- are left out where a ROS 2 Jazzy installation is sourced.
# Made by src/walk_bringup/walk_bringup/bootstrap/lock.py; CONTRIBUTING.md says how.
"""

# The registry has EmPy as source only.
_WHEELS = ("--only-binary", ":all:", "--no-binary", "empy")


def main(pythons: Sequence[str]) -> int:
    """Resolves with the first Python and checks the result with all; returns the exit code."""
    pins = resolve(pythons[0], ROOT / "requirements.in")
    with tempfile.TemporaryDirectory() as folder:
        listing = Path(folder) / "pins.txt"
        listing.write_text("\n".join(pins) + "\n", encoding="utf-8")
        for python in pythons:
            missing = set(resolve(python, listing)) - set(pins)
            if missing:
                print(f"{python} needs more than the others: {', '.join(sorted(missing))}", file=sys.stderr)
                return 1
    LOCK.write_text(HEADER + "\n".join(pins) + "\n", encoding="utf-8")
    print(f"{LOCK}: {len(pins)} packages, checked with {', '.join(pythons)}")
    return 0


def resolve(python: str, requirements: Path) -> list[str]:
    """Returns what pip would install for a list of requirements, as sorted pins."""
    command = [python, "-m", "pip", "install", "--quiet", "--dry-run", "--ignore-installed", *_WHEELS]
    done = subprocess.run(
        [*command, "--report", "-", "-r", str(requirements)], stdout=subprocess.PIPE, text=True, check=True
    )
    report = json.loads(done.stdout)
    found = (item["metadata"] for item in report["install"])
    return sorted(f"{data['name'].lower().replace('_', '-')}=={data['version']}" for data in found)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:] or [sys.executable]))
