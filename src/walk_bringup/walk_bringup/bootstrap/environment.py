# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The environment of the built packages: worked out once after a build, applied at every start."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Mapping
from pathlib import Path

from walk_bringup.bootstrap.errors import SetupError
from walk_bringup.bootstrap.layout import Layout
from walk_bringup.bootstrap.stamps import read_json, write_json

_VARIABLES = ("AMENT_PREFIX_PATH", "COLCON_PREFIX_PATH", "PYTHONPATH")


def venv_environment(layout: Layout, base: Mapping[str, str], *, wheels: bool) -> dict[str, str]:
    """Returns an environment in which the virtual environment comes first.

    Args:
        layout: The checkout.
        base: The environment to start from.
        wheels: Whether ROS comes from wheels; their resources are then found in the virtual environment.
    """
    env = dict(base)
    # Left over from a process started by the wheels, it would keep them from setting LD_LIBRARY_PATH.
    env.pop("_ROS_WHEELS_BOOTSTRAP_COMPLETE", None)
    env.pop("PYTHONHOME", None)
    env["VIRTUAL_ENV"] = str(layout.venv)
    env["PATH"] = _joined([str(layout.venv / "bin")], env.get("PATH", os.defpath))
    if wheels:
        env["AMENT_PREFIX_PATH"] = _joined([str(layout.venv)], env.get("AMENT_PREFIX_PATH", ""))
    return env


def store(layout: Layout, *, wheels: bool) -> None:
    """Asks the set-up script that colcon wrote what it adds to the environment, and keeps the answer."""
    bare = {name: value for name, value in os.environ.items() if name not in _VARIABLES}
    env = venv_environment(layout, bare, wheels=False)
    script = layout.install / "local_setup.sh"
    done = subprocess.run(
        ["sh", "-c", '. "$0" && env -0', str(script)], env=env, cwd=layout.root, capture_output=True, text=True
    )
    if done.returncode != 0:
        raise SetupError(f"{script} does not work: {done.stderr.strip()}. Remove build and install and call again.")
    after = dict(item.split("=", 1) for item in done.stdout.split("\0") if "=" in item)
    added = {name: [part for part in after.get(name, "").split(os.pathsep) if part] for name in _VARIABLES}
    write_json(layout.environment, {"wheels": wheels, "added": added})


def built_environment(layout: Layout, base: Mapping[str, str]) -> dict[str, str]:
    """Returns the environment in which the built packages run.

    Nodes find each other on this machine only, and BLAS keeps to one thread, unless `base` says otherwise.

    Raises:
        SetupError: Nothing is built.
    """
    stored = read_json(layout.environment)
    if not isinstance(stored, dict):
        raise SetupError(f"{layout.environment} is missing or damaged; run ./walk setup.")
    env = venv_environment(layout, base, wheels=bool(stored["wheels"]))
    for name, parts in stored["added"].items():
        env[name] = _joined(parts, env.get(name, ""))
    env.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    # At the sizes met here the threads of BLAS cost more than they bring.
    env.setdefault("OPENBLAS_NUM_THREADS", "1")
    env["WALK_ROOT"] = str(layout.root)
    return env


def _joined(first: list[str], rest: str) -> str:
    others = [part for part in rest.split(os.pathsep) if part and part not in first]
    return os.pathsep.join([*first, *others])


def site_packages(layout: Layout) -> list[Path]:
    """Returns the folders that the virtual environment installs into."""
    return sorted(layout.venv.glob("lib/python3.*/site-packages"))
