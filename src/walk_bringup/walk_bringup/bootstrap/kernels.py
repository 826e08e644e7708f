# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Stage 5: compiling the numeric kernels once; numba keeps the result beside the sources."""

from __future__ import annotations

import os
import sys

from walk_bringup.bootstrap.command import last_line, run_logged
from walk_bringup.bootstrap.environment import built_environment
from walk_bringup.bootstrap.errors import SetupError
from walk_bringup.bootstrap.layout import Layout
from walk_bringup.bootstrap.machine import Machine
from walk_bringup.bootstrap.progress import StageLine
from walk_bringup.bootstrap.stamps import fingerprint_of_times


def fingerprint(layout: Layout, machine: Machine) -> str:
    """Returns what the compiled kernels depend on: the sources that use numba, and where they lie."""
    del machine
    sources = sorted(layout.root.glob("src/*/walk_*/**/*.py"))
    return fingerprint_of_times(path for path in sources if b"import numba" in path.read_bytes())


def compile_all(layout: Layout, machine: Machine) -> None:
    """Runs the cores once on a small building, so that no later start waits for the compiler.

    A core that fails on it is said, but is no reason to stop: whoever is changing it needs the other commands.
    """
    del machine
    try:
        with StageLine("compiled kernels", 100) as line:

            def on_line(text: str) -> None:
                share, _, stage = text.partition(" ")
                if share.isdigit():
                    line.update(int(share), stage)

            run_logged(
                [layout.python, "-m", "walk_bringup.warm_up"],
                layout.state / "kernels.log",
                cwd=layout.root,
                env=built_environment(layout, os.environ),
                on_line=on_line,
                explain=lambda output: last_line(output),
            )
    except SetupError as error:
        print(f"walk: not all kernels could be compiled ahead, the rest is on first use: {error}", file=sys.stderr)
