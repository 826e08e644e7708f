# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What each stage of a plan costs: its time, and the peak memory of the process."""

from __future__ import annotations

import resource
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from walk_building.progress import Progress

STAGES = ("load", "importance", "keypoints", "tour", "trajectory", "timing", "metrics", "write")
"""The stages of a plan in their order, as the progress callback and the report name them."""


class StageClock:
    """Times the stages of one plan and tells the progress callback when each starts and ends.

    Attributes:
        seconds: From stage to its wall time, filled as the stages end [s].
    """

    def __init__(self, progress: Progress) -> None:
        self.seconds: dict[str, float] = {}
        self._progress = progress

    @contextmanager
    def stage(self, name: str) -> Iterator[Progress]:
        """Times the body of the `with`; gives it a progress callback that reports under the stage's name."""
        self._progress(name, 0.0)
        started = time.perf_counter()
        yield lambda _, fraction: self._progress(name, min(max(fraction, 0.0), 0.999))
        self.seconds[name] = time.perf_counter() - started
        self._progress(name, 1.0)


def peak_memory_mib() -> float:
    """Returns the largest resident memory this process has had so far [MiB]."""
    status = Path("/proc/self/status")
    if status.exists():
        # Not ru_maxrss where it can be avoided: a child inherits the peak of the process it was forked from.
        for line in status.read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) / 1024
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / 1024 if sys.platform != "darwin" else peak / 1024**2
