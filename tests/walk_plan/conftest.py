# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

from pathlib import Path

import pytest
import trimesh
from scenes import two_rooms

from walk_plan.options import PlanConfig
from walk_plan.pipeline import make_walkthrough
from walk_plan.stages import StageClock
from walk_plan.walkthrough import Walkthrough


@pytest.fixture(scope="session")
def rooms_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two rooms and a door as a file in metres."""
    path = tmp_path_factory.mktemp("building") / "two_rooms.ply"
    trimesh.util.concatenate(two_rooms()).export(path)
    return path


@pytest.fixture(scope="session")
def walkthrough(rooms_file: Path) -> Walkthrough:
    """The plan of the two rooms."""
    return make_walkthrough(rooms_file, PlanConfig(), StageClock(lambda stage, fraction: None))
