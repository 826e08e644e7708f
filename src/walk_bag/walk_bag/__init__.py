# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Walkthroughs as rosbag2 (MCAP) bags: written from results, recorded from a running graph, replayed."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from walk_bag.bag_reader import read_bag
    from walk_bag.bag_writer import BagWriter
    from walk_bag.errors import BagError
    from walk_bag.recover import recover_bag
    from walk_bag.topics import BagMessage, BagTopic
    from walk_bag.walkthrough import write_walkthrough_bag

__all__ = ["BagError", "BagMessage", "BagTopic", "BagWriter", "read_bag", "recover_bag", "write_walkthrough_bag"]

_HOMES = {
    "walk_bag.bag_reader": ("read_bag",),
    "walk_bag.bag_writer": ("BagWriter",),
    "walk_bag.errors": ("BagError",),
    "walk_bag.recover": ("recover_bag",),
    "walk_bag.topics": ("BagMessage", "BagTopic"),
    "walk_bag.walkthrough": ("write_walkthrough_bag",),
}


def __getattr__(name: str) -> object:
    """Imports what is asked for: all of it at once would keep every executable from starting at once."""
    for module, names in _HOMES.items():
        if name in names:
            return getattr(importlib.import_module(module), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
