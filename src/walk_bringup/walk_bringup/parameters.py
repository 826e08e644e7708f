# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of all nodes as one YAML, made from the config dataclasses."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Iterator, Mapping
from typing import Any

from walk_building.config import Config
from walk_building.model import LoadOptions
from walk_building.walker import Walker
from walk_importance.config import ImportanceConfig, KeypointConfig
from walk_sequencer.config import SequencerConfig
from walk_sequencer.editing import EditingConfig
from walk_trajopt.config import TimingConfig, TrajoptConfig
from walk_vr_bridge.config import BridgeConfig

NODE_CONFIGS: Mapping[str, Mapping[str, type[Config]]] = {
    "importance": {"importance": ImportanceConfig, "keypoints": KeypointConfig},
    "sequencer": {"sequencer": SequencerConfig, "editing": EditingConfig},
    "trajopt": {"trajopt": TrajoptConfig, "timing": TimingConfig},
    "vr_bridge": {"bridge": BridgeConfig},
}
"""Config classes by node and parameter group; every node has `load` and `walker` beside them."""

SHARED: Mapping[str, type[Config]] = {"load": LoadOptions, "walker": Walker}

NODE_TEXTS: Mapping[str, tuple[str, ...]] = {
    "importance": ("building", "cache_dir", "keypoints_file"),
    "sequencer": ("building", "state_dir"),
    "trajopt": ("building", "state_dir"),
    "vr_bridge": ("building", "certificate_dir"),
}
"""Parameters by node that are no config's: paths of files and folders."""

_HEADER = """\
# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
# All parameters of the nodes with their defaults; made by `./walk params`, do not edit.
# Copy it, keep the lines you change, and start with `./walk up --params-file FILE` or launch's params_file:=FILE.
"""


def parameters_yaml() -> str:
    """Returns the YAML: what all nodes share first, then each node's own."""
    lines = [_HEADER.rstrip()]
    lines += _node("/**", SHARED, ('    building: ""  # path of the building file; empty for the sample building',))
    for node, configs in NODE_CONFIGS.items():
        lines += _node(f"/**/{node}", configs, ())
    return "\n".join(lines) + "\n"


_LONG = 24
"""Characters of a default from which on it would push the other columns off the page."""

_PAGE = """\
# Parameters

<!-- Made by `./walk params --markdown`, do not edit. -->

What a user can tune, all of it while the nodes run: on the headset's page, with `ros2 param set`, in a copy of
`config/walk.yaml`, and, where it matters most, as an option of `./walk plan`. `load` and `walker` are the same for all
nodes. Whatever does not fit is refused with the reason, and what was in force stays.
"""


def parameters_markdown() -> str:
    """Returns the page of the documentation: a table for each group."""
    lines = [_PAGE.rstrip()]
    nodes = {"all nodes": SHARED, **{f"node `{node}`": configs for node, configs in NODE_CONFIGS.items()}}
    for node, configs in nodes.items():
        for group, config in configs.items():
            lines += ["", f"## {group}", "", f"*{node[0].upper()}{node[1:]}*", ""]
            lines += ["| parameter | what it does | default | may be |", "|---|---|---|---|"]
            for field in dataclasses.fields(config):  # type: ignore[arg-type]
                default = yaml_value(field.default)
                default = f"`{default}`" if len(default) <= _LONG else "see `config/walk.yaml`"
                cells = (f"`{group}.{field.name}`", field.metadata["doc"], default, limits(field))
                lines.append("| " + " | ".join(_cell(text) for text in cells) + " |")
    return "\n".join(lines) + "\n"


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("<", "&lt;") if not text.startswith("`") else text.replace("|", "\\|")


def _node(name: str, configs: Mapping[str, type[Config]], first: tuple[str, ...]) -> Iterator[str]:
    yield f"{name}:"
    yield "  ros__parameters:"
    yield from first
    for group, config in configs.items():
        yield f"    {group}:"
        for field in dataclasses.fields(config):  # type: ignore[arg-type]
            yield f"      {field.name}: {yaml_value(field.default)}  # {describe(field)}"


def yaml_value(value: Any) -> str:
    """Returns a default as YAML 1.1 reads it back, a float always with its point."""
    if isinstance(value, float):
        text = repr(value)
        # Without the point in front of the exponent it would be read as a text.
        return text if "e" not in text or "." in text else text.replace("e", ".0e")
    return json.dumps(value)


def describe(field: dataclasses.Field[Any]) -> str:
    """Returns what a parameter does, with its unit and what it may be."""
    what = limits(field, " | ")
    return str(field.metadata["doc"]) + (f" [{what}]" if what else "")


def limits(field: dataclasses.Field[Any], between: str = ", ") -> str:
    """Returns a parameter's unit and what it may be, "" where it may be anything of its type."""
    meta = field.metadata
    low, high = meta["low"], meta["high"]
    parts = [meta["unit"]] if meta["unit"] else []
    if meta["choices"]:
        parts.append(between.join(meta["choices"]))
    if low is not None and high is not None:
        parts.append(f"{low:g} to {high:g}")
    elif low is not None:
        parts.append(f"at least {low:g}")
    elif high is not None:
        parts.append(f"at most {high:g}")
    return ", ".join(parts)
