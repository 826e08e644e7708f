# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a user can tune about how edits are taken."""

from __future__ import annotations

import dataclasses

from walk_building.config import Config, param


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class EditingConfig(Config):
    """How edits are taken."""

    pull_m: float = param(
        0.25,
        "farthest an edited keypoint is pulled to a place to stand on; beyond it the edit is refused. A body's radius: "
        "a keypoint put against a wall means the place beside it, one put into a wall means nothing",
        unit="m",
        low=0.0,
        high=3.0,
    )
    restore: bool = param(
        True, "begin with the keypoints in the journal of this building; false puts the journal aside at the next load"
    )
    session_start_s: float = param(
        0.0,
        "when this session began, in seconds since 1970: a journal written later is its own and comes back even where "
        "restore is false, so that a node that is started again loses nothing; 0: not known",
        unit="s",
        low=0.0,
        high=1e11,
    )
