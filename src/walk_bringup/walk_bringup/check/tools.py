# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The tools of `./walk check` and what they are run on."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

from walk_bringup.bootstrap.errors import SetupError
from walk_bringup.bootstrap.layout import Layout
from walk_bringup.bootstrap.page import node_environment

CORES = (
    "walk_building",
    "walk_importance",
    "walk_sequencer",
    "walk_trajopt",
    "walk_plan",
)
"""The packages that mypy reads in strict mode, their nodes included."""

TOOLS: dict[str, tuple[str, ...]] = {
    "ruff format": ("ruff", "format", "--check"),
    "ruff lint": ("ruff", "check"),
    "mypy --strict": ("mypy",),
}


def run_tool(layout: Layout, command: tuple[str, ...]) -> tuple[bool, str]:
    """Runs a tool on what it is for and returns whether it was content, and what it said."""
    targets = _typed(layout) if command[0] == "mypy" else [Path("src"), Path("tests"), Path("examples")]
    done = subprocess.run(
        [sys.executable, "-m", *command, *map(str, targets)], cwd=layout.root, capture_output=True, text=True
    )
    return done.returncode == 0, (done.stdout + done.stderr).strip()


def check_page(layout: Layout) -> tuple[bool, str]:
    """Type-checks the page; returns whether the compiler was content, and what it said."""
    if not (layout.web / "node_modules").is_dir():
        return False, f"{layout.web} has no node_modules: the page was not built; ./walk setup tries again"
    try:
        env = node_environment(layout)
    except SetupError as error:
        return False, str(error)
    npm = shutil.which("npm", path=env["PATH"]) or "npm"
    done = subprocess.run([npm, "run", "--silent", "check"], cwd=layout.web, env=env, capture_output=True, text=True)
    return done.returncode == 0, (done.stdout + done.stderr).strip()


def _typed(layout: Layout) -> list[Path]:
    cores = [Path("src") / name / name for name in CORES]
    ours = Path("src/walk_bringup/walk_bringup")
    folders = [*cores, ours / "bootstrap", ours / "cli", ours / "check"]
    return [folder for folder in folders if any((layout.root / folder).glob("**/*.py"))]
