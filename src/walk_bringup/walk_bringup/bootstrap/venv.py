# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Stage 1: the virtual environment."""

from __future__ import annotations

import os
import shutil
import subprocess

from walk_bringup.bootstrap.environment import site_packages
from walk_bringup.bootstrap.errors import SetupError
from walk_bringup.bootstrap.layout import Layout
from walk_bringup.bootstrap.machine import Machine
from walk_bringup.bootstrap.progress import StageLine
from walk_bringup.bootstrap.stamps import fingerprint as _fingerprint


def fingerprint(layout: Layout, machine: Machine) -> str:
    """Returns what the environment depends on: where it lies, the kind of ROS, and a Python the user names."""
    version = ".".join(map(str, machine.python_version[:2])) if os.environ.get("WALK_PYTHON") else _version(layout)
    return _fingerprint([str(layout.root), "ros" if machine.has_ros else "wheels", version])


def make(layout: Layout, machine: Machine) -> None:
    """Makes the environment, or keeps one that is already right.

    Raises:
        SetupError: Python cannot make it, or it was made with a ROS installation that is not sourced now.
    """
    _refuse_unsourced(layout, machine)
    if _usable(layout, machine):
        return
    with StageLine("Python environment"):
        if layout.venv.exists():
            shutil.rmtree(layout.venv)
        command = [machine.python, "-m", "venv", *(["--system-site-packages"] if machine.has_ros else [])]
        done = subprocess.run([*command, str(layout.venv)], capture_output=True, text=True)
        if done.returncode != 0:
            reason = (done.stderr.strip() or done.stdout.strip()).splitlines()[:1]
            raise SetupError(f"{machine.python} cannot make {layout.venv}: {''.join(reason)}")


def _version(layout: Layout) -> str:
    folders = site_packages(layout)
    return folders[0].parent.name.removeprefix("python") if folders else ""


def _with_ros(layout: Layout) -> bool:
    config = layout.venv / "pyvenv.cfg"
    return config.exists() and "include-system-site-packages = true" in config.read_text(encoding="utf-8")


def _refuse_unsourced(layout: Layout, machine: Machine) -> None:
    if layout.venv.exists() and _with_ros(layout) and not machine.has_ros:
        raise SetupError(
            "the set-up was made with a ROS 2 Jazzy installation that is not sourced here: "
            "run '. /opt/ros/jazzy/setup.bash' first, or remove .venv to go on with wheels."
        )


def _usable(layout: Layout, machine: Machine) -> bool:
    # A copied environment still points to where it came from, an interrupted one has no pip.
    if not layout.python.exists() or _with_ros(layout) != machine.has_ros:
        return False
    if os.environ.get("WALK_PYTHON") and _version(layout) != ".".join(map(str, machine.python_version[:2])):
        return False
    script = layout.venv / "bin" / "pip"
    if not script.exists() or str(layout.venv) not in script.read_text(encoding="utf-8", errors="replace"):
        return False
    return subprocess.run([str(layout.python), "-c", "import pip"], capture_output=True).returncode == 0
