# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From `main` to a clean exit: what every executable does around its node."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import rclpy
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.utilities import remove_ros_args

from walk_building.errors import WalkError
from walk_ros.errors import ArgumentError

EXIT_OK = 0
EXIT_USER = 2
"""The user's input cannot be used: the sentence is on stderr."""


def run_node(factory: Callable[[], Node], args: Sequence[str] | None = None) -> int:
    """Runs the node until SIGINT, SIGTERM or a shut-down; returns the exit code.

    Args:
        factory: Makes the node, once the middleware is up; its `niceness`, if it has one, is the process's.
        args: Command line; None takes that of the process.
    """
    node: Node | None = None
    code = EXIT_OK
    try:
        _step_back(getattr(factory, "niceness", 0))
        with _signals_held():
            _start_middleware(args)
            node = _make(factory)
            executor = SingleThreadedExecutor()
        rclpy.spin(node, executor)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RuntimeError:  # of the layers below, where the end comes between two looks at the context
        if rclpy.ok():
            raise
    except WalkError as error:
        sys.stderr.write(f"{error}\n")
        code = EXIT_USER
    finally:
        _clean_up(node)
    if threading.active_count() > 1:
        # A worker deep in compiled code: the interpreter's own end would tear memory away under it.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
    return code


def user_arguments(argv: Sequence[str]) -> list[str]:
    """Returns the command line without its `--ros-args` parts."""
    return list(remove_ros_args(args=list(argv)))


_PROFILES = ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE")
"""Both names of the variable that gives Fast DDS a file of profiles; other middleware does not look at them."""


def use_profiles() -> None:
    """Has Fast DDS read the profiles of this package, unless the user has named others."""
    if not any(os.environ.get(name) for name in _PROFILES):
        os.environ[_PROFILES[0]] = str(Path(__file__).with_name("fastdds.xml"))


def _step_back(niceness: int) -> None:
    """Has the process step back behind others, before it starts its threads: each takes it from the one before."""
    if niceness and hasattr(os, "nice"):
        os.nice(max(niceness - os.nice(0), 0))


@contextlib.contextmanager
def _signals_held() -> Iterator[None]:
    """Lets SIGINT and SIGTERM wait: the middleware ends at once, and a node half made in it fails in many ways."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT, signal.SIGTERM))
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _start_middleware(args: Sequence[str] | None) -> None:
    use_profiles()
    try:
        rclpy.init(args=list(args) if args is not None else None)
    except RuntimeError as error:  # what every error of the layers below is
        raise ArgumentError(str(error).strip()) from error


def _make(factory: Callable[[], Node]) -> Node:
    try:
        return factory()
    except (InvalidParameterTypeException, InvalidParameterValueException) as error:
        raise ArgumentError(str(error)) from error


def _clean_up(node: Node | None) -> None:
    """Ends the node and the middleware; a second Ctrl-C, as a launcher sends it, does not cut this short."""
    end_node: list[Callable[[], object]] = [] if node is None else [node.destroy_node]
    # Signals are ignored twice: the middleware puts Python's own handlers back when it shuts down.
    for step in [_ignore_signals, *end_node, rclpy.try_shutdown, _ignore_signals]:
        with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
            step()


def _ignore_signals() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
