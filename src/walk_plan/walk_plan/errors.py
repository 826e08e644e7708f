# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What can go wrong with a plan as a whole."""

from __future__ import annotations

from collections.abc import Sequence
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


class TooFewKeypointsError(WalkError):
    """Keypoints of the user's between which there is no walk.

    Attributes:
        source: Where they come from.
        keypoints: How many of them can be reached.
    """

    def __init__(self, source: str, keypoints: int, left_out: Sequence[str] = ()) -> None:
        self.source = source
        self.keypoints = keypoints
        there = {0: "are none", 1: "is one"}.get(keypoints, f"are {keypoints}")
        which = " that can be reached" if left_out else ""
        because = f"; {' '.join(left_out)}".removesuffix(".")
        super().__init__(
            f"{source}: a walk needs at least two keypoints{which}, and there {there}"
            + (because if left_out else "; add another, or bring none and have them suggested")
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
