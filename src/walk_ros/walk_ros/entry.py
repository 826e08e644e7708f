# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The first thing every executable does: from here on Ctrl-C and SIGTERM are a clean end, imports or not.

A node's imports take most of a second. This module needs none of them, nor do the packages' `__main__`.
"""

from __future__ import annotations

import importlib
import os
import signal
import sys
from collections.abc import Callable
from types import FrameType
from typing import NoReturn

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


def enter(module: str) -> NoReturn:
    """Imports a module, runs its `main` and ends the process with its code, which is 0 after SIGINT or SIGTERM.

    A launcher may start the process with both signals blocked, so that none is lost before this runs; they are let
    through here.
    """
    _on_signals(_leave)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, _SIGNALS)
    main: Callable[[], int] = importlib.import_module(module).main
    _on_signals(_interrupt)
    try:
        code = main()
    except KeyboardInterrupt:
        code = 0
    # All is closed; the interpreter's own end would only list what some compiled library has not given back.
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


def _on_signals(handler: Callable[[int, FrameType | None], None]) -> None:
    for number in _SIGNALS:
        signal.signal(number, handler)


def _leave(_number: int, _frame: FrameType | None) -> None:
    # Nothing has been started yet. An exception here would come out of some import, and be taken for its failure.
    os._exit(0)


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    raise KeyboardInterrupt
