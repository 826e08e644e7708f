# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What speaks for and against setting a checkout up on a machine, one check a fact."""

from __future__ import annotations

import dataclasses

from walk_bringup.bootstrap.layout import Layout
from walk_bringup.bootstrap.machine import NEEDED_BYTES, Machine
from walk_bringup.bootstrap.stages import STAGES


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Check:
    """The outcome of one check."""

    name: str
    ok: bool
    required: bool  # whether nothing can be set up without it
    state: str  # what there is
    advice: str = ""  # what to do, where it is not ok


def machine_checks(machine: Machine, *, installed: bool) -> list[Check]:
    """Returns the checks that a machine has to pass before a set-up is tried."""
    return [
        _python(machine),
        _venv_module(machine),
        _architecture(machine),
        _ros(machine),
        _disk(machine, installed),
        _folder(machine),
    ]


def all_checks(layout: Layout, machine: Machine) -> list[Check]:
    """Returns everything `./walk doctor` reports."""
    missing = [stage.name for stage in STAGES if not stage.is_done(layout, machine)]
    installed = "install" not in missing
    return [*machine_checks(machine, installed=installed), _build(missing), _buildings(layout)]


def _python(machine: Machine) -> Check:
    version = ".".join(map(str, machine.python_version))
    return Check(
        name="Python",
        required=True,
        ok=(3, 11) <= machine.python_version[:2] <= (3, 13),
        state=f"{version}, {machine.python}",
        advice="install Python 3.11, 3.12 or 3.13, or name one: WALK_PYTHON=python3.12 ./walk …",
    )


def _venv_module(machine: Machine) -> Check:
    major, minor, _ = machine.python_version
    return Check(
        name="venv module",
        required=True,
        ok=machine.has_venv,
        state="there" if machine.has_venv else "missing",
        advice=f"install it, on Debian and Ubuntu: sudo apt install python{major}.{minor}-venv",
    )


def _architecture(machine: Machine) -> Check:
    libc = "glibc {}.{}".format(*machine.libc) if machine.libc > (0, 0) else "no glibc"
    return Check(
        name="architecture",
        required=True,
        ok=machine.has_wheels or machine.has_ros,
        state=f"{machine.system} {machine.architecture}, {libc}",
        advice="the ROS wheels need Linux on x86_64 with glibc 2.28 or newer; elsewhere install ROS 2 Jazzy, "
        "source it (. /opt/ros/jazzy/setup.bash) and call again",
    )


def _ros(machine: Machine) -> Check:
    if machine.has_ros:
        state = "the sourced installation of ROS 2 Jazzy is used"
    elif machine.ros_distro:
        state = f"ROS 2 {machine.ros_distro} is sourced" + ("" if machine.has_rclpy else ", without an rclpy to import")
    else:
        state = "wheels from the registry (no installation is sourced)"
    return Check(
        name="ROS 2",
        required=True,
        ok=machine.has_ros or not machine.ros_distro,
        state=state,
        advice="only Jazzy is supported: source /opt/ros/jazzy/setup.bash with the Python it was made for, "
        "or start from a shell in which no ROS is sourced to use the wheels",
    )


def _disk(machine: Machine, installed: bool) -> Check:
    free = machine.free_bytes / 1e9
    return Check(
        name="disk",
        required=not installed,
        ok=installed or machine.free_bytes >= NEEDED_BYTES,
        state=f"{free:.1f} GB free",
        advice=f"the set-up needs {NEEDED_BYTES / 1e9:.0f} GB: make room, or move the checkout to a larger disk",
    )


def _folder(machine: Machine) -> Check:
    return Check(
        name="folder",
        required=True,
        ok=machine.writable,
        state="writable" if machine.writable else "read-only",
        advice="the set-up writes .venv, build and install into the checkout: copy it to a folder of your own",
    )


def _build(missing: list[str]) -> Check:
    return Check(
        name="set-up",
        required=False,
        ok=not missing,
        state="complete" if not missing else "to do: " + ", ".join(missing),
        advice="any command does it, ./walk setup nothing else",
    )


def _buildings(layout: Layout) -> Check:
    found = layout.buildings.is_dir()
    return Check(
        name="buildings",
        required=False,
        ok=found,
        state=f"{layout.buildings}" + ("" if found else " is not there"),
        advice="only tests and measurements on real buildings need it; name the folder in WALK_BUILDINGS",
    )
