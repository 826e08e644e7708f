# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The thread that writes a bag goes behind all others, and writes what it was handed, in order."""

from __future__ import annotations

import os
import threading
import time
from pathlib import Path

from walk_bag import BagTopic, BagWriter, read_bag
from walk_bag.spool import Spool

TOUR = BagTopic(name="/walk/tour", type_name="nav_msgs/msg/Path", latched=True, reliable=True, depth=1)


def test_only_the_writing_thread_runs_behind_all_others(tmp_path: Path) -> None:
    with BagWriter(tmp_path / "bag.mcap") as writer:
        begun = (tmp_path / "bag.part.mcap").stat().st_size
        spool = Spool(writer, lambda error: None, flush_s=0.01)
        for i in range(100):
            spool.put(TOUR, i, bytes([i]))
        (thread,) = [t for t in threading.enumerate() if t.name == "spool"]
        while (tmp_path / "bag.part.mcap").stat().st_size == begun:
            time.sleep(0.001)
        policies = os.sched_getscheduler(thread.native_id or 0), os.sched_getscheduler(threading.get_native_id())
        spool.close()
    assert policies == (os.SCHED_IDLE, os.SCHED_OTHER)
    assert [(m.stamp_ns, m.data) for m in read_bag(tmp_path / "bag.mcap")] == [(i, bytes([i])) for i in range(100)]
