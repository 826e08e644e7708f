# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The documentation is a site without dead ends, and says what the code says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from walk_bringup.bootstrap.commands import COMMANDS
from walk_bringup.cli.main import main
from walk_bringup.parameters import parameters_markdown

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted([*(ROOT / "docs").glob("*.md"), ROOT / "README.md"])


def test_the_site_builds_without_a_warning(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["docs", "--out", str(tmp_path / "site")]) == 0, capfd.readouterr().err
    for page in (ROOT / "docs").glob("*.md"):
        assert (tmp_path / "site" / f"{page.stem}.html").exists()


def test_the_page_of_parameters_is_that_of_the_configs() -> None:
    assert (ROOT / "docs" / "parameters.md").read_text(encoding="utf-8") == parameters_markdown()


@pytest.mark.parametrize("page", PAGES, ids=[page.name for page in PAGES])
def test_links_lead_to_files_that_are_there(page: Path) -> None:
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    for target in re.findall(r"\]\(([^)#\s]+)[^)]*\)", text):
        if not target.startswith(("http", "mailto:")):
            assert (page.parent / target).exists(), target


@pytest.mark.parametrize("page", PAGES, ids=[page.name for page in PAGES])
def test_pages_name_only_commands_and_parameters_that_exist(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    for name in re.findall(r"\./walk ([a-z]\w*)", text):
        assert name in COMMANDS, name
    known = set(re.findall(r"`([a-z]\w*\.\w+)`", parameters_markdown()))
    groups = {name.split(".")[0] for name in known}
    for name in re.findall(r"`([a-z]\w*\.\w+)`", text):
        if name.split(".")[0] in groups and not name.endswith((".md", ".py", ".yaml", ".json", ".bin")):
            assert name in known, name
