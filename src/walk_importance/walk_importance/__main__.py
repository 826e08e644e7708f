# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The executable `importance`."""

from __future__ import annotations

import sys

from walk_ros.entry import enter


def main() -> int:
    """Runs the node; returns the exit code."""
    return enter("walk_importance.node")


if __name__ == "__main__":
    sys.exit(main())
