# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What the user can set about the bridge."""

from __future__ import annotations

import dataclasses

from walk_building.config import Config, param


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class BridgeConfig(Config):
    """Where the bridge listens, whom it lets in, and how much it sends."""

    port: int = param(8765, "port of the page, the files and the WebSocket; 0 takes a free one", low=0, high=65535)
    lan: bool = param(False, "let other machines in, always with TLS and a token; false: this machine only")
    hosts: str = param("", "further names, separated by commas, under which clients may reach the bridge")
    full_triangles: int = param(
        200_000, "triangles of the building at full scale; both eyes see it", low=1000, high=5_000_000
    )
    miniature_triangles: int = param(
        40_000, "triangles of the miniature; its cut faces are drawn twice", low=1000, high=1_000_000
    )
    viewpoint_hz: float = param(30.0, "how often playback says where the eye is", unit="Hz", low=1.0, high=120.0)
