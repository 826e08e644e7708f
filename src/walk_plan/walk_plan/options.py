# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Everything a user can tune about a plan, composed of the stages' own configs."""

from __future__ import annotations

import dataclasses
from collections import Counter
from collections.abc import Mapping
from typing import Any

from walk_building.model import LoadOptions
from walk_building.walker import Walker
from walk_importance.config import ImportanceConfig, KeypointConfig
from walk_sequencer.config import SequencerConfig
from walk_trajopt.config import TimingConfig, TrajoptConfig

# What fields are called where the stage's name does not stand before them.
_SPOKEN = {("keypoints", "count"): "keypoints", ("tour", "method"): "order"}
_UNIT_SUFFIXES = ("m", "m2", "deg", "rad", "s", "mps", "mps2", "mps3", "radps", "radps2")


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class PlanConfig:
    """The configs of all stages, in the order of the method."""

    walker: Walker = dataclasses.field(default_factory=Walker)
    load: LoadOptions = dataclasses.field(default_factory=LoadOptions)
    importance: ImportanceConfig = dataclasses.field(default_factory=ImportanceConfig)
    keypoints: KeypointConfig = dataclasses.field(default_factory=KeypointConfig)
    tour: SequencerConfig = dataclasses.field(default_factory=SequencerConfig)
    trajectory: TrajoptConfig = dataclasses.field(default_factory=TrajoptConfig)
    timing: TimingConfig = dataclasses.field(default_factory=TimingConfig)


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class PlanOption:
    """One option of the command line: a field of one of the configs."""

    name: str  # without dashes in front: "voxel-size"
    section: str  # the attribute of PlanConfig it belongs to
    field: dataclasses.Field[Any]  # its default, and in its metadata doc, unit, low, high and choices
    config: type

    @property
    def help(self) -> str:
        """Returns what the option does, with its unit and range."""
        meta = self.field.metadata
        unit, low, high = meta["unit"], meta["low"], meta["high"]
        limits = [f"{low:g} to {high:g}"] if low is not None and high is not None else []
        if not limits and (low is not None or high is not None):
            limits = [f"at least {low:g}" if low is not None else f"at most {high:g}"]
        details = ", ".join(([unit] if unit else []) + limits)
        return meta["doc"] + (f" [{details}]" if details else "")


def plan_options() -> tuple[PlanOption, ...]:
    """Returns the options of a plan.

    An option is called as its field without the unit, which the help tells; a name that two configs share gets
    its section in front.
    """
    defaults = PlanConfig()
    found = [
        (section.name, type(getattr(defaults, section.name)), field)
        for section in dataclasses.fields(PlanConfig)
        for field in dataclasses.fields(getattr(defaults, section.name))
    ]
    names = [_option_name(section, field) for section, _, field in found]
    shared = Counter(names)
    return tuple(
        PlanOption(name=f"{section}-{name}" if shared[name] > 1 else name, section=section, field=field, config=config)
        for name, (section, config, field) in zip(names, found, strict=True)
    )


def plan_config(values: Mapping[str, Any]) -> PlanConfig:
    """Returns the config with the options that were given set, the others at their defaults.

    Args:
        values: From option name ("voxel-size") to value, already of the field's type.

    Raises:
        ParameterError: A value is outside of what its field may be.
        KeyError: There is no such option.
    """
    options = {option.name: option for option in plan_options()}
    chosen: dict[str, dict[str, Any]] = {}
    for name, value in values.items():
        option = options[name]
        chosen.setdefault(option.section, {})[option.field.name] = value
    defaults = PlanConfig()
    sections = {section: dataclasses.replace(getattr(defaults, section), **given) for section, given in chosen.items()}
    return dataclasses.replace(defaults, **sections)


def _option_name(section: str, field: dataclasses.Field[Any]) -> str:
    name = _SPOKEN.get((section, field.name), field.name)
    stem, _, suffix = name.rpartition("_")
    return (stem if stem and suffix in _UNIT_SUFFIXES else name).replace("_", "-")
