# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What can be wrong with something that comes in over ROS."""

from __future__ import annotations

from walk_building.errors import WalkError


class MessageError(WalkError, ValueError):
    """A message that cannot be used; nothing of it is taken over.

    Attributes:
        kind: The message type, such as "nav_msgs/Path".
        reason: What is wrong with it: the value found and what was expected.
    """

    def __init__(self, kind: str, reason: str) -> None:
        self.kind = kind
        self.reason = reason
        super().__init__(f"{kind} message refused: {reason}")


class ArgumentError(WalkError, ValueError):
    """A ROS argument or parameter override that a node cannot start with.

    Attributes:
        reason: The sentence of the middleware or of the parameter.
    """

    def __init__(self, reason: str) -> None:
        self.reason = reason
        super().__init__(f"the node cannot start: {reason}")
