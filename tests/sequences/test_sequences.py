# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Random editing sessions on three buildings: what is shown is always whole and free, and undo is exact.

WALK_SEQUENCES says how many in all; 1000 is the full run, by hand and for releases. `--junitxml=FILE -o
junit_family=xunit1` writes for each batch how many sessions there were and how many edits were accepted and refused.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from sequences.session import Session, Start, started

from walk_bringup.sample import sample_path
from walk_building.pipeline import load_building

pytestmark = pytest.mark.slow

BUILDINGS = ("sample", "duplex.ifc", "small_house.ply")
SEQUENCES = int(os.environ.get("WALK_SEQUENCES", "30"))
BATCHES = 5


@pytest.fixture(scope="module", params=BUILDINGS)
def start(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Start:
    if request.param == "sample":
        path = sample_path()
    else:
        path = request.getfixturevalue("buildings_dir") / request.param
    return started(load_building(path), tmp_path_factory.mktemp("start"))


@pytest.mark.parametrize("batch", range(BATCHES))
def test_any_session_shows_whole_free_paths_and_is_taken_back_exactly(
    start: Start, batch: int, tmp_path: Path, record_property: Callable[[str, object], None]
) -> None:
    wrong: list[str] = []
    accepted = refused = 0
    share = -(-SEQUENCES // len(BUILDINGS))
    for seed in range(batch, share, BATCHES):
        folder = tmp_path / str(seed)
        folder.mkdir()
        session = Session(start, seed, folder)
        session.run(int(np.random.default_rng(seed).integers(2, 9)))
        wrong += session.wrong
        accepted, refused = accepted + session.accepted, refused + session.refused
    counts = {"sessions": len(range(batch, share, BATCHES)), "accepted": accepted, "refused": refused}
    for name, count in {**counts, "objections": len(wrong)}.items():
        record_property(name, count)
    assert not wrong, f"{len(wrong)} objections; the first:\n" + "\n\n".join(wrong[:3])
    assert accepted or share <= batch
