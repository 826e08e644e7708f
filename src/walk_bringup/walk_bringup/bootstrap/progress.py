# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""One line a stage: its name, how far it is and how long it takes."""

from __future__ import annotations

import sys
import threading
import time
from types import TracebackType
from typing import Self, TextIO

_WIDTH = 24
BEAT_S = 15.0
"""Where there is no terminal, a line says this often that it goes on: a log that stands still looks like a hang."""


class StageLine:
    """Shows a stage of the set-up on one line of a terminal; elsewhere as lines at its begin, meanwhile and its end."""

    def __init__(self, name: str, total: int = 0, out: TextIO | None = None, beat_s: float = BEAT_S) -> None:
        self._name = name
        self._total = total
        self._out = out or sys.stderr
        self._live = self._out.isatty()
        self._started = time.monotonic()
        self._shown = 0.0
        self._beat_s = beat_s
        self._so_far = ""
        self._over = threading.Event()
        self._beating = threading.Thread(target=self._beat, name="set-up beat", daemon=True)

    def __enter__(self) -> Self:
        """Starts the clock and says what begins."""
        self._started = time.monotonic()
        if not self._live:
            self._out.write(f"{self._name} ...\n")
            self._out.flush()
            self._beating.start()
        return self

    def update(self, done: int, note: str = "") -> None:
        """Shows that `done` of the total are done; at most ten times a second."""
        now = time.monotonic()
        if not self._live:
            self._so_far = f", {done} of {self._total}" if self._total else ""
            return
        if now - self._shown < 0.1:
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
        self._over.set()
        if not self._live:
            self._beating.join()
        seconds = time.monotonic() - self._started
        word = "done" if kind is None else "stopped" if kind is KeyboardInterrupt else "failed"
        start = "\r\033[K" if self._live else ""
        self._out.write(f"{start}{self._name:<22} {word} in {seconds:.0f} s\n")
        self._out.flush()

    def _beat(self) -> None:
        while not self._over.wait(self._beat_s):
            seconds = time.monotonic() - self._started
            self._out.write(f"{self._name:<22} goes on, {seconds:.0f} s{self._so_far}\n")
            self._out.flush()
