# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk run`: what `ros2 run` does, where there is no `ros2`."""

from __future__ import annotations

import os
import sys

import click

from walk_bringup.bootstrap.commands import COMMANDS
from walk_bringup.bootstrap.errors import SetupError
from walk_bringup.cli.executables import executables, find_executable, packages_with_executables

# Everything behind the executable is its own, --help included.
_PASS_ON = {"ignore_unknown_options": True, "allow_interspersed_args": False}
_OF_ROS = ("-p", "--param", "-r", "--remap", "--params-file", "--log-level")
# They have no arguments of their own, and ROS passes over what is not behind --ros-args.
_NODES = ("importance", "sequencer", "trajopt", "vr_bridge", "viewer")


@click.command(short_help=COMMANDS["run"], context_settings=_PASS_ON)
@click.argument("package", required=False)
@click.argument("executable", required=False)
@click.argument("arguments", nargs=-1, type=click.UNPROCESSED)
def run(package: str | None, executable: str | None, arguments: tuple[str, ...]) -> int:
    """Start one executable of a package; without names, list them.

    \b
    Examples:
      ./walk run
      ./walk run walk_importance importance --ros-args -p building:=building.ifc
      ./walk run walk_trajopt trajopt --ros-args -r __ns:=/second -p building:=building.ifc
    """
    if package is None:
        for name in packages_with_executables():
            print(f"{name}: {', '.join(sorted(executables(name)))}")
        return 0
    path = find_executable(package, executable or "")
    before = arguments[: arguments.index("--ros-args")] if "--ros-args" in arguments else arguments
    astray = next((flag for flag in before if flag in _OF_ROS), None)
    if astray is not None and executable in _NODES:
        raise SetupError(
            f"{astray} is an argument of ROS and stands behind --ros-args: "
            f"./walk run {package} {executable} --ros-args {' '.join(arguments)}"
        )
    sys.stdout.flush()
    return os.execv(path, [str(path), *arguments])
