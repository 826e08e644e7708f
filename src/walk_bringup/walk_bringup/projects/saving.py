# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From what a running graph holds to a project on disk."""

from __future__ import annotations

import dataclasses
import importlib.metadata
import time
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from walk_bringup.projects.documents import Reference, SavedTour, read_reference, write_reference, write_tour
from walk_bringup.projects.errors import ProjectError
from walk_bringup.projects.files import Layout, write
from walk_bringup.projects.journals import begun_with, read_journal
from walk_bringup.projects.settings import NodeValues, parameters_text, read_settings
from walk_bringup.sample.location import sample_path
from walk_building.loaders import load_model
from walk_building.model import LoadOptions
from walk_sequencer.keypoints import Keypoints
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.kept import Kept


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class GraphState:
    """What a running graph holds."""

    building: Path | None  # its file, None for the sample
    building_hash: str
    shown: Keypoints  # as its topics show them
    rooms: Mapping[int, str]  # by identity
    left_out: Mapping[int, str]  # reasons by identity
    parameters: NodeValues


def save_project(layout: Layout, state: GraphState, *, force: bool = False) -> Keypoints:
    """Writes the project's files, each whole or not at all; returns the keypoints saved.

    The journal is the truth where it says what the topics show: it has the wished places bit for bit, and the past.

    Args:
        layout: Where to, and the tour's name; what was there is kept in `backup`.
        state: What is saved.
        force: Write into a project of another building.

    Raises:
        ProjectError: The folder holds a project of another building, or cannot be written.
    """
    state_dir = Path(str(state.parameters.get("sequencer", {}).get("state_dir", "")))
    if layout.project_file.exists() and not force:
        _check_building(layout, state, state_dir)
    journal, keypoints = read_journal(state_dir / f"{state.building_hash}.jsonl")
    if not _agrees(keypoints, state.shown):
        keypoints, journal = state.shown, begun_with(state.shown)
    text = parameters_text(state.parameters)
    write(layout.folder, layout.parameters_file, text.encode())
    settings = read_settings(layout.parameters_file)
    options = settings["load"]
    assert isinstance(options, LoadOptions)
    offset_m = load_model(state.building or sample_path(), options).offset_m
    tour = SavedTour(building_hash=state.building_hash, offset_m=offset_m, keypoints=keypoints, rooms=state.rooms)
    # The tour's own file after what hangs on it: a crash in between leaves the earlier tour as it was.
    write(layout.folder, layout.journal_file, journal)
    _write_path(layout, state, settings["trajopt"])
    write(layout.folder, layout.tour_file, write_tour(tour, state.left_out))
    reference = Reference.to(state.building, layout.folder, state.building_hash)
    saved = {"at": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()), "by": f"walk {program_version()}"}
    write(layout.folder, layout.project_file, write_reference(reference, saved))
    return keypoints


def program_version() -> str:
    """Returns the version of this program, "unknown" where it runs without being installed."""
    try:
        return importlib.metadata.version("walk_bringup")
    except importlib.metadata.PackageNotFoundError:
        return "unknown"


def _check_building(layout: Layout, state: GraphState, state_dir: Path) -> None:
    """Refuses to mix buildings; a graph that was opened from the project may bring a changed one."""
    before = read_reference(layout)
    opened_here = layout.folder.resolve() in state_dir.resolve().parents
    if before.hash != state.building_hash and not opened_here:
        raise ProjectError(
            layout.folder,
            f"is a project of another building, {before.name}, or of other load options or another walker; "
            "choose another folder, or --force to save into it all the same",
        )


def _agrees(kept: Keypoints, shown: Keypoints) -> bool:
    """Returns whether a journal says what the graph shows: those on the tour, for the others have no arrow."""
    on_tour = frozenset(shown.order)
    ends = tuple(end if end in on_tour else -1 for end in (kept.start, kept.end))
    if (kept.order, kept.locked & on_tour, ends) != (shown.order, shown.locked, (shown.start, shown.end)):
        return False
    mine, theirs = [kept.index(i) for i in shown.order], [shown.index(i) for i in shown.order]
    return all(
        np.array_equal(getattr(kept, name)[mine], getattr(shown, name)[theirs], equal_nan=True)
        for name in ("quat_xyzw", "dwell_s", "look_at")
    )


def _write_path(layout: Layout, state: GraphState, config: object) -> None:
    """Keeps the path as it is shown: solved anew it may lie elsewhere, for it depends on the edits before it."""
    folder = str(state.parameters.get("trajopt", {}).get("state_dir", ""))
    assert isinstance(config, TrajoptConfig)
    file = Kept(Path(folder), state.building_hash, config).file
    try:
        data = file.read_bytes() if folder else b""
    except OSError:
        data = b""
    if data:
        write(layout.folder, layout.path_file, data)
    else:
        layout.path_file.unlink(missing_ok=True)
