# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters that `./walk up` hands on, checked as the nodes check them, before any node starts."""

from __future__ import annotations

import dataclasses
import difflib
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml

from walk_bringup.bootstrap.errors import SetupError
from walk_bringup.parameters import NODE_CONFIGS, NODE_TEXTS, SHARED, yaml_value
from walk_building.config import Config
from walk_building.errors import ParameterError

_ROS_OWN = ("use_sim_time", "start_type_description_service", "qos_overrides")
"""Parameters that every ROS node has, or their group."""

Configs = Mapping[str, Mapping[str, Config]]
"""By node and group."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Given:
    """A parameter that the user gives.

    Attributes:
        said: Where, for messages.
        node: Whose it is.
        name: Its full name, such as `timing.speed_mps`.
        value: Its value, of the type that the config wants where it reads as one.
    """

    said: str
    node: str
    name: str
    value: Any


def overrides_yaml(params: Sequence[str], nodes: Sequence[str]) -> str:
    """Returns a parameter file for parameters given as NODE.NAME=VALUE.

    Raises:
        SetupError: One of them reads otherwise, or names no node or no parameter.
    """
    found: dict[str, list[str]] = {}
    for given in read_params(params, nodes):
        found.setdefault(given.node, []).append(f"    {given.name}: {yaml_value(given.value)}")
    return "".join("\n".join([f"/**/{node}:", "  ros__parameters:", *lines, ""]) for node, lines in found.items())


def read_params(params: Sequence[str], nodes: Sequence[str]) -> list[Given]:
    """Returns what parameters given as NODE.NAME=VALUE say; raises SetupError as `overrides_yaml` does."""
    read = []
    for param in params:
        target, equals, value = param.partition("=")
        node, dot, name = target.partition(".")
        said = f"--param {param!r}"
        if not (equals and dot and name and value):
            raise SetupError(f"{said} does not read NODE.NAME=VALUE, such as trajopt.timing.speed_mps=1.0")
        if node not in nodes:
            raise SetupError(f"{said}: there is no node {node!r}; nodes: {', '.join(nodes)}")
        # What is ROS's own has the type that it reads as; all else has that of the config, or is a text.
        own = yaml.safe_load(value) if name.partition(".")[0] in _ROS_OWN else value
        read.append(Given(said=said, node=node, name=name, value=_of_type(_field(said, node, name), own)))
    return read


def read_params_file(path: Path, nodes: Sequence[str], namespace: str) -> list[Given]:
    """Returns what a ROS parameter file says to the nodes, in its order: what comes later counts.

    Raises:
        SetupError: It cannot be read, or gives one of the nodes a parameter that it does not have.
    """
    try:
        document = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise SetupError(f"{path}: cannot be read: {error.strerror or error}") from error
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        where = getattr(error, "problem_mark", None)
        line = f" in line {where.line + 1}" if where is not None else ""
        raise SetupError(f"{path}: is no YAML{line}; ./walk params prints how it should look") from error
    read = []
    for section, values in _sections(document):
        for node in nodes:
            if not _is_for(section, f"/{namespace.strip('/')}/{node}".replace("//", "/")):
                continue
            for name, value in _flat(values):
                said = f"{path}, {section}, {name}"
                if section.endswith("*") and name.partition(".")[0] not in {**SHARED, **NODE_CONFIGS.get(node, {})}:
                    continue  # what is said to all may be meant for another
                read.append(Given(said=said, node=node, name=name, value=_of_type(_field(said, node, name), value)))
    return read


def checked(given: Sequence[Given], nodes: Sequence[str]) -> Configs:
    """Returns the configs that the nodes will start with; of two values for one parameter the later one counts.

    Raises:
        SetupError: A value is not what its parameter may be.
    """
    found: dict[str, dict[str, Config]] = {}
    for node in nodes:
        found[node] = {}
        for group, config in {**SHARED, **NODE_CONFIGS.get(node, {})}.items():
            mine = {g.name.partition(".")[2]: g for g in given if g.node == node and g.name.startswith(f"{group}.")}
            try:
                found[node][group] = config(**{field: g.value for field, g in mine.items()})
            except ParameterError as error:
                # A rule about several fields is told under one name, or under none of them.
                culprit = mine.get(error.name) or list(mine.values())[-1]
                raise SetupError(f"{culprit.said}: {error}") from error
    return found


def _field(said: str, node: str, name: str) -> dataclasses.Field[Any] | None:
    """Returns the config's field behind a parameter, None for one that is a text without a config.

    Raises:
        SetupError: The node has none of that name: it would start without a word.
    """
    group, _, field = name.partition(".")
    configs = {**SHARED, **NODE_CONFIGS.get(node, {})}
    if group in _ROS_OWN or name in NODE_TEXTS.get(node, ()):
        return None
    if group not in configs:
        # The group as it was written, and the field where it is known: a slip in the group is found by both.
        known = [f"{g}.{f.name}" for g, config in configs.items() for f in _fields(config)]
        near = difflib.get_close_matches(name, [*known, *NODE_TEXTS.get(node, ())], 1)
        hint = f"did you mean {near[0]}?" if near else f"its groups are {', '.join(configs)}"
        raise SetupError(f"{said}: {node} has no parameter {name!r}; {hint}")
    fields = {known.name: known for known in _fields(configs[group])}
    if field not in fields:
        near = difflib.get_close_matches(field, fields, 1)
        hint = f"did you mean {group}.{near[0]}?" if near else f"it has {', '.join(fields)}"
        raise SetupError(f"{said}: {node} has no parameter {name!r}; {hint}")
    return fields[field]


def _fields(config: type[Config]) -> tuple[dataclasses.Field[Any], ...]:
    return dataclasses.fields(config)  # type: ignore[arg-type]


def _of_type(field: dataclasses.Field[Any] | None, value: Any) -> Any:
    """Returns a value as the field wants it where it reads as such a value, else as it is: the config refuses it."""
    if field is None or isinstance(field.default, str) or isinstance(value, bool):
        return value
    if isinstance(field.default, bool):
        return {"true": True, "false": False}.get(str(value), value)
    if isinstance(field.default, float):
        return _read_as(float, value)
    return _read_as(int, value) if isinstance(value, str) else value


def _read_as(kind: type[float], value: Any) -> Any:
    try:
        return kind(value)
    except (TypeError, ValueError):
        return value


def _sections(document: Any, above: str = "") -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yields the nodes that a parameter file names, with their values."""
    for key, value in document.items() if isinstance(document, dict) else ():
        name = f"{above}/{str(key).strip('/')}"
        if isinstance(value, dict) and isinstance(value.get("ros__parameters"), dict):
            yield name, value["ros__parameters"]
        else:
            yield from _sections(value, name)


def _is_for(section: str, node: str) -> bool:
    """Whether a section of a parameter file is for a node: `*` stands for one name, `**` for any number of them."""
    pattern = re.escape(section).replace(r"/\*\*", "(?:/[^/]+)*").replace(r"\*", "[^/]+")
    return re.fullmatch(pattern, node) is not None


def _flat(values: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in values.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{above}{key}.")
        elif value is not None:
            yield f"{above}{key}", value
