# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The thread a node works in, so that its constructor never blocks and its callbacks only store input."""

from __future__ import annotations

import logging
import math
import threading
import time
from collections.abc import Callable

_log = logging.getLogger(__name__)

REST_S = 0.006
"""How long input that is not urgent waits: for as long as others need the cores to answer the same edit."""


class Superseded(Exception):  # noqa: N818  not an error: newer input came, or the node ends
    """Raised inside a step of a worker whose result nobody waits for any more."""


class Worker:
    """Runs one step at a time, as often as there is new input; what came in between is served by one run.

    The step reads the newest input itself, so the latest wins and what it replaced is dropped.
    """

    def __init__(self, name: str, step: Callable[[], None], on_error: Callable[[Exception], None]) -> None:
        """Makes the worker; `start` starts it.

        Args:
            name: Of the thread.
            step: Does what the newest input asks for.
            on_error: Called in the thread with what a step raised; the worker lives on.
        """
        self._step = step
        self._on_error = on_error
        self._wake = threading.Condition()
        self._due_s = math.inf  # when the next step begins; inf where there is nothing new
        self._superseded = threading.Event()
        self._stopped = threading.Event()
        self._working = threading.Lock()
        # A daemon: a step deep in compiled code must not keep a process alive that was told to end.
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)

    def start(self) -> None:
        """Starts the thread."""
        self._thread.start()

    def wake(self, supersede: bool = False, *, rest_s: float = 0.0) -> None:
        """Says that there is new input.

        Args:
            supersede: A running step ends at its next progress report.
            rest_s: How long it may wait, unless something more urgent comes before.
        """
        if supersede:
            self._superseded.set()
        with self._wake:
            self._due_s = min(self._due_s, time.monotonic() + rest_s)
            self._wake.notify()

    def now(self, step: Callable[[], None]) -> None:
        """Runs a short step in the calling thread if the worker is at rest; otherwise only wakes the worker.

        Handing an edit to another thread costs more than answering it: the two fight for the interpreter.
        """
        if not self._working.acquire(blocking=False):
            self.wake()
            return
        try:
            self._attempt(step)
        finally:
            self._working.release()

    def stop(self, timeout_s: float) -> bool:
        """Ends the thread; returns whether it has ended within the time."""
        self._stopped.set()
        self.wake(supersede=True)
        if self._thread.ident is not None:
            self._thread.join(timeout_s)
        return not self._thread.is_alive()

    def progress(self, stage: str, fraction: float) -> None:
        """A `Progress` for what a step calls; raises Superseded once the step is superseded."""
        if self._superseded.is_set():
            raise Superseded
        _log.debug("%s %.0f %%", stage, 100 * fraction)

    def _run(self) -> None:
        while True:
            with self._wake:
                while (left_s := self._due_s - time.monotonic()) > 0:
                    self._wake.wait(left_s if left_s < math.inf else None)
                # Before the step reads its input: what comes in from here on wakes it again.
                self._due_s = math.inf
            if self._stopped.is_set():
                return
            with self._working:
                self._superseded.clear()
                self._attempt(self._step)

    def _attempt(self, step: Callable[[], None]) -> None:
        try:
            step()
        except Superseded:
            pass
        except Exception as error:  # a node lives on, whatever one step ran into
            if not self._stopped.is_set():
                self._on_error(error)
