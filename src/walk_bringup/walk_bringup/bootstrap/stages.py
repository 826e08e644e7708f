# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The stages of the set-up, in order; each knows whether it is done and how to do it."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path

from walk_bringup.bootstrap import build, installation, kernels, page, venv
from walk_bringup.bootstrap.layout import Layout
from walk_bringup.bootstrap.machine import Machine
from walk_bringup.bootstrap.stamps import read_json, write_json


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Stage:
    """One stage: it is done when its stamp holds the fingerprint of what it depends on."""

    name: str
    stamp: Callable[[Layout], Path]
    fingerprint: Callable[[Layout, Machine], str]
    evidence: Callable[[Layout], Path]  # a file that is there when the stage is done
    run: Callable[[Layout, Machine], None]

    def is_done(self, layout: Layout, machine: Machine) -> bool:
        """Returns whether nothing is to do."""
        if not self.evidence(layout).exists():
            return False
        return read_json(self.stamp(layout)) == self.fingerprint(layout, machine)

    def do(self, layout: Layout, machine: Machine) -> None:
        """Does the stage; what an interruption leaves carries no stamp and is done again."""
        self.stamp(layout).unlink(missing_ok=True)
        self.run(layout, machine)
        write_json(self.stamp(layout), self.fingerprint(layout, machine))


STAGES = (
    Stage(
        name="environment",
        stamp=lambda layout: layout.venv / "walk-environment.json",
        fingerprint=venv.fingerprint,
        evidence=lambda layout: layout.python,
        run=venv.make,
    ),
    # The stamps of what lies in .venv lie there too, so that they go when it goes.
    Stage(
        name="install",
        stamp=lambda layout: layout.venv / "walk-install.json",
        fingerprint=installation.fingerprint,
        evidence=lambda layout: layout.venv / "bin" / "colcon",
        run=installation.install,
    ),
    # Before the packages are built, for one of them carries the page.
    Stage(
        name="page",
        stamp=lambda layout: layout.state / "page.json",
        fingerprint=page.fingerprint,
        evidence=lambda layout: layout.page,
        run=page.build,
    ),
    Stage(
        name="build",
        stamp=lambda layout: layout.state / "build.json",
        fingerprint=build.fingerprint,
        evidence=lambda layout: layout.install / "local_setup.sh",
        run=build.build,
    ),
    Stage(
        name="kernels",
        stamp=lambda layout: layout.state / "kernels.json",
        fingerprint=kernels.fingerprint,
        evidence=lambda layout: layout.environment,
        run=kernels.compile_all,
    ),
)
