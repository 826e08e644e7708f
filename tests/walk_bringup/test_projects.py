# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest
import yaml

from walk_bringup.projects.documents import Reference, SavedTour, read_reference, read_tour, write_reference, write_tour
from walk_bringup.projects.errors import ProjectError
from walk_bringup.projects.files import Layout, only_one, write
from walk_bringup.projects.journals import begun_with, edits_in, read_journal, same
from walk_bringup.projects.settings import parameters_text, read_settings
from walk_sequencer.changes import dwell_entry, insert_entry, lock_entry, suggested_entry
from walk_sequencer.history import History
from walk_sequencer.keypoints import Keypoints

TURN = [0.0, 0.0, 0.6, 0.8]


def _keypoints() -> Keypoints:
    history = History()
    history.apply(suggested_entry(np.random.default_rng(1).normal(size=(3, 3)), [TURN] * 3))
    history.apply({"kind": "order", "ids": [2, 0, 1]})
    history.apply(insert_entry(3, 1, [0.1, 0.2, 1.0 / 3.0], TURN, "anna"))
    history.apply(dwell_entry(0, 2.5, "anna"))
    history.apply(lock_entry(1, True, "anna"))
    return history.present


def _tour(keypoints: Keypoints) -> SavedTour:
    offset = np.array([1e5 / 3, 0.0, -2.0])
    return SavedTour(building_hash="ab", offset_m=offset, keypoints=keypoints, rooms={0: "Küche"})


def test_a_tour_is_read_as_it_was_written_bit_for_bit(tmp_path: Path) -> None:
    layout = Layout(folder=tmp_path, tour="main")
    write(tmp_path, layout.tour_file, write_tour(_tour(_keypoints()), {}))
    again = read_tour(layout)
    assert same(again.keypoints, _keypoints())
    np.testing.assert_array_equal(again.offset_m, _tour(_keypoints()).offset_m)
    assert again.name_of(0) == "keypoint 0 (Küche)"
    moved = dataclasses.replace(_keypoints(), order=(0, 2, 3, 1))
    assert not same(moved, _keypoints())


def test_a_journal_begun_with_a_tour_gives_the_same_tour_and_counts_later_edits(tmp_path: Path) -> None:
    path = tmp_path / "j.jsonl"
    begun = begun_with(_keypoints())
    path.write_bytes(begun + json.dumps(dict(lock_entry(0, True, "bo"))).encode() + b'\n{"kind": "lo')
    text, keypoints = read_journal(path)
    assert keypoints.locked == {0, 1}
    assert edits_in(text[len(begun) :]) == 1
    assert path.read_bytes().endswith(b'"lo')  # a journal that another writes is left as it is


def test_what_was_there_is_kept_and_no_part_stays_behind(tmp_path: Path) -> None:
    layout = Layout(folder=tmp_path, tour="main")
    for text in (b"one", b"two", b"two", b"three"):
        write(tmp_path, layout.journal_file, text)
    assert layout.journal_file.read_bytes() == b"three"
    assert sorted(f.read_bytes() for f in (tmp_path / "backup").iterdir()) == [b"one", b"two"]
    assert not list(tmp_path.rglob("*.part"))


def test_damaged_and_newer_files_are_one_sentence(tmp_path: Path) -> None:
    layout = Layout(folder=tmp_path, tour="main")
    with pytest.raises(ProjectError, match="is no project"):
        read_reference(layout)
    reference = Reference.to(tmp_path / "house.ifc", tmp_path, "ab")
    good = write_reference(reference, {})
    layout.project_file.write_bytes(good)
    assert read_reference(layout) == reference
    assert reference.path == "house.ifc"
    with pytest.raises(ProjectError, match="--building FILE"):
        reference.found(tmp_path)
    for bad, said in (
        (good.replace(b"walk_project: 1", b"walk_project: 99"), "open it with a newer one"),
        (b"walk_project: [", "is damaged in line 1"),
        (b"[]", "is damaged"),
        (b"walk_project: 1\n", "lacks one of"),
    ):
        layout.project_file.write_bytes(bad)
        with pytest.raises(ProjectError, match=said):
            read_reference(layout)


@pytest.mark.parametrize("spoil", [{"order": [0, 0]}, {"start": 9}, {"keypoints": None}, {"next_id": "x"}])
def test_a_tour_that_contradicts_itself_is_refused(tmp_path: Path, spoil: dict[str, object]) -> None:
    layout = Layout(folder=tmp_path, tour="main")
    data = yaml.safe_load(write_tour(_tour(_keypoints()), {}))
    write(tmp_path, layout.tour_file, yaml.safe_dump(data | spoil).encode())
    with pytest.raises(ProjectError, match="damaged"):
        read_tour(layout)
    with pytest.raises(ProjectError, match="has no tour 'other'; its tours: main"):
        read_tour(Layout(folder=tmp_path, tour="other"))


def test_parameters_come_back_but_not_who_may_come_in(tmp_path: Path) -> None:
    values = {"sequencer": {"walker.radius_m": 0.3}, "vr_bridge": {"bridge.lan": True, "bridge.viewpoint_hz": 20}}
    file = tmp_path / "parameters.yaml"
    file.write_text(parameters_text(values))
    settings = read_settings(file)
    assert getattr(settings["walker"], "radius_m") == 0.3  # noqa: B009
    assert getattr(settings["bridge"], "viewpoint_hz") == 20.0  # noqa: B009
    assert "lan" not in file.read_text()
    file.write_text(file.read_text().replace("radius_m: 0.3", "radius_m: -1.0"))
    with pytest.raises(ProjectError, match=r"radius_m is -1\.0"):
        read_settings(file)


def test_a_tour_is_open_once_and_named_plainly(tmp_path: Path) -> None:
    layout = Layout(folder=tmp_path, tour="main")
    with only_one(layout), pytest.raises(ProjectError, match="open in another graph"), only_one(layout):
        pass
    with only_one(layout):
        pass
    with pytest.raises(ProjectError, match="is no name"):
        Layout(folder=tmp_path, tour="../x")
