# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""One line a stage: its name, how far it is and how long it takes."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import Self, TextIO

_WIDTH = 24


class StageLine:
    """Shows a stage of the set-up on one line of a terminal, or as a line at its begin and end elsewhere."""

    def __init__(self, name: str, total: int = 0, out: TextIO | None = None) -> None:
        self._name = name
        self._total = total
        self._out = out or sys.stderr
        self._live = self._out.isatty()
        self._started = time.monotonic()
        self._shown = 0.0

    def __enter__(self) -> Self:
        """Starts the clock and says what begins."""
        self._started = time.monotonic()
        if not self._live:
            self._out.write(f"{self._name} ...\n")
            self._out.flush()
        return self

    def update(self, done: int, note: str = "") -> None:
        """Shows that `done` of the total are done; at most ten times a second."""
        now = time.monotonic()
        if not self._live or now - self._shown < 0.1:
            return
        self._shown = now
        share = min(done / self._total, 1.0) if self._total else 0.0
        filled = round(share * _WIDTH)
        count = f"{done}/{self._total}" if self._total else ""
        bar = "━" * filled + "╌" * (_WIDTH - filled)
        line = f"{self._name:<22} {bar} {count:>8} {now - self._started:5.0f} s  {note}"
        self._out.write("\r\033[K" + line[:110])
        self._out.flush()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Says how it ended and how long it took."""
        seconds = time.monotonic() - self._started
        word = "done" if kind is None else "stopped" if kind is KeyboardInterrupt else "failed"
        start = "\r\033[K" if self._live else ""
        self._out.write(f"{start}{self._name:<22} {word} in {seconds:.0f} s\n")
        self._out.flush()
