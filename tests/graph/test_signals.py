# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C and SIGTERM in the first moments of an executable's life, while Python imports and DDS starts."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from graph.processes import LIMIT_S

pytestmark = pytest.mark.ros

_BOTH = (signal.SIGINT, signal.SIGTERM)


@pytest.fixture
def commands(rooms, tmp_path):
    """What the console scripts do, by name; a bag to replay is not needed to be told to end."""
    return {
        "importance": ["-m", "walk_importance", "--ros-args", "-p", f"building:={rooms}"],
        "sequencer": ["-m", "walk_sequencer", "--ros-args", "-p", f"building:={rooms}"],
        "trajopt": ["-m", "walk_trajopt", "--ros-args", "-p", f"building:={rooms}"],
        "record": ["-c", _script("record"), "--out", str(tmp_path / "bag")],
    }


def _script(name):
    return f"import sys; from walk_bag.executables import {name}; sys.exit({name}())"


def start(graph, name, command, block):
    log = (graph.folder / f"{name}.log").open("wb")
    with log:
        return subprocess.Popen(
            [sys.executable, *command],
            env=graph.environment(),
            stdout=log,
            stderr=log,
            preexec_fn=(lambda: signal.pthread_sigmask(signal.SIG_BLOCK, _BOTH)) if block else None,
        )


def assert_clean_ends(graph, processes):
    for name, process in processes.items():
        assert process.wait(LIMIT_S) == 0, (name, graph.log(name))
        assert "Traceback" not in graph.log(name), name


@pytest.mark.parametrize("delay_s", [0.0, 0.05, 0.2, 0.5, 1.0])
@pytest.mark.parametrize("number", _BOTH)
def test_a_signal_at_any_moment_of_the_start_is_a_clean_end(graph, commands, number, delay_s):
    """Started as a launcher may: with the signals blocked until the executable can take them."""
    processes = {name: start(graph, name, command, block=True) for name, command in commands.items()}
    time.sleep(delay_s)
    for process in processes.values():
        process.send_signal(number)
    assert_clean_ends(graph, processes)


@pytest.mark.parametrize("number", _BOTH)
def test_handlers_are_there_before_the_imports(graph, commands, number):
    """Started plainly: from the first handler on, which is long before the imports are done."""
    processes = {name: start(graph, name, command, block=False) for name, command in commands.items()}
    for process in processes.values():
        end = time.monotonic() + LIMIT_S
        while not _catches(process.pid, signal.SIGTERM):
            assert time.monotonic() < end
            time.sleep(0.005)
        modules = Path(f"/proc/{process.pid}/maps").read_text()
        assert "_rclpy_pybind11" not in modules
        process.send_signal(number)
    assert_clean_ends(graph, processes)


def _catches(pid, number):
    """Returns whether a process has a handler of its own for a signal."""
    status = Path(f"/proc/{pid}/status").read_text()
    mask = next(line.split()[1] for line in status.splitlines() if line.startswith("SigCgt:"))
    return bool(int(mask, 16) >> (number - 1) & 1)
