# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What can go wrong with a plan as a whole."""

from __future__ import annotations

from pathlib import Path

from walk_building.errors import WalkError


class NoWalkError(WalkError):
    """A building in which there are fewer than two places to walk between.

    Attributes:
        path: The building file.
        keypoints: How many reachable keypoints there are.
    """

    def __init__(self, path: Path, keypoints: int, reasons: str) -> None:
        self.path = path
        self.keypoints = keypoints
        because = f" ({reasons})" if reasons else ""
        super().__init__(
            f"{path}: a walk needs at least two viewpoints that can be reached, and there "
            f"{'is one' if keypoints == 1 else 'are none'}{because}; ask for more (--keypoints) or use a smaller walker"
        )


class OutputError(WalkError):
    """A folder that results cannot be written to.

    Attributes:
        path: The folder.
        reason: What is wrong with it and what to do about it, without its name.
    """

    def __init__(self, path: Path | str, reason: str) -> None:
        self.path = Path(path)
        self.reason = reason
        super().__init__(f"{self.path}: {reason}")
