# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From the first signal to a clean exit: the node in its thread, the web server in the main one."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
import threading
from collections.abc import Sequence
from pathlib import Path

import rclpy
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions

from walk_building.errors import WalkError
from walk_ros.errors import ArgumentError
from walk_ros.runner import EXIT_OK, EXIT_USER
from walk_vr_bridge.errors import PortError
from walk_vr_bridge.node import BridgeNode
from walk_vr_bridge.server import WebServer
from walk_vr_bridge.site import open_door, welcome

_SWITCH_S = 0.001
"""Threads change hands this often: an edit does not wait 5 ms for the worker that prepares a page's files."""


class Running:
    """The bridge while it runs."""

    def __init__(self) -> None:
        self._loop = asyncio.get_running_loop()
        self._stop = asyncio.Event()
        self._changed = asyncio.Event()
        for number in (signal.SIGINT, signal.SIGTERM):
            self._loop.add_signal_handler(number, self._stop.set)
        self._node = _make_node(self._loop, self._changed.set)
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)
        self._spinning = threading.Thread(target=_spin, args=(self._executor,), name="ROS", daemon=True)

    async def run(self) -> None:
        """Serves until a signal comes; starts again where the config changes."""
        self._spinning.start()
        sweeper = asyncio.create_task(self._sweep())
        try:
            while not self._stop.is_set():
                self._changed.clear()
                await self._serve()
        finally:
            sweeper.cancel()
            await asyncio.to_thread(self._end)

    async def _serve(self) -> None:
        node, config = self._node, self._node.config
        folder = Path(str(node.get_parameter("certificate_dir").value))
        door = await asyncio.to_thread(open_door, config, folder, _show)
        server = WebServer(node.site, door)
        try:
            port = await server.start("0.0.0.0" if config.lan else "127.0.0.1", config.port)
        except PortError as error:
            node.get_logger().error(str(error))
            node.diagnostics.note(address="", port_error=str(error))
            await self._wait()
            return
        node.diagnostics.note(
            address=f"{'https' if config.lan else 'http'}://{door.addresses[0]}:{port}", port_error=""
        )
        _show(welcome(door, port))
        try:
            await self._wait()
        finally:
            await server.stop()

    async def _wait(self) -> None:
        """Waits for a signal or for another port, another way to let clients in."""
        before = self._listening()
        while not self._stop.is_set() and self._listening() == before:
            waiting = [asyncio.create_task(event.wait()) for event in (self._stop, self._changed)]
            await asyncio.wait(waiting, return_when=asyncio.FIRST_COMPLETED)
            for task in waiting:
                task.cancel()
            self._changed.clear()

    def _listening(self) -> tuple[object, ...]:
        config = self._node.config
        return config.port, config.lan, config.hosts

    async def _sweep(self) -> None:
        while True:
            await asyncio.sleep(1.0)
            site = self._node.site
            site.operations.sweep()
            dropped = sum(client.outbox.dropped for client in site.hub.clients)
            self._node.diagnostics.note(clients=len(site.hub.clients), dropped_frames=dropped)

    def _end(self) -> None:
        self._executor.shutdown(timeout_sec=2.0)
        self._spinning.join(2.0)
        self._node.destroy_node()
        rclpy.try_shutdown()


def run_bridge(args: Sequence[str] | None) -> int:
    """Runs the bridge until SIGINT or SIGTERM; returns the exit code."""
    sys.setswitchinterval(_SWITCH_S)
    code = EXIT_OK
    try:
        asyncio.run(_run(args))
    except WalkError as error:
        sys.stderr.write(f"{error}\n")
        code = EXIT_USER
    finally:
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)
        rclpy.try_shutdown()
    sys.stdout.flush()
    sys.stderr.flush()
    if threading.active_count() > 1:
        # A worker deep in compiled code: the interpreter's own end would tear memory away under it.
        os._exit(code)
    return code


async def _run(args: Sequence[str] | None) -> None:
    try:
        rclpy.init(args=list(args) if args is not None else None, signal_handler_options=SignalHandlerOptions.NO)
    except RuntimeError as error:
        raise ArgumentError(str(error).strip()) from error
    await Running().run()


def _make_node(loop: asyncio.AbstractEventLoop, on_config: object) -> BridgeNode:
    assert callable(on_config)
    try:
        return BridgeNode(loop, on_config)
    except (InvalidParameterTypeException, InvalidParameterValueException) as error:
        raise ArgumentError(str(error)) from error


def _spin(executor: SingleThreadedExecutor) -> None:
    try:
        executor.spin()
    except ExternalShutdownException:
        pass
    except RuntimeError:  # of the layers below, where the end comes between two looks at the context
        if rclpy.ok():
            raise


def _show(text: str) -> None:
    """Writes to the terminal; what is shown may hold secrets, so it goes to no log."""
    sys.stdout.write(text)
    sys.stdout.flush()
