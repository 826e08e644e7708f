# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of the nodes in a project: written as a ROS parameter file, and checked before nodes start with it."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from walk_bringup.parameters import NODE_CONFIGS, SHARED, yaml_value
from walk_bringup.projects.errors import ProjectError
from walk_bringup.projects.files import load_yaml
from walk_building.config import Config
from walk_building.errors import ParameterError

OF_THE_MACHINE = ("bridge.port", "bridge.lan", "bridge.hosts", "editing.restore", "editing.session_start_s")
"""What is not saved: who else may come in is decided where the project is opened, not by the file."""

_HEADER = "# The parameters of the nodes when this project was saved; ./walk params prints all with units and ranges.\n"

NodeValues = Mapping[str, Mapping[str, Any]]
"""Values by node and full name, such as `timing.speed_mps`."""


def parameters_text(values: NodeValues) -> str:
    """Returns the parameter file; what all nodes share is that of the sequencer, whose keypoints are saved."""
    lines = list(_section("/**", SHARED, values.get("sequencer", {})))
    for node, groups in NODE_CONFIGS.items():
        if node in values:
            lines += _section(f"/**/{node}", groups, values[node])
    return _HEADER + "\n".join(lines) + "\n"


def _section(name: str, groups: Mapping[str, type[Config]], values: Mapping[str, Any]) -> Iterator[str]:
    yield f"{name}:"
    yield "  ros__parameters:"
    for group, config in groups.items():
        yield f"    {group}:"
        for field in _fields(config):
            full = f"{group}.{field.name}"
            if full in values and full not in OF_THE_MACHINE:
                value = float(values[full]) if isinstance(field.default, float) else values[full]
                yield f"      {field.name}: {yaml_value(value)}"


def read_settings(path: Path) -> dict[str, Config]:
    """Returns the configs by group, with the defaults of what the file does not name.

    Raises:
        ProjectError: It cannot be read, or has a parameter or a value that this program does not know.
    """
    document = load_yaml(path)
    sections: dict[str, Mapping[str, type[Config]]] = {"/**": SHARED}
    sections |= {f"/**/{node}": groups for node, groups in NODE_CONFIGS.items()}
    unknown = sorted(set(map(str, document)) - set(sections))
    if unknown:
        raise ProjectError(path, f"has a section {unknown[0]!r}; expected {', '.join(sections)}")
    found: dict[str, Config] = {}
    for name, groups in sections.items():
        values = _mapping(path, name, document.get(name, {})).get("ros__parameters", {})
        values = _mapping(path, name, values)
        for group in values:
            if group not in groups:
                raise ProjectError(path, f"{name} has a group {group!r}, which this program does not know")
        for group, config in groups.items():
            found[group] = _config(path, group, config, _mapping(path, group, values.get(group, {})))
    return found


def _config(path: Path, group: str, config: type[Config], values: Mapping[str, Any]) -> Config:
    fields = {field.name: field for field in _fields(config)}
    for name in values:
        if name not in fields:
            raise ProjectError(path, f"has {group}.{name}, which this program does not know: it may be of a newer one")
    # As the nodes do: a whole number will do where a float is wanted.
    whole = {n: isinstance(v, int) and not isinstance(v, bool) for n, v in values.items()}
    given = {n: float(v) if whole[n] and isinstance(fields[n].default, float) else v for n, v in values.items()}
    try:
        return config(**given)
    except ParameterError as error:
        raise ProjectError(path, f"{group}.{error}") from error


def _mapping(path: Path, name: str, value: Any) -> Mapping[str, Any]:
    # A group of which nothing is named is `group:` in YAML, which reads as nothing.
    if value is not None and not isinstance(value, dict):
        raise ProjectError(path, f"is damaged: {name} holds no names and values")
    return value or {}


def _fields(config: type[Config]) -> tuple[dataclasses.Field[Any], ...]:
    return dataclasses.fields(config)  # type: ignore[arg-type]
