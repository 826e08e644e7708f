# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Child processes of `./walk up`: started together, logged with their names in front, stopped together."""

from __future__ import annotations

import ctypes
import dataclasses
import functools
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Sequence
from types import FrameType
from typing import IO

import click

_COLOURS = ("cyan", "green", "magenta", "yellow", "blue")
_PR_SET_PDEATHSIG = 1
_GRACE_S = 8.0  # a node's worker may need 3 s to end, and the others run beside it on few cores
_LOOK_S = 0.1  # between two looks at whether a child has ended, or the end is asked for


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Child:
    """A process to be started.

    Attributes:
        name: What its lines begin with.
        command: And its arguments.
        unblocks: Whether it lets SIGINT and SIGTERM through by itself once it can end cleanly, as `walk_ros.entry`
            does; it is started with both blocked, so that one sent before is neither lost nor the end of the
            interpreter half-way through its imports.
    """

    name: str
    command: tuple[str, ...]
    unblocks: bool = False


class Supervisor:
    """Runs children until all have ended or a signal asks for the end. Nothing is started again."""

    def __init__(self, children: Sequence[Child]) -> None:
        self._children = children
        self._running: dict[str, subprocess.Popen[str]] = {}
        self._readers: list[threading.Thread] = []
        self._lock = threading.Lock()
        # Not an Event: its lock, held by the thread that waits, is what a handler in that same thread would wait for.
        self._told_to_end = False
        self.failed: list[str] = []

    def start(self) -> None:
        """Starts all children."""
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, self._on_signal)
        for child in self._children:
            # A session of their own: Ctrl-C reaches them once, from here.
            self._running[child.name] = subprocess.Popen(
                child.command,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                errors="replace",
                start_new_session=True,
                preexec_fn=functools.partial(_prepare, child.unblocks),
            )
        # Only now: a process that has threads should not fork.
        width = max(len(child.name) for child in self._children)
        for index, (name, process) in enumerate(self._running.items()):
            prefix = click.style(f"{name:<{width}} │ ", fg=_COLOURS[index % len(_COLOURS)])
            assert process.stdout is not None
            reader = threading.Thread(target=self._copy, args=(prefix, process.stdout), daemon=True)
            reader.start()
            self._readers.append(reader)

    def wait(self) -> None:
        """Waits until all children have ended or the end is asked for, then ends what is left."""
        while self._running and not self._told_to_end:
            time.sleep(_LOOK_S)
            for name, process in list(self._running.items()):
                if process.poll() is not None:
                    del self._running[name]
                    self._tell_end(name, process.returncode)
        self._end_all()

    def say(self, text: str) -> None:
        """Prints a line between those of the children."""
        with self._lock:
            click.echo(text)

    def _tell_end(self, name: str, code: int) -> None:
        self.failed.append(name)
        how = f"was ended by {signal.Signals(-code).name}" if code < 0 else f"ended with code {code}"
        others = f"; {', '.join(self._running)} go on" if self._running else ""
        self.say(f"walk: {name} {how}{others}.")

    def _end_all(self) -> None:
        for number, patience in ((signal.SIGINT, _GRACE_S), (signal.SIGTERM, 2.0), (signal.SIGKILL, 2.0)):
            left = {name: process for name, process in self._running.items() if process.poll() is None}
            if not left:
                break
            if number == signal.SIGKILL:
                self.say(f"walk: {', '.join(left)} did not end when asked and is killed.")
            for process in left.values():
                process.send_signal(number)
            _wait_for(list(left.values()), patience)
        for reader in self._readers:
            reader.join(timeout=1.0)

    def _copy(self, prefix: str, stream: IO[str]) -> None:
        for line in stream:
            self.say(prefix + line.rstrip("\n"))

    def _on_signal(self, number: int, frame: FrameType | None) -> None:
        del number, frame
        self._told_to_end = True


def _wait_for(processes: list[subprocess.Popen[str]], seconds: float) -> None:
    until = time.monotonic() + seconds
    while time.monotonic() < until and any(process.poll() is None for process in processes):
        time.sleep(0.02)


def _prepare(unblocks: bool) -> None:
    if unblocks:
        signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT, signal.SIGTERM))
    if sys.platform == "linux":
        # Where `walk up` itself is killed nobody is left to stop the nodes.
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
