# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A unit of length may be a word."""

from __future__ import annotations

from pathlib import Path

import pytest
import trimesh
import yaml

from walk_bringup.cli.main import main
from walk_bringup.cli.overrides import overrides_yaml
from walk_bringup.cli.units import UNITS_M, UnitOfLength
from walk_bringup.cli.up import NODES, load_params


@pytest.mark.parametrize(("text", "metres"), [*UNITS_M.items(), ("CM", 0.01), ("0.3048", 0.3048), ("0", 0.0)])
def test_words_and_numbers_are_metres(text: str, metres: float) -> None:
    assert UnitOfLength().convert(text, None, None) == metres


def test_what_is_no_unit_is_said_with_the_words(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    for command in (["plan", "x.obj", "--out", "o"], ["export", "x.mcap", "--to", "csv"], ["up", "x.obj"]):
        assert main([*command, "--units", "furlong"]) == 2
        assert "'furlong' is no unit; expected one of mm, cm, m, in, ft" in capsys.readouterr().err


def test_a_length_below_nothing_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", "x.obj", "--out", str(tmp_path / "o"), "--units", "-1"]) == 2
    assert "--units is -1.0" in capsys.readouterr().err


def test_every_node_of_up_reads_the_file_alike() -> None:
    entries = yaml.safe_load(overrides_yaml(load_params(0.01, "y"), list(NODES)))
    read = {node: entry["ros__parameters"] for node, entry in entries.items()}
    assert read == {f"/**/{node}": {"load.units_m": 0.01, "load.up": "y"} for node in NODES}
    assert load_params(None, None) == ()


def test_a_model_in_centimetres_is_read_by_the_word(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    house = tmp_path / "house.stl"
    trimesh.creation.box(extents=(100000, 80000, 30000)).export(house)
    assert main(["plan", str(house), "--out", str(tmp_path / "o"), "--units", "cm", "--quiet"]) == 2
    assert "1000 x 800 x 300 m" in capsys.readouterr().err
