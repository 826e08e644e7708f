# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The project's one exception tree: a class per situation, its data as attributes."""

from __future__ import annotations

from pathlib import Path


class WalkError(Exception):
    """Base of every error a user can cause or mend; its text is one clear sentence for that user."""


class BuildingError(WalkError):
    """A building file that cannot be used.

    Attributes:
        path: The file.
        reason: What is wrong with it and what to do about it, without the file's name.
    """

    def __init__(self, path: Path | str, reason: str) -> None:
        self.path = Path(path)
        self.reason = reason
        super().__init__(f"{self.path}: {reason}")


class ParameterError(WalkError, ValueError):
    """A parameter outside of what it may be.

    Attributes:
        name: The parameter.
        value: What was given.
        expected: What it may be, in words.
    """

    def __init__(self, name: str, value: object, expected: str) -> None:
        self.name = name
        self.value = value
        self.expected = expected
        super().__init__(f"{name} is {value!r}; expected {expected}")
