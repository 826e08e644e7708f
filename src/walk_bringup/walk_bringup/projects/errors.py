# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What can be wrong with a project."""

from __future__ import annotations

from pathlib import Path

from walk_building.errors import WalkError


class ProjectError(WalkError):
    """A project that cannot be saved or opened.

    Attributes:
        path: The folder or the file.
        reason: What is wrong and what to do about it, without the path.
    """

    def __init__(self, path: Path | str, reason: str) -> None:
        self.path = Path(path)
        self.reason = reason
        super().__init__(f"{self.path}: {reason}")
