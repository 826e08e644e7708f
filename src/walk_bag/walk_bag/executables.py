# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The executables `record`, `replay` and `viewer`."""

from __future__ import annotations

from walk_ros.entry import enter


def record() -> int:
    """Records until SIGINT or SIGTERM; returns the exit code."""
    return enter("walk_bag.record")


def replay() -> int:
    """Replays a bag; returns the exit code."""
    return enter("walk_bag.replay")


def viewer() -> int:
    """Shows the graph to Foxglove until SIGINT or SIGTERM; returns the exit code."""
    return enter("walk_bag.viewer")
