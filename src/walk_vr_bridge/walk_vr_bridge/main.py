# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The executable: says from the first moment what happens on a signal, then loads the rest."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Sequence
from types import FrameType


def main(argv: Sequence[str] | None = None) -> int:
    """Runs the bridge; returns the exit code."""
    # Loading takes a second, in which there is nothing yet that would have to be ended with care.
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, _leave)
    # A launcher may start the process with both blocked, so that none is lost before this.
    signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGINT, signal.SIGTERM))
    from walk_vr_bridge.runner import run_bridge

    return run_bridge(argv)


def _leave(number: int, frame: FrameType | None) -> None:
    del number, frame
    os._exit(0)


if __name__ == "__main__":
    sys.exit(main())
