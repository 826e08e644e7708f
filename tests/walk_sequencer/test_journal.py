# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Nothing confirmed is lost: the journal, the keypoints it holds, and the authority over both."""

import contextlib
import json
import os
import resource

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from walk_sequencer.changes import changed, move_entry, order_entry, suggested_entry
from walk_sequencer.journal import Journal, JournalError, default_state_dir
from walk_sequencer.keypoints import Keypoints

POSITIONS = np.array([[0.1, 0.2, 1.6], [1 / 3, 2.0, 1.6], [5.0, 6.0, 1.6]])
QUATS = np.tile([0.0, 0.0, 0.6, 0.8], (3, 1))


def same(a, b):
    arrays = ("positions", "quat_xyzw", "suggested")
    values = ("ids", "order", "edited", "next_id")
    return all(np.array_equal(getattr(a, n), getattr(b, n)) for n in arrays) and all(
        getattr(a, n) == getattr(b, n) for n in values
    )


def written(journal, *entries):
    keypoints = journal.replay().present
    for entry in entries:
        keypoints = changed(keypoints, entry)
        journal.append(entry)
    return keypoints


@pytest.fixture
def journal(tmp_path):
    return Journal(tmp_path / "state", "abc")


def three(journal):
    return written(
        journal,
        suggested_entry(POSITIONS, QUATS),
        order_entry([2, 0, 1]),
        move_entry(0, [1.5, 2.5, 1.6], QUATS[0], "anna"),
    )


def test_a_new_journal_is_empty(journal):
    assert same(journal.replay().present, Keypoints())


def test_what_was_appended_is_replayed_bit_for_bit(journal):
    expected = three(journal)
    keypoints = Journal(journal.path.parent, "abc").replay().present
    assert same(keypoints, expected)
    assert keypoints.ids == (0, 1, 2)
    assert keypoints.order == (2, 0, 1)
    assert keypoints.edited
    np.testing.assert_array_equal(keypoints.positions[1:], POSITIONS[1:])
    np.testing.assert_array_equal(keypoints.positions[0], [1.5, 2.5, 1.6])


def test_journals_of_other_buildings_are_apart(journal):
    three(journal)
    assert same(Journal(journal.path.parent, "def").replay().present, Keypoints())


@settings(deadline=None, max_examples=60)
@given(cut=st.integers(0, 400))
def test_a_crash_at_any_byte_loses_only_what_was_not_confirmed(tmp_path_factory, cut):
    journal = Journal(tmp_path_factory.mktemp("state"), "abc")
    three(journal)
    whole = journal.path.read_bytes()
    kept = whole[: max(len(whole) - cut, 0)]
    journal.path.write_bytes(kept)
    expected = Keypoints()
    for line in kept.split(b"\n")[:-1]:
        expected = changed(expected, json.loads(line))
    assert same(journal.replay().present, expected)
    # And it can be gone on with: the torn line is off.
    after = written(Journal(journal.path.parent, "abc"), suggested_entry(POSITIONS + 1, QUATS))
    assert same(Journal(journal.path.parent, "abc").replay().present, after)


@pytest.mark.parametrize("line", ["{}", "null", "[]", '{"kind": "magic"}', '{"kind": "move", "id": 77}', "\x00\x00"])
def test_a_damaged_line_ends_the_journal_and_a_copy_is_kept(journal, line):
    three(journal)
    lines = journal.path.read_text().splitlines()
    journal.path.write_text("\n".join([lines[0], line, *lines[1:]]) + "\n")
    damaged = journal.path.read_bytes()
    keypoints = journal.replay().present
    assert keypoints.order == ()
    np.testing.assert_array_equal(keypoints.positions, POSITIONS)
    assert journal.path.with_suffix(".damaged").read_bytes() == damaged
    assert journal.path.read_text() == lines[0] + "\n"


def test_an_entry_is_on_disk_before_append_returns(journal, monkeypatch):
    synced = []
    fsync = os.fsync
    monkeypatch.setattr(os, "fsync", lambda fd: (synced.append(fd), fsync(fd)))
    journal.replay()
    journal.append(order_entry([]))
    assert len(synced) == 2  # the file, and the folder that it is new in
    journal.append(order_entry([]))
    assert len(synced) == 3
    assert journal.path.read_text().endswith("\n")


def test_a_folder_that_cannot_be_written_is_said_so(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(JournalError, match="state_dir"):
        Journal(tmp_path / "file" / "state", "abc").replay()


def test_a_journal_put_aside_is_kept(journal):
    three(journal)
    before = journal.path.read_bytes()
    aside = journal.put_aside()
    assert same(journal.replay().present, Keypoints())
    assert aside is not None and aside.read_bytes() == before
    assert journal.put_aside() is None, "there is nothing to put aside"
    three(journal)
    again = journal.put_aside()
    assert again is not None and again != aside and again.exists()
    assert aside.read_bytes() == before, "what was put aside before stays"


def test_the_state_folder_follows_the_xdg_specification(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    assert default_state_dir() == tmp_path / "walk"
    monkeypatch.setenv("XDG_STATE_HOME", "relative")
    monkeypatch.setenv("HOME", str(tmp_path))
    assert default_state_dir() == tmp_path / ".local" / "state" / "walk"


def test_identities_are_never_used_twice():
    first = changed(Keypoints(), suggested_entry(POSITIONS, QUATS))
    second = changed(first, suggested_entry(POSITIONS[:2] + 1, QUATS[:2]))
    assert first.ids == (0, 1, 2)
    assert second.ids == (3, 4)
    assert not second.edited


def test_in_order_keeps_each_keypoint_with_its_identity():
    keypoints = changed(changed(Keypoints(), suggested_entry(POSITIONS, QUATS)), order_entry([2, 0]))
    ordered = keypoints.in_order()
    assert ordered.ids == (2, 0, 1)
    for identity in (0, 1, 2):
        np.testing.assert_array_equal(ordered.positions[ordered.index(identity)], POSITIONS[identity])


@pytest.mark.parametrize(
    "entry",
    [
        order_entry([0, 0]),
        order_entry([9]),
        {"kind": "move", "id": 9, "position": [0, 0, 0], "quat_xyzw": [0, 0, 0, 1]},
        {"kind": "move", "id": 0, "position": [0, 0], "quat_xyzw": [0, 0, 0, 1]},
        {"kind": "suggested", "positions": [[0, 0, float("nan")]], "quat_xyzw": [[0, 0, 0, 1]]},
        {"kind": "suggested", "positions": [[0, 0, 0]], "quat_xyzw": []},
    ],
)
def test_a_change_that_does_not_fit_is_refused(entry):
    keypoints = changed(Keypoints(), suggested_entry(POSITIONS, QUATS))
    with pytest.raises((ValueError, KeyError, TypeError)):
        changed(keypoints, entry)


@contextlib.contextmanager
def room_for(journal, more_bytes):
    """Lets the journal grow by so many bytes only, as on a disk that is nearly full."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (journal.path.stat().st_size + more_bytes, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.parametrize("more_bytes", [0, 1, 40])
def test_a_change_that_found_no_room_on_the_disk_spoils_none_behind_it(journal, more_bytes):
    three(journal)
    whole = journal.path.read_bytes()
    with room_for(journal, more_bytes), pytest.raises(JournalError, match=r"abc\.jsonl"):
        journal.append(move_entry(1, [9.0, 9.0, 1.6], QUATS[1], "anna"))
    assert journal.path.read_bytes() == whole
    journal.append(move_entry(2, [4.5, 6.0, 1.6], QUATS[2], "anna"))
    kept = journal.replay().present
    np.testing.assert_array_equal(kept.positions[1], POSITIONS[1])
    np.testing.assert_array_equal(kept.positions[2], [4.5, 6.0, 1.6])
