# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
import os
import signal
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from graph.domains import own_domain

from walk_ros.runner import use_profiles

NAMES = ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE")


def test_fast_dds_gets_a_file_that_there_is(monkeypatch):
    for name in NAMES:
        monkeypatch.setenv(name, "")
    use_profiles()
    root = ET.parse(Path(os.environ[NAMES[0]])).getroot()
    assert {child.tag.rpartition("}")[2] for child in root} == {"participant", "data_writer"}
    assert all(child.get("is_default_profile") == "true" for child in root)


@pytest.mark.parametrize("name", NAMES)
def test_the_profiles_of_the_user_stay(monkeypatch, name):
    for other in NAMES:
        monkeypatch.setenv(other, "")
    monkeypatch.setenv(name, "mine.xml")
    use_profiles()
    assert [os.environ[n] for n in NAMES if os.environ[n]] == ["mine.xml"]


def run_alone(script):
    """Runs a script in a domain of its own; returns its exit code, and what it said on stderr and stdout."""
    with own_domain() as domain:
        done = subprocess.run(
            [sys.executable, "-c", script], capture_output=True, text=True, timeout=60, check=False,
            env={**os.environ, "ROS_DOMAIN_ID": str(domain), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"},
        )  # fmt: skip
    return done.returncode, done.stderr, done.stdout


@pytest.mark.skipif(sys.platform != "linux", reason="asks the system for the priority of each thread")
def test_every_thread_of_a_node_that_steps_back_does():
    script = """
import os, sys
from rclpy.node import Node
from walk_ros.runner import run_node

def all_threads():
    return {int(name) for name in os.listdir("/proc/self/task")}

# Those that importing a library has started wait for work that a node does not give them.
idle = all_threads()

class Patient(Node):
    niceness = 10

    def __init__(self):
        super().__init__("patient")
        threads = {0, *all_threads()} - idle  # 0 is the one that asks
        print(len(threads), sorted({os.getpriority(os.PRIO_PROCESS, thread) for thread in threads}))
        raise KeyboardInterrupt

sys.exit(run_node(Patient))
"""
    code, _, told = run_alone(script)
    assert code == 0
    told = told.split(" ", 1)
    mine = os.getpriority(os.PRIO_PROCESS, 0)
    assert int(told[0]) > 1, "the middleware has threads"
    assert told[1].strip() == f"[{max(mine, 10)}]"


def test_an_error_of_a_node_that_runs_is_not_swallowed():
    code, said, _ = run_alone("""
import sys
from rclpy.node import Node
from walk_ros.runner import run_node

class Broken(Node):
    def __init__(self):
        super().__init__("broken")
        raise RuntimeError("a defect")

sys.exit(run_node(Broken))
""")
    assert code == 1
    assert "a defect" in said


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_while_a_node_is_made_ends_it_cleanly_once_it_is(number):
    code, said, told = run_alone(f"""
import os, sys, time
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from walk_ros.runner import run_node

class Slow(Node):
    def __init__(self):
        super().__init__("slow")
        os.kill(os.getpid(), {int(number)})
        time.sleep(0.3)
        SingleThreadedExecutor()
        print("made", rclpy.ok())

sys.exit(run_node(Slow))
""")
    assert (code, said, told.strip()) == (0, "", "made True")
