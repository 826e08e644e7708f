# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Setting a checkout up: only what is not done yet, one process at a time."""

from __future__ import annotations

import fcntl
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from walk_bringup.bootstrap.checks import machine_checks
from walk_bringup.bootstrap.errors import SetupError
from walk_bringup.bootstrap.layout import Layout
from walk_bringup.bootstrap.machine import Machine
from walk_bringup.bootstrap.stages import STAGES


def set_up(layout: Layout, machine: Machine) -> bool:
    """Brings the checkout up to date and returns whether there was anything to do.

    Raises:
        SetupError: The machine is unfit or a stage failed.
    """
    if all(stage.is_done(layout, machine) for stage in STAGES):
        return False
    installed = all(stage.is_done(layout, machine) for stage in STAGES[:2])
    for check in machine_checks(machine, installed=installed):
        if check.required and not check.ok:
            raise SetupError(f"{check.name}: {check.state}; {check.advice}.")
    with _alone(layout):
        for stage in STAGES:
            if not stage.is_done(layout, machine):
                stage.do(layout, machine)
    return True


@contextmanager
def _alone(layout: Layout) -> Iterator[None]:
    layout.state.mkdir(parents=True, exist_ok=True)
    with (layout.state / "setup.lock").open("w") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            print("walk: another process is setting this checkout up; waiting for it.", file=sys.stderr)
            fcntl.flock(file, fcntl.LOCK_EX)
        yield
