# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Stage 4: the packages, built by colcon with links to the sources."""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path

from walk_bringup.bootstrap import environment
from walk_bringup.bootstrap.command import run_logged
from walk_bringup.bootstrap.layout import Layout
from walk_bringup.bootstrap.machine import Machine
from walk_bringup.bootstrap.progress import StageLine
from walk_bringup.bootstrap.stamps import fingerprint as _fingerprint
from walk_bringup.bootstrap.stamps import read_json, write_json

_PACKAGING = ("package.xml", "setup.py", "setup.cfg")
_DATA = ("resource/*", "launch/*.py", "config/*.yaml", "rviz/*.rviz", "foxglove/*.json", "buildings/*.ifc")


def fingerprint(layout: Layout, machine: Machine) -> str:
    """Returns what a build depends on: the packaging, and the names of files that are linked one by one."""
    packages = layout.packages()
    files = [package / name for package in packages for name in _PACKAGING if (package / name).exists()]
    names = [str(path) for package in packages for pattern in _DATA for path in sorted(package.glob(pattern))]
    return _fingerprint([str(layout.root), str(machine.has_ros), *names], [*files, layout.root / "colcon.meta"])


def build(layout: Layout, machine: Machine) -> None:
    """Builds all packages and stores the environment in which they run.

    Raises:
        SetupError: colcon failed.
    """
    _drop_foreign_build(layout)
    env = environment.venv_environment(layout, os.environ, wheels=not machine.has_ros)
    count = len(layout.packages())
    with StageLine("ROS packages", count) as line:
        finished = 0

        def on_line(text: str) -> None:
            nonlocal finished
            match = re.match(r"(Starting >>>|Finished <<<) (\S+)", text)
            if match:
                finished += match[1].startswith("Finished")
                line.update(finished, match[2])

        run_logged(
            [layout.python, "-m", "colcon", "--log-base", "log", "build", "--symlink-install", "--base-paths", "src"],
            layout.state / "build.log",
            cwd=layout.root,
            env=env,
            on_line=on_line,
            explain=explain,
        )
    environment.store(layout, wheels=not machine.has_ros)


def explain(output: str) -> str:
    """Returns the reason why colcon failed, in a sentence for the user."""
    failed = re.findall(r"Failed\s+<<< (\S+)", output)
    return f"colcon could not build {', '.join(failed) if failed else 'the packages'}."


def _drop_foreign_build(layout: Layout) -> None:
    # A checkout that was moved or copied carries links and shebangs to its old place.
    made_for = layout.state / "made_for.json"
    before = read_json(made_for)
    if before is not None and before != str(layout.root):
        for folder in (layout.install, *_built(layout)):
            shutil.rmtree(folder, ignore_errors=True)
    write_json(made_for, str(layout.root))


def _built(layout: Layout) -> list[Path]:
    return [layout.root / "build" / package.name for package in layout.packages()]
