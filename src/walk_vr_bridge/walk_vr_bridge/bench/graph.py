# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The processes of a measurement: the node that copies, and the bridge, on a ROS domain of their own."""

from __future__ import annotations

import os
import random
import signal
import socket
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

from walk_building.errors import WalkError

# Above 101 the ports of a domain reach into those that Linux gives to outgoing connections.
_DOMAINS = range(1, 102)
_START_S = 60.0


class BenchError(WalkError):
    """A measurement that cannot be taken; the text says why."""


class BenchGraph:
    """Starts copier and bridge; ends them with `close`.

    Attributes:
        port: Of the bridge.
    """

    def __init__(self, folder: Path, building: str) -> None:
        """Starts the processes.

        Args:
            folder: For their logs.
            building: Path, empty for the sample.
        """
        os.environ["ROS_DOMAIN_ID"] = str(random.choice(_DOMAINS))
        os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
        self.port = _free_port()
        self._folder = folder
        self._running = [
            self._start("copier", "walk_vr_bridge.bench.copier"),
            self._start("bridge", "walk_vr_bridge.main", *bridge_parameters(building, self.port)),
        ]

    @property
    def url(self) -> str:
        """Of the bridge."""
        return f"http://localhost:{self.port}"

    def wait(self) -> None:
        """Waits until the building is served: from then on the bridge is at rest."""
        until = time.monotonic() + _START_S
        while time.monotonic() < until:
            if any(process.poll() is not None for process in self._running):
                break
            try:
                with urllib.request.urlopen(f"{self.url}/building.json", timeout=2.0):
                    return
            except OSError:
                time.sleep(0.1)
        raise BenchError(f"the bridge did not start: {self.log()[-2000:]}")

    def memory_mib(self) -> float:
        """Returns what the bridge holds [MiB]."""
        status = Path(f"/proc/{self._running[1].pid}/status").read_text()
        return sum(int(line.split()[1]) for line in status.splitlines() if line.startswith("VmRSS:")) / 1024

    def running(self) -> bool:
        """Returns whether both processes run."""
        return all(process.poll() is None for process in self._running)

    def log(self) -> str:
        """Returns what the bridge has written."""
        return (self._folder / "bridge.log").read_text(errors="replace")

    def close(self) -> list[int]:
        """Ends the processes; returns their exit codes."""
        for process in self._running:
            process.send_signal(signal.SIGINT)
        codes = []
        for process in self._running:
            try:
                codes.append(process.wait(10.0))
            except subprocess.TimeoutExpired:
                process.kill()
                codes.append(process.wait())
        return codes

    def _start(self, name: str, module: str, *parameters: str) -> subprocess.Popen[bytes]:
        ros = [part for parameter in parameters for part in ("-p", parameter)]
        with (self._folder / f"{name}.log").open("wb") as log:
            return subprocess.Popen([sys.executable, "-m", module, "--ros-args", *ros], stdout=log, stderr=log)


def bridge_parameters(building: str, port: int) -> list[str]:
    """Returns the bridge's parameters; an empty one, for the sample, cannot be written on a command line of ROS."""
    return [f"bridge.port:={port}", *([f"building:={building}"] if building else [])]


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
