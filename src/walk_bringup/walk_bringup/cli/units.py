# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A unit of length on the command line: a word or the length in metres."""

from __future__ import annotations

from typing import Any

import click

UNITS_M = {"mm": 0.001, "cm": 0.01, "m": 1.0, "in": 0.0254, "ft": 0.3048}
"""What the words mean [m]."""


class UnitOfLength(click.ParamType[float]):
    """Takes one of the words or a number; gives metres."""

    name = "unit"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Returns the length of one unit [m]; what it may be, the config says."""
        word = str(value).strip().lower()
        try:
            return UNITS_M[word] if word in UNITS_M else float(word)
        except ValueError:
            words = ", ".join(UNITS_M)
            self.fail(
                f"{value!r} is no unit; expected one of {words}, or its length in metres, such as 0.01", param, ctx
            )
