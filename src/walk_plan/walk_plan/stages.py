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


_PIECES = {"roadmap": (0.0, 0.3), "legs": (0.3, 0.9), "order": (0.9, 1.0)}
"""Stages that report their pieces one after the other, each from 0 to 1: where in the whole a piece lies."""


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
        furthest = 0.0

        def told(piece: str, fraction: float) -> None:
            # A bar that goes back, or that is full before the end, tells nothing.
            nonlocal furthest
            begin, end = _PIECES.get(piece, (0.0, 1.0))
            furthest = max(furthest, min(begin + (end - begin) * fraction, 0.999))
            self._progress(name, furthest)

        yield told
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
