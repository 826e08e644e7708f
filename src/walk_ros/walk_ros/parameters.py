# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""ROS parameters made from config dataclasses: a field each, with its description, unit and range."""

from __future__ import annotations

import dataclasses
import difflib
import itertools
import math
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, TypeVar, cast

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, ParameterType, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

from walk_building.config import Config
from walk_building.errors import ParameterError

C = TypeVar("C", bound=Config)
OnChange = Callable[[frozenset[str]], None]

_INT64 = 2**63 - 1


def describe(field: dataclasses.Field[Any]) -> ParameterDescriptor:
    """Returns the descriptor of a config field: the text with unit and choices, and the range."""
    meta = field.metadata
    unit = f" [{meta['unit']}]" if meta["unit"] else ""
    choices = f" (one of: {', '.join(meta['choices'])})" if meta["choices"] else ""
    descriptor = ParameterDescriptor(name=field.name, description=f"{meta['doc']}{unit}{choices}")
    low, high = meta["low"], meta["high"]
    if isinstance(field.default, float):
        # Any number will do: `-p timing.speed_mps:=2` is an integer to ROS and should not be an error.
        descriptor.dynamic_typing = True
        descriptor.type = ParameterType.PARAMETER_DOUBLE
        if low is not None or high is not None:
            bounds = FloatingPointRange(from_value=float(_or(low, -math.inf)), to_value=float(_or(high, math.inf)))
            descriptor.floating_point_range = [bounds]
    elif type(field.default) is int and (low is not None or high is not None):
        whole = IntegerRange(from_value=int(_or(low, -_INT64)), to_value=int(_or(high, _INT64)))
        descriptor.integer_range = [whole]
    return descriptor


def _or(value: float | None, otherwise: float) -> float:
    return otherwise if value is None else value


class ConfigParameters:
    """The configs of a node as parameters `GROUP.FIELD`, kept in step while it runs.

    A change that the config refuses is refused with the config's own sentence, and nothing changes.
    """

    def __init__(self, node: Node, groups: Mapping[str, type[Config]], on_change: OnChange) -> None:
        """Declares the parameters.

        Args:
            node: Whose parameters they are.
            groups: Config class by group name.
            on_change: Called with the groups that have changed, in the thread of the executor.

        Raises:
            ParameterError: The command line or a file gives a value that is out of range.
        """
        self._lock = threading.Lock()
        self._on_change = on_change
        self._defaults = {group: config() for group, config in groups.items()}
        for group, config in self._defaults.items():
            for field in _fields(config):
                node.declare_parameter(f"{group}.{field.name}", field.default, describe(field))
        self._configs = self._replaced({p: node.get_parameter(p).value for p in self.names()})
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._apply)

    def names(self) -> list[str]:
        """Returns the full names of all parameters."""
        return [f"{group}.{field.name}" for group, config in self._defaults.items() for field in _fields(config)]

    def get(self, group: str, kind: type[C]) -> C:
        """Returns the group's config as it is now; may be called from any thread."""
        with self._lock:
            config = self._configs[group]
        assert isinstance(config, kind)
        return config

    def _replaced(self, values: Mapping[str, Any]) -> dict[str, Config]:
        """Returns the configs with the values by full name put in; raises ParameterError."""
        configs = dict(getattr(self, "_configs", self._defaults))
        by_group: dict[str, dict[str, Any]] = {}
        for name, value in values.items():
            group, _, field = name.partition(".")
            if group in configs and field in {f.name for f in _fields(configs[group])}:
                default = getattr(self._defaults[group], field)
                by_group.setdefault(group, {})[field] = _number(default, value)
        for group, changes in by_group.items():
            configs[group] = dataclasses.replace(cast(Any, configs[group]), **changes)
        return configs

    def _check(self, parameters: list[Parameter]) -> SetParametersResult:
        try:
            self._replaced({p.name: p.value for p in parameters})
        except ParameterError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _apply(self, parameters: list[Parameter]) -> None:
        configs = self._replaced({p.name: p.value for p in parameters})
        with self._lock:
            changed = frozenset(g for g in configs if configs[g] != self._configs[g])
            self._configs = configs
        if changed:
            self._on_change(changed)


def unknown_overrides(
    given: Iterable[str], declared: Sequence[str], arguments: Sequence[str]
) -> Iterator[tuple[str, str]]:
    """Yields the names of parameters that a node was given and does not have, with the nearest that it has, or "".

    ROS drops them without a word. What a file says to all nodes may be meant for another: unless it nearly is one of
    this node's, it counts only where the command line has it.

    Args:
        given: Names of all that were given, in files and on the command line.
        declared: Names of all that the node has.
        arguments: The command line.
    """
    groups = {name.partition(".")[0] for name in declared}
    values = itertools.pairwise(arguments)
    named = {value.partition(":=")[0].rpartition(":")[2] for flag, value in values if flag in ("-p", "--param")}
    for name in sorted(set(given) - set(declared)):
        if name.startswith("qos_overrides."):
            continue
        near = difflib.get_close_matches(name, declared, 1)
        if not near:  # the field alone, written without its group
            fields = {known.rpartition(".")[2]: known for known in declared}
            near = [fields[field] for field in difflib.get_close_matches(name.rpartition(".")[2], fields, 1)]
        if name in named or near or name.partition(".")[0] in groups:
            yield name, near[0] if near else ""


def _number(default: Any, value: Any) -> Any:
    """Returns a whole number as a float where the config wants a float."""
    whole = isinstance(value, int) and not isinstance(value, bool)
    return float(value) if isinstance(default, float) and whole else value


def _fields(config: Config) -> tuple[dataclasses.Field[Any], ...]:
    return dataclasses.fields(cast(Any, config))
