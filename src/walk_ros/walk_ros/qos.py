# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The QoS profiles of the walkthrough's topics."""

from __future__ import annotations

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

EDIT_DEPTH = 64
"""Edits kept for a slow reader: two thirds of a second of dragging at 90 edits a second."""


def latched(depth: int = 1) -> QoSProfile:
    """Returns the profile under which the last `depth` messages also reach late subscribers."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=depth,
        reliability=ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL,
    )


def reliable(depth: int = EDIT_DEPTH) -> QoSProfile:
    """Returns the profile of events: none is lost while the reader keeps up, none is kept for latecomers."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=depth,
        reliability=ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.VOLATILE,
    )


def best_effort() -> QoSProfile:
    """Returns the profile of a stream of which only the newest message counts."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=1,
        reliability=ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.VOLATILE,
    )
