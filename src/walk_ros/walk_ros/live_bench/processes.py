# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The processes of one measurement, on a ROS domain and a state folder of their own."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

NODES = {
    "importance": "walk_importance.node",
    "sequencer": "walk_sequencer.node",
    "trajopt": "walk_trajopt.node",
    "null": "walk_ros.live_bench.null_node",
}
"""The modules of the three nodes and of the one that only copies."""

_END_S = 8.0
# Above 101 the ports of a domain reach into those that Linux gives to outgoing connections.
_DOMAINS = range(1, 102)


def take_own_domain() -> int:
    """Chooses a ROS domain for this process and its children, found on this machine only; returns it."""
    domain = random.choice(_DOMAINS)
    os.environ["ROS_DOMAIN_ID"] = str(domain)
    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    return domain


class Processes:
    """Nodes as processes; what they write goes to a file each."""

    def __init__(self, folder: Path) -> None:
        """Starts nothing yet.

        Args:
            folder: For journals and logs.
        """
        self._folder = folder
        self._running: dict[str, subprocess.Popen[bytes]] = {}

    def start(self, name: str, parameters: Mapping[str, object], remaps: Sequence[str] = ()) -> None:
        """Starts one of NODES with parameters."""
        ros = [part for key, value in parameters.items() for part in ("-p", f"{key}:={value}")]
        ros += [part for remap in remaps for part in ("-r", remap)]
        env = dict(os.environ, XDG_STATE_HOME=str(self._folder / "state"))
        with (self._folder / f"{name}.log").open("ab") as log:
            self._running[name] = subprocess.Popen(
                [sys.executable, "-m", NODES[name], "--ros-args", *ros], env=env, stdout=log, stderr=log
            )

    def ended(self) -> list[str]:
        """Returns the names of those that have ended by themselves, with the last line each wrote."""
        return [f"{name}: {self._last_line(name)}" for name, p in self._running.items() if p.poll() is not None]

    def rss_mib(self) -> dict[str, float]:
        """Returns the memory that each node holds now [MiB]; nothing where the system does not tell."""
        found = {}
        for name, process in self._running.items():
            status = Path(f"/proc/{process.pid}/status")
            if status.exists():
                kib = [int(line.split()[1]) for line in status.read_text().splitlines() if line.startswith("VmRSS:")]
                found[name] = round(sum(kib) / 1024, 1)
        return found

    def cpu_s(self) -> dict[str, float]:
        """Returns the processor time that each node has used so far [s]; nothing where the system does not tell."""
        found = {}
        for name, process in self._running.items():
            stat = Path(f"/proc/{process.pid}/stat")
            if stat.exists():
                fields = stat.read_text().rpartition(")")[2].split()
                found[name] = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
        return found

    def close(self) -> None:
        """Ends all processes."""
        for process in self._running.values():
            process.send_signal(signal.SIGINT)
        for process in self._running.values():
            try:
                process.wait(_END_S)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        self._running.clear()

    def _last_line(self, name: str) -> str:
        lines = (self._folder / f"{name}.log").read_text(errors="replace").strip().splitlines()
        return lines[-1] if lines else "it wrote nothing"
