# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Walkthroughs as rosbag2 (MCAP) bags: written from results, recorded from a running graph, replayed."""

from walk_bag.errors import BagError
from walk_bag.storage import BagWriter, read_bag, recover_bag
from walk_bag.topics import BagMessage, BagTopic
from walk_bag.walkthrough import write_walkthrough_bag

__all__ = ["BagError", "BagMessage", "BagTopic", "BagWriter", "read_bag", "recover_bag", "write_walkthrough_bag"]
