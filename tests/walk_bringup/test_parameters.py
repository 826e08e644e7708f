# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest
import yaml

from walk_bringup.parameters import NODE_CONFIGS, SHARED, parameters_yaml

CONFIG = Path(__file__).resolve().parents[2] / "src" / "walk_bringup" / "config" / "walk.yaml"


def test_stored_yaml_is_what_the_configs_say() -> None:
    assert CONFIG.read_text(encoding="utf-8") == parameters_yaml(), (
        "run ./walk params > src/walk_bringup/config/walk.yaml"
    )


@pytest.mark.parametrize("node", [None, *NODE_CONFIGS])
def test_yaml_reads_back_as_the_defaults_with_their_types(node: str | None) -> None:
    read = yaml.safe_load(parameters_yaml())["/**" if node is None else f"/**/{node}"]["ros__parameters"]
    for group, config in (SHARED if node is None else NODE_CONFIGS[node]).items():
        defaults = {field.name: field.default for field in dataclasses.fields(config)}  # type: ignore[arg-type]
        assert read[group] == defaults
        assert {name: type(value) for name, value in read[group].items()} == {
            name: type(value) for name, value in defaults.items()
        }
