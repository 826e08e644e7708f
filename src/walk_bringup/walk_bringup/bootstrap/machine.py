# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What the machine has: asked once, so that tests can make up machines of their own."""

from __future__ import annotations

import dataclasses
import importlib.util
import os
import platform
import shutil
import sys
from pathlib import Path

NEEDED_BYTES = 5_000_000_000
"""The environment takes 2.7 GB, pip's cache and temporary files about as much."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Machine:
    """The facts that decide whether and how a checkout can be set up."""

    python: str  # path of the interpreter that asks, outside of any virtual environment
    python_version: tuple[int, int, int]
    system: str  # "Linux"
    architecture: str  # "x86_64"
    libc: tuple[int, int]  # version of glibc, (0, 0) where it is another
    has_venv: bool  # Debian ships Python without it
    free_bytes: int
    writable: bool
    ros_distro: str  # of the sourced ROS installation, "" if none is
    has_rclpy: bool  # importable from outside of the virtual environment

    @property
    def has_ros(self) -> bool:
        """Whether a ROS 2 Jazzy installation is sourced that this Python can use."""
        return self.ros_distro == "jazzy" and self.has_rclpy

    @property
    def has_wheels(self) -> bool:
        """Whether there are ROS wheels for this machine."""
        return self.system == "Linux" and self.architecture == "x86_64" and self.libc >= (2, 28)


def look(root: Path) -> Machine:
    """Returns what this machine has, as seen by this Python."""
    return Machine(
        python=getattr(sys, "_base_executable", sys.executable),
        python_version=sys.version_info[:3],
        system=platform.system(),
        architecture=platform.machine(),
        libc=_glibc(),
        has_venv=importlib.util.find_spec("ensurepip") is not None,
        free_bytes=shutil.disk_usage(root).free,
        writable=os.access(root, os.W_OK),
        ros_distro=os.environ.get("ROS_DISTRO", ""),
        has_rclpy=_sourced_rclpy(),
    )


def _glibc() -> tuple[int, int]:
    name, version = platform.libc_ver()
    numbers = version.split(".")
    return (int(numbers[0]), int(numbers[1])) if name == "glibc" and len(numbers) >= 2 else (0, 0)


def _sourced_rclpy() -> bool:
    # A look for the files: importing rclpy takes a second, and importing the wheels starts Python anew.
    found = importlib.util.find_spec("rclpy")
    prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    origin = found.origin if found else None
    return origin is not None and any(prefix and Path(origin).is_relative_to(prefix) for prefix in prefixes)
