# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Writing a bag beside the executor, which must never wait for a disk."""

from __future__ import annotations

import contextlib
import os
import queue
import threading
import time
from collections.abc import Callable

from walk_bag.bag_writer import BagWriter
from walk_bag.errors import BagError
from walk_bag.topics import BagTopic

FLUSH_S = 1.0
"""At most this much of a session is lost when the process is killed."""

_Item = tuple[BagTopic, int, bytes]


class Spool:
    """Takes messages from any thread and writes them in one of its own."""

    def __init__(self, writer: BagWriter, on_error: Callable[[BagError], None], flush_s: float = FLUSH_S) -> None:
        """Begins; the writing thread comes with the first message.

        So a recorder that is told to end before it has heard anything has no thread that would keep its end from
        closing the bag.

        Args:
            writer: The bag; closed by whoever made it.
            on_error: Called once, from the writing thread, when the bag cannot be written any more.
            flush_s: Longest time [s] until a message is handed to the operating system.
        """
        self._writer = writer
        self._on_error = on_error
        self._flush_s = flush_s
        self._items: queue.SimpleQueue[_Item | None] = queue.SimpleQueue()
        self._starting = threading.Lock()
        self._thread: threading.Thread | None = None

    def put(self, topic: BagTopic, stamp_ns: int, data: bytes) -> None:
        """Hands a message over; returns at once."""
        self._items.put((topic, stamp_ns, data))
        with self._starting:
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="spool", daemon=True)
                self._thread.start()

    def close(self) -> None:
        """Writes what was handed over and ends the thread."""
        self._items.put(None)
        if self._thread is not None:
            self._thread.join()

    def _run(self) -> None:
        _go_behind_all_others()
        try:
            self._write_all()
        except BagError as error:
            self._on_error(error)

    def _write_all(self) -> None:
        waiting_since: float | None = None  # of the oldest message that is not flushed
        while True:
            item: _Item | None = None
            with contextlib.suppress(queue.Empty):
                item = self._items.get(timeout=self._flush_s)
                if item is None:
                    return
                self._writer.write(*item)
                waiting_since = time.monotonic() if waiting_since is None else waiting_since
            if waiting_since is not None and time.monotonic() - waiting_since >= self._flush_s:
                self._writer.flush()
                waiting_since = None


def _go_behind_all_others() -> None:
    """Lets this thread run only where a processor is free: compressing must not make an edit wait for its turn.

    A thread that is merely nice is let finish its turn of some milliseconds when another wakes up.
    """
    with contextlib.suppress(OSError):
        os.sched_setscheduler(threading.get_native_id(), os.SCHED_IDLE, os.sched_param(0))
