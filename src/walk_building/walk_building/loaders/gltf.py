# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Which glTF extensions a file needs, asked before the mesh engine reads it."""

from __future__ import annotations

from pathlib import Path


def check_gltf(path: Path) -> None:
    """Refuses what the mesh engine cannot read."""
