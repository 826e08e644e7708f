# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The errors of the command itself; walk_building's WalkError cannot be imported before there is an installation."""

from __future__ import annotations


class SetupError(Exception):
    """A set-up or a command that cannot go on; its text is one clear sentence for the user."""
