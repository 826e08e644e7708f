# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Config dataclasses: each default, unit, range and reason stands in one place.

ROS parameters with their descriptors, the parameter YAML and the options of the command line are
derived from the fields made here.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import Any


def param(
    default: Any,
    doc: str,
    *,
    unit: str = "",
    low: float | None = None,
    high: float | None = None,
    choices: Sequence[str] = (),
) -> Any:
    """Returns a dataclass field with its description, unit and the values it may take.

    Args:
        default: The one home of the default; its type (bool, int, float or str) is the type of the field.
        doc: What the value does and, where it is not obvious, why the default is what it is.
        unit: SI unit or "" for a plain number.
        low: Smallest value allowed, inclusive.
        high: Largest value allowed, inclusive.
        choices: For a str, the names allowed.
    """
    metadata = {"doc": doc, "unit": unit, "low": low, "high": high, "choices": tuple(choices)}
    return dataclasses.field(default=default, metadata=metadata)


class Config:
    """Base of the config dataclasses: every field is checked when an instance is made."""

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):  # type: ignore[arg-type]
            _check(field, getattr(self, field.name))


def _check(field: dataclasses.Field[Any], value: object) -> None:
    # Imported here so that errors.py may one day use configs without a cycle.
    from walk_building.errors import ParameterError

    if isinstance(field.default, bool):
        if not isinstance(value, bool):
            raise ParameterError(field.name, value, "true or false")
        return
    if isinstance(field.default, str):
        choices = field.metadata["choices"]
        if not isinstance(value, str) or (choices and value not in choices):
            raise ParameterError(field.name, value, "one of " + ", ".join(choices) if choices else "a text")
        return
    whole = isinstance(field.default, int)
    ok = isinstance(value, int if whole else (int, float)) and not isinstance(value, bool)
    low, high = field.metadata["low"], field.metadata["high"]
    if ok:
        assert isinstance(value, int | float)
        ok = math.isfinite(value) and (low is None or value >= low) and (high is None or value <= high)
    if not ok:
        raise ParameterError(field.name, value, _expected(whole, low, high, field.metadata["unit"]))


def _expected(whole: bool, low: float | None, high: float | None, unit: str) -> str:
    kind = "a whole number" if whole else "a finite number"
    suffix = f" {unit}" if unit else ""
    if low is not None and high is not None:
        return f"{kind} from {low:g} to {high:g}{suffix}"
    if low is not None:
        return f"{kind} of at least {low:g}{suffix}"
    if high is not None:
        return f"{kind} of at most {high:g}{suffix}"
    return kind + suffix
