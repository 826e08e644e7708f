# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="session")
def buildings_dir() -> Path:
    """The folder of real buildings: WALK_BUILDINGS, else shared/buildings beside the checkout."""
    folder = Path(os.environ.get("WALK_BUILDINGS") or ROOT.parent / "shared" / "buildings")
    if not folder.is_dir():
        pytest.skip(f"the real buildings are not in {folder}; WALK_BUILDINGS names the folder")
    return folder
