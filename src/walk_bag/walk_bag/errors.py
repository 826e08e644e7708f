# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What can be wrong with a bag."""

from __future__ import annotations

from pathlib import Path

from walk_building.errors import WalkError


class BagError(WalkError):
    """A bag that cannot be written or read.

    Attributes:
        path: The bag.
        reason: What is wrong and what to do about it, without the path.
    """

    def __init__(self, path: Path | str, reason: str) -> None:
        self.path = Path(path)
        self.reason = reason
        super().__init__(f"{self.path}: {reason}")


class ExportError(WalkError):
    """An export that cannot be made, or a file of keypoints that cannot be read.

    Attributes:
        path: The file.
        reason: What is wrong and what to do about it, without the path.
    """

    def __init__(self, path: Path | str, reason: str) -> None:
        self.path = Path(path)
        self.reason = reason
        super().__init__(f"{self.path}: {reason}")
