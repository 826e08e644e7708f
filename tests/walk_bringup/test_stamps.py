# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

from pathlib import Path

import pytest

from walk_bringup.bootstrap.layout import Layout
from walk_bringup.bootstrap.machine import look
from walk_bringup.bootstrap.stages import Stage
from walk_bringup.bootstrap.stamps import fingerprint, read_json, write_json


def test_fingerprint_changes_with_content_and_name(tmp_path: Path) -> None:
    first, second = tmp_path / "a", tmp_path / "b"
    first.write_text("x")
    second.write_text("x")
    assert fingerprint([], [first]) != fingerprint([], [second])
    before = fingerprint(["t"], [first])
    assert before == fingerprint(["t"], [first])
    first.write_text("y")
    assert before != fingerprint(["t"], [first])


def test_fingerprint_keeps_texts_apart() -> None:
    assert fingerprint(["ab", "c"]) != fingerprint(["a", "bc"])


def test_damaged_and_missing_stamps_read_as_none(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "stamp.json"
    assert read_json(path) is None
    write_json(path, {"a": 1})
    assert read_json(path) == {"a": 1}
    path.write_text('{"a": ')
    assert read_json(path) is None
    assert [file.name for file in path.parent.iterdir()] == ["stamp.json"]


def _stage(tmp_path: Path, run: object) -> Stage:
    return Stage(
        name="test",
        stamp=lambda layout: tmp_path / "stamp.json",
        fingerprint=lambda layout, machine: (tmp_path / "input").read_text(),
        evidence=lambda layout: tmp_path / "result",
        run=run,  # type: ignore[arg-type]
    )


def test_stage_is_done_again_when_its_input_changes_or_its_result_is_gone(tmp_path: Path) -> None:
    (tmp_path / "input").write_text("1")
    stage = _stage(tmp_path, lambda layout, machine: (tmp_path / "result").touch())
    layout, machine = Layout(tmp_path), look(tmp_path)
    assert not stage.is_done(layout, machine)
    stage.do(layout, machine)
    assert stage.is_done(layout, machine)
    (tmp_path / "input").write_text("2")
    assert not stage.is_done(layout, machine)
    stage.do(layout, machine)
    (tmp_path / "result").unlink()
    assert not stage.is_done(layout, machine)


def test_interrupted_stage_loses_its_stamp(tmp_path: Path) -> None:
    (tmp_path / "input").write_text("1")
    (tmp_path / "result").touch()
    write_json(tmp_path / "stamp.json", "1")

    def interrupted(layout: Layout, machine: object) -> None:
        raise KeyboardInterrupt

    stage = _stage(tmp_path, interrupted)
    layout, machine = Layout(tmp_path), look(tmp_path)
    assert stage.is_done(layout, machine)
    with pytest.raises(KeyboardInterrupt):
        stage.do(layout, machine)
    assert not stage.is_done(layout, machine)
