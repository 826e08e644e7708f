# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A project whose building has changed since it was saved: what no longer fits is told and left out."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from scenes import box, two_rooms

from walk_bringup.projects.documents import Reference, SavedTour, read_tour, write_reference, write_tour
from walk_bringup.projects.files import Layout, write
from walk_bringup.projects.journals import begun_with, read_journal
from walk_bringup.projects.opening import Opened, open_project
from walk_bringup.projects.settings import parameters_text
from walk_building.pipeline import load_building
from walk_sequencer.changes import lock_entry, suggested_entry
from walk_sequencer.history import History

PLACES = [[1.0, 1.0, 1.6], [3.0, 3.0, 1.6], [7.0, 2.0, 1.6]]
ROOMS = {0: "Kitchen", 1: "Kitchen", 2: "Hall"}


def build(file: Path, *more: trimesh.Trimesh) -> None:
    trimesh.util.concatenate([*two_rooms(), *more]).export(file)


@pytest.fixture
def saved(tmp_path: Path) -> tuple[Path, Layout]:
    """A building of two rooms and a project of it with three keypoints, the first one locked."""
    file = tmp_path / "house.ply"
    build(file)
    building = load_building(file)
    history = History()
    places = building.from_file(PLACES)
    history.apply(suggested_entry(places, [[0.0, 0.0, 0.0, 1.0]] * 3))
    history.apply(lock_entry(0, True, "anna"))
    layout = Layout(folder=tmp_path / "project", tour="main")
    tour = SavedTour(
        building_hash=building.hash, offset_m=building.model.offset_m, keypoints=history.present, rooms=ROOMS
    )
    write(layout.folder, layout.parameters_file, parameters_text({}).encode())
    write(layout.folder, layout.journal_file, begun_with(history.present))
    write(layout.folder, layout.tour_file, write_tour(tour, {}))
    reference = Reference.to(file, layout.folder, building.hash)
    write(layout.folder, layout.project_file, write_reference(reference, {}))
    return file, layout


def ids_to_edit(opened: Opened) -> tuple[int, ...]:
    """Returns the keypoints that the graph would go on with."""
    (journal,) = opened.state_dir.glob("*.jsonl")
    return read_journal(journal)[1].ids


def test_the_same_building_is_opened_without_a_word_about_it(saved: tuple[Path, Layout]) -> None:
    _, layout = saved
    opened = open_project(layout)
    assert opened.notes == ("the tour 'main': 3 keypoints in house.ply.",)
    assert ids_to_edit(opened) == (0, 1, 2)


def test_a_wall_through_a_keypoint_is_told_and_the_keypoint_left_out(saved: tuple[Path, Layout]) -> None:
    file, layout = saved
    build(file, box((0.9, 0.0, 0.0), (1.1, 2.2, 3.0)))
    opened = open_project(layout)
    counted, changed, gone, kept = opened.notes
    assert counted == "the tour 'main': 3 keypoints in house.ply."
    assert changed.startswith("the building has changed since the tour was saved")
    assert gone.startswith(
        "keypoint 0 (Kitchen) no longer fits and is left out: no room for the walker's body, as in a wall"
    )
    assert "main.yaml keeps it until the tour is saved again" in kept
    assert ids_to_edit(opened) == (1, 2)
    assert read_tour(layout).keypoints.ids == (0, 1, 2)


def test_a_door_that_is_walled_up_leaves_out_the_room_behind_it(saved: tuple[Path, Layout]) -> None:
    file, layout = saved
    build(file, box((4.0, 1.0, 0.0), (4.2, 3.0, 3.0)))
    opened = open_project(layout)
    left = {note.partition(" no longer")[0] for note in opened.notes if "no longer fits" in note}
    # Either side of the wall may be the building's main part.
    assert left in ({"keypoint 2 (Hall)"}, {"keypoint 0 (Kitchen)", "keypoint 1 (Kitchen)"})
    assert all("not connected on foot" in note for note in opened.notes if "no longer fits" in note)


def test_keypoints_stay_where_they_are_in_a_building_that_has_grown(saved: tuple[Path, Layout]) -> None:
    file, layout = saved
    build(file, box((-20.0, -20.0, -0.2), (-10.0, -10.0, 0.0)))
    opened = open_project(layout)
    assert "the building has changed" in opened.notes[1]
    assert len(opened.notes) == 2
    (journal,) = opened.state_dir.glob("*.jsonl")
    places = read_journal(journal)[1].positions
    np.testing.assert_allclose(load_building(file).to_file(places), PLACES, atol=1e-9)
