# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From a project on disk to what a graph starts with: building, parameters, and a journal that begins with the tour."""

from __future__ import annotations

import dataclasses
from pathlib import Path

from walk_bringup.projects.documents import SAMPLE, SavedTour, read_reference, read_tour
from walk_bringup.projects.errors import ProjectError
from walk_bringup.projects.files import Layout, put_aside, write
from walk_bringup.projects.fit import misfits
from walk_bringup.projects.journals import begun_with, edits_in, read_journal, same
from walk_bringup.projects.settings import read_settings
from walk_bringup.sample.location import sample_path
from walk_building.building import Building
from walk_building.config import Config
from walk_building.model import LoadOptions
from walk_building.pipeline import load_building
from walk_building.walker import Walker
from walk_sequencer.config import SequencerConfig
from walk_sequencer.editing import EditingConfig
from walk_sequencer.keypoints import Keypoints
from walk_sequencer.whole import without
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.kept import Kept


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Opened:
    """What a graph is started with."""

    building: Path | None  # its file, None for the sample
    parameters_file: Path
    state_dir: Path
    notes: tuple[str, ...]  # sentences for the user


def open_project(layout: Layout, building: Path | None = None, *, as_saved: bool = False) -> Opened:
    """Makes ready the folder in which the tour is edited, and says what has changed since it was saved.

    Args:
        layout: The project and the tour.
        building: The building's file where it has moved.
        as_saved: Begin with the tour as it was saved, also where edits were made since; they are put into `backup`.

    Raises:
        ProjectError: It is no project, has no such tour, is damaged or of a newer version.
        BuildingError: The building's file cannot be used.
    """
    reference, tour = read_reference(layout), read_tour(layout)
    settings = read_settings(layout.parameters_file)
    if building is not None and not building.is_file():
        raise ProjectError(building, "there is no such building")
    file = building.resolve() if building is not None else reference.found(layout.folder)
    options, walker = settings["load"], settings["walker"]
    assert isinstance(options, LoadOptions) and isinstance(walker, Walker)
    built = load_building(file or sample_path(), options, walker)
    name = file.name if file is not None else SAMPLE
    notes = [f"the tour {layout.tour!r}: {len(tour.keypoints.ids)} keypoints in {name}."]
    journal, kept = read_journal(layout.journal_file)
    if built.hash != tour.building_hash:
        notes.append(f"the building has changed since the tour was saved (or its load options, or the walker): {name}.")
    if built.hash != tour.building_hash or not (kept.edited and same(kept, tour.keypoints)):
        keypoints, gone = _fitting(built, tour, settings)
        notes += gone
        if gone:
            them = "it" if len(gone) == 1 else "them"
            notes.append(f"{layout.tour_file.name} keeps {them} until the tour is saved again.")
        journal = begun_with(keypoints)
    try:
        notes += _make_ready(layout, built, journal, settings, as_saved=as_saved)
    except OSError as error:
        raise ProjectError(layout.state_dir, f"cannot be written: {error.strerror or error}") from error
    return Opened(
        building=file,
        parameters_file=layout.parameters_file,
        state_dir=layout.state_dir.resolve(),
        notes=tuple(notes),
    )


def _fitting(built: Building, tour: SavedTour, settings: dict[str, Config]) -> tuple[Keypoints, list[str]]:
    """Returns the keypoints that fit the building, and a sentence for each that does not."""
    keypoints = tour.keypoints
    shift = tour.offset_m - built.model.offset_m
    if shift.any():
        # The model's own coordinates begin elsewhere when its outermost parts have changed.
        moved, looked = keypoints.positions + shift, keypoints.look_at + shift
        keypoints = dataclasses.replace(keypoints, positions=moved, look_at=looked)
    sequencer, editing = settings["sequencer"], settings["editing"]
    assert isinstance(sequencer, SequencerConfig) and isinstance(editing, EditingConfig)
    reasons = misfits(built, keypoints, sequencer, editing)
    notes = [f"{tour.name_of(i)} no longer fits and is left out: {reason}." for i, reason in reasons.items()]
    return without(keypoints, frozenset(reasons)), notes


def _make_ready(
    layout: Layout, built: Building, journal: bytes, settings: dict[str, Config], *, as_saved: bool
) -> list[str]:
    """Writes the journal that the sequencer goes on with, unless there is one that goes on from the tour already."""
    live = layout.state_dir / f"{built.hash}.jsonl"
    there = live.read_bytes() if live.exists() else b""
    if there.startswith(journal) and not as_saved:
        whole = read_journal(live)[0]
        edits = edits_in(whole[len(journal) :])
        return [f"{edits} edits made since it was saved are kept; --as-saved opens it without."] if edits else []
    notes = []
    if there and there != journal:
        aside = put_aside(layout.folder, live)
        notes.append(f"the edits made since it was saved are in {aside}.")
        live.unlink()
    write(layout.folder, live, journal)
    config = settings["trajopt"]
    assert isinstance(config, TrajoptConfig)
    shown = Kept(layout.state_dir, built.hash, config).file
    shown.unlink(missing_ok=True)
    if layout.path_file.exists():
        write(layout.folder, shown, layout.path_file.read_bytes())
    return notes
