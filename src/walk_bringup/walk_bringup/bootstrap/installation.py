# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Stage 2: the pinned requirements."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Callable

from walk_bringup.bootstrap.command import last_line, run_logged
from walk_bringup.bootstrap.environment import site_packages, venv_environment
from walk_bringup.bootstrap.errors import SetupError
from walk_bringup.bootstrap.layout import Layout
from walk_bringup.bootstrap.machine import Machine
from walk_bringup.bootstrap.progress import StageLine
from walk_bringup.bootstrap.stamps import fingerprint as _fingerprint

_OFFLINE = (
    "NewConnectionError",
    "name resolution",
    "ConnectTimeoutError",
    "ReadTimeoutError",
    "ProxyError",
    "Network is unreachable",
    "Connection refused",
    "Could not fetch URL",
)


def fingerprint(layout: Layout, machine: Machine) -> str:
    """Returns what the installed packages depend on."""
    return _fingerprint(requirements(layout, machine))


def requirements(layout: Layout, machine: Machine) -> list[str]:
    """Returns the pinned requirements; with a ROS installation without the ROS wheels."""
    lines = (line.strip() for line in layout.lock.read_text(encoding="utf-8").splitlines())
    pins = [line for line in lines if line and not line.startswith("#")]
    return [pin for pin in pins if not (machine.has_ros and pin.startswith("ros-"))]


def install(layout: Layout, machine: Machine) -> None:
    """Installs the requirements with pip.

    Raises:
        SetupError: The registry cannot be reached, the disk is full, a package is missing.
    """
    pins = requirements(layout, machine)
    layout.state.mkdir(parents=True, exist_ok=True)
    listing = layout.state / "requirements.txt"
    listing.write_text("\n".join(pins) + "\n", encoding="utf-8")
    _drop_half_installed(layout)
    # The list is complete, so pip need not look for more; what it may ask for is decided here.
    options = ["--no-deps", "--no-input", "--disable-pip-version-check", "--retries", "2", "--timeout", "20"]
    env = venv_environment(layout, os.environ, wheels=not machine.has_ros)
    env.pop("PIP_QUIET", None)
    with StageLine("Python packages", 2 * len(pins)) as line:
        run_logged(
            [layout.python, "-m", "pip", "install", *options, "-r", listing],
            layout.state / "install.log",
            cwd=layout.root,
            env=env,
            on_line=_counter(line),
            explain=explain,
        )
        _try_imports(layout, env)


def explain(output: str) -> str:
    """Returns the reason why pip failed, in a sentence for the user."""
    if "No space left on device" in output:
        return "The disk is full: make room and call again, what is installed is kept."
    if any(sign in output for sign in _OFFLINE):
        return (
            "The Python package registry cannot be reached: check the network and the settings of pip "
            "(pip config list), then call again; what is installed is kept."
        )
    errors = [line for line in output.splitlines() if line.startswith("ERROR:")]
    return f"pip could not install the requirements: {errors[-1][7:] if errors else last_line(output)}"


def _counter(line: StageLine) -> Callable[[str], None]:
    seen = 0

    def on_line(text: str) -> None:
        nonlocal seen
        if text.startswith(("Collecting ", "Requirement already satisfied")):
            seen += 1
            line.update(seen, text.split()[1] if text.startswith("Collecting") else "")
        elif text.startswith("Installing collected packages"):
            line.update(seen, "writing files")

    return on_line


def _drop_half_installed(layout: Layout) -> None:
    # pip unpacks the wheel's own RECORD early and counts a package by it as installed; what it writes last is a
    # RECORD that lists the INSTALLER too, so a package killed half-way is told by that.
    for folder in site_packages(layout):
        for info in folder.glob("*.dist-info"):
            record = info / "RECORD"
            if not record.exists() or "/INSTALLER," not in record.read_text(encoding="utf-8"):
                shutil.rmtree(info)


def _try_imports(layout: Layout, env: dict[str, str]) -> None:
    modules = "numpy, scipy, numba, click, colcon_core, rclpy"
    done = subprocess.run([str(layout.python), "-c", f"import {modules}"], env=env, capture_output=True, text=True)
    if done.returncode != 0:
        raise SetupError(
            f"the installed packages do not work: {last_line(done.stderr)}. Remove {layout.venv} and call again."
        )
