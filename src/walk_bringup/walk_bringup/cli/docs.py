# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk docs`: the documentation as a site."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import click

from walk_bringup.bootstrap.commands import COMMANDS
from walk_bringup.bootstrap.layout import Layout


@click.command(short_help=COMMANDS["docs"])
@click.option(
    "--out", type=click.Path(path_type=Path), default=Path("out/docs"), show_default=True, help="Folder of the site."
)
def docs(out: Path) -> int:
    """Build the documentation in docs/ as a site.

    \b
    Examples:
      ./walk docs
      ./walk docs --out public
    """
    command = [sys.executable, "-m", "sphinx", "--quiet", "--fail-on-warning", "-b", "html"]
    doctrees = Layout.here().state / "doctrees"
    done = subprocess.run([*command, "-d", str(doctrees), str(Layout.here().root / "docs"), str(out)])
    if done.returncode == 0:
        print(f"walk: open {out / 'index.html'}")
    return done.returncode
