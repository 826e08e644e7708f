# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C and SIGTERM in the first moments of an executable's life, while Python imports and DDS starts."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from graph.processes import LIMIT_S

from walk_bag.bag_writer import BagWriter
from walk_bag.topics import BagTopic
from walk_ros.conversions import EditKind, KeypointEdit, edit_to_msg
from walk_ros.raw import to_bytes
from walk_ros.topics import TOPICS, type_name

pytestmark = pytest.mark.ros

_BOTH = (signal.SIGINT, signal.SIGTERM)
LOOKS = 5


@pytest.fixture
def commands(rooms, tmp_path):
    """What the console scripts do, by name."""
    return {
        "importance": ["-m", "walk_importance", "--ros-args", "-p", f"building:={rooms}"],
        "sequencer": ["-m", "walk_sequencer", "--ros-args", "-p", f"building:={rooms}"],
        "trajopt": ["-m", "walk_trajopt", "--ros-args", "-p", f"building:={rooms}"],
        "bridge": ["-m", "walk_vr_bridge.main", "--ros-args", "-p", f"building:={rooms}", "-p", "bridge.port:=0"],
        "record": ["-c", _script("record"), "--out", str(tmp_path / "bag")],
        "replay": ["-c", _script("replay"), str(_bag(tmp_path / "recorded")), "--hold"],
    }


def _bag(folder):
    """Writes a bag of one message."""
    edit = KeypointEdit(
        kind=EditKind.RELEASE,
        keypoint=0,
        client_id="anna",
        stamp_ns=1,
        position=np.zeros(3),
        quat_xyzw=np.array([0.0, 0.0, 0.0, 1.0]),
    )
    kind = type_name(TOPICS["keypoint_edits"].type)
    topic = BagTopic(name="/walk/keypoint_edits", type_name=kind, latched=False, reliable=True, depth=10)
    with BagWriter(folder) as bag:
        bag.write(topic, 1, to_bytes(edit_to_msg(edit)))
    return folder


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
    for name, command in commands.items():
        # Who is kept from looking for longer than the imports take has seen nothing, and looks at another start.
        for _ in range(LOOKS):
            process = start(graph, name, command, block=False)
            end = time.monotonic() + LIMIT_S
            while not _catches(process.pid, signal.SIGTERM):
                assert time.monotonic() < end
                time.sleep(0.002)
            modules = Path(f"/proc/{process.pid}/maps").read_text()
            process.send_signal(number)
            assert_clean_ends(graph, {name: process})
            if "_rclpy_pybind11" not in modules:
                break
        else:
            pytest.fail(f"{name} takes signals only once it has imported the middleware")


def _catches(pid, number):
    """Returns whether a process has a handler of its own for a signal."""
    status = Path(f"/proc/{pid}/status").read_text()
    mask = next(line.split()[1] for line in status.splitlines() if line.startswith("SigCgt:"))
    return bool(int(mask, 16) >> (number - 1) & 1)


def test_a_launcher_told_to_end_at_once_ends_all_nodes_cleanly(graph, commands):
    """As `./walk up` does it: all are told while Python still starts."""
    starting = "; ".join(
        [
            "import os, signal",
            "from walk_bringup.cli.processes import Child, Supervisor",
            f"up = Supervisor([Child(name=n, command=({sys.executable!r}, *c), unblocks=True) for n, c in COMMANDS])",
            "up.start()",
            "children = dict(up._running)",
            "os.kill(os.getpid(), signal.SIGINT)",
            "up.wait()",
            "print({name: child.returncode for name, child in children.items()})",
        ]
    ).replace("COMMANDS", repr(list(commands.items())))
    done = subprocess.run(
        [sys.executable, "-c", starting], env=graph.environment(), capture_output=True, text=True, timeout=LIMIT_S
    )
    assert done.stdout.splitlines()[-1] == str(dict.fromkeys(commands, 0)), done
