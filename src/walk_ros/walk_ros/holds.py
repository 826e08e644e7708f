# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Who holds which keypoint: several editors at once never pull at the same one."""

from __future__ import annotations

HOLD_TIMEOUT_S = 10.0
"""An editor that is silent for so long has lost its keypoint."""


class Holds:
    """The keypoints that editors have in their hands."""

    def __init__(self) -> None:
        self._held: dict[int, tuple[str, float]] = {}

    def take(self, keypoint: int, client_id: str, now_s: float, timeout_s: float = HOLD_TIMEOUT_S) -> str:
        """Gives the keypoint to the editor, or keeps it there; returns who else holds it, "" if it is theirs now."""
        holder, since_s = self._held.get(keypoint, (client_id, now_s))
        if holder != client_id and now_s - since_s <= timeout_s:
            return holder
        self._held[keypoint] = (client_id, now_s)
        return ""

    def release(self, keypoint: int, client_id: str) -> None:
        """Frees the keypoint if the editor holds it."""
        if self._held.get(keypoint, ("", 0.0))[0] == client_id:
            del self._held[keypoint]
