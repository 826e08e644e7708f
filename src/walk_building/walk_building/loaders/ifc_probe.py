# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Tries a damaged IFC file in a process of its own, because the engine can crash on it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from walk_building.errors import BuildingError

_CHILD = "import sys; from walk_building.loaders.ifc import tessellates; sys.exit(not tessellates(sys.argv[1]))"
# Far longer than a building takes: a damaged one may also never end.
_LIMIT_S = 300.0


def check_survives(path: Path) -> None:
    """Refuses a file whose geometry ends the engine's process.

    Raises:
        BuildingError: The trial crashed, failed or did not end within five minutes.
    """
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(entry for entry in sys.path if entry)}
    reason = "is damaged: it names instances that are not there, and the IFC engine {} on it; export it again"
    try:
        done = subprocess.run(
            [sys.executable, "-c", _CHILD, str(path.absolute())],
            env=environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=_LIMIT_S,
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        raise BuildingError(path, reason.format("does not end")) from error
    if done.returncode != 0:
        raise BuildingError(path, reason.format("fails"))
