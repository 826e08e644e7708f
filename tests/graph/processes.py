# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Nodes as processes on a DDS domain of their own, and an observer that hears everything they say."""

import contextlib
import os
import signal
import subprocess
import sys
import time

import numpy as np
import rclpy
from rcl_interfaces.srv import SetParameters
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter

from walk_ros.conversions import (
    EditKind,
    KeypointEdit,
    edit_from_msg,
    edit_result_from_msg,
    edit_to_msg,
    path_from_msg,
    tour_from_msg,
)
from walk_ros.diagnostics import diagnostic_values
from walk_ros.topics import TOPICS, absolute_name

LIMIT_S = 40.0  # two slow cores, compiled code cold
NODES = {"importance": "walk_importance.node", "sequencer": "walk_sequencer.node", "trajopt": "walk_trajopt.node"}


class Graph:
    """Processes that belong together: one domain, one state folder."""

    def __init__(self, domain, folder, building):
        self.domain, self.folder, self.building = domain, folder, building
        self.processes = {}

    def environment(self, domain=None):
        env = dict(os.environ, ROS_DOMAIN_ID=str(domain or self.domain), ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST")
        env.setdefault("AMENT_PREFIX_PATH", sys.prefix)
        env["XDG_STATE_HOME"] = str(self.folder / "state")
        env["XDG_CACHE_HOME"] = str(self.folder / "cache")
        env["PYTHONPATH"] = os.pathsep.join(p for p in sys.path if p)
        return env

    def run(self, name, *command, domain=None):
        log = (self.folder / f"{name}.log").open("ab")
        with log:
            process = subprocess.Popen(
                [sys.executable, "-m", *command], env=self.environment(domain), stdout=log, stderr=log
            )
        self.processes[name] = process
        return process

    def start(self, name, *parameters, building=None):
        arguments = [f"building:={building or self.building}", *parameters]
        ros = [part for a in arguments for part in ("-p", a)]
        return self.run(name, NODES[name], "--ros-args", *ros)

    def log(self, name):
        return (self.folder / f"{name}.log").read_text(errors="replace")

    def interrupt(self, name, number=signal.SIGINT, times=1):
        process = self.processes.pop(name)
        for _ in range(times):
            process.send_signal(number)
        return process.wait(LIMIT_S)

    def kill(self, name):
        process = self.processes.pop(name)
        process.kill()
        process.wait(LIMIT_S)

    def close(self):
        for process in self.processes.values():
            process.kill()
        for process in self.processes.values():
            process.wait(LIMIT_S)


LATCHED = (
    "importance_map",
    "importance_map/storeys",
    "suggested_keypoints",
    "keypoints",
    "keypoint_markers",
    "pairwise_paths",
    "tour",
    "path",
    "trajectory",
)


class Observer:
    """A node that hears every topic, or those named."""

    def __init__(self, domain, name="observer", topics=tuple(TOPICS)):
        self.context = rclpy.Context()
        with _environment(ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST"):
            rclpy.init(context=self.context, domain_id=domain)
        self.node = rclpy.create_node(name, context=self.context)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        self.heard = {topic: [] for topic in topics}
        for topic in topics:
            spec = TOPICS[topic]
            self.node.create_subscription(spec.type, absolute_name(topic), self.heard[topic].append, spec.qos)
        spec = TOPICS["keypoint_edits"]
        self.edits = self.node.create_publisher(spec.type, absolute_name("keypoint_edits"), spec.qos)
        self.sent = 0

    def close(self):
        self.executor.shutdown()
        self.node.destroy_node()
        self.context.try_shutdown()

    def wait(self, condition, what, limit_s=LIMIT_S):
        """Spins until the condition holds and returns what it returned."""
        end = time.monotonic() + limit_s
        while not (result := condition()):
            assert time.monotonic() < end, f"waited {limit_s:g} s for {what}"
            self.executor.spin_once(timeout_sec=0.02)
        return result

    def last(self, topic):
        return self.heard[topic][-1] if self.heard[topic] else None

    def wait_for_all(self, limit_s=LIMIT_S):
        """Waits for the first message of every topic that a finished plan is on; they come in any order."""
        for topic in LATCHED:
            self.wait(lambda topic=topic: self.last(topic), f"the first message of {topic}", limit_s)

    def after(self, topic, count, what):
        """Returns the newest message of a topic once more than `count` have been heard."""
        self.wait(lambda: len(self.heard[topic]) > count, what)
        return self.last(topic)

    def state(self, name):
        """Returns the values of the last diagnostics of a node."""
        for msg in reversed(self.heard["/diagnostics"]):
            for status in msg.status:
                if status.name == f"walk/{name}":
                    return dict(diagnostic_values(status), level=status.level, message=status.message)
        return {}

    def edit(self, kind, keypoint, position, client="anna", spoil=None, **fields):
        """Publishes an edit; returns a function that waits for its answer."""
        self.wait(lambda: self.edits.get_subscription_count() >= 2, "the graph to hear edits")
        self.sent += 1
        edit = KeypointEdit(
            kind=kind,
            keypoint=keypoint,
            client_id=client,
            stamp_ns=10**18 + self.sent,
            position=np.asarray(position, float),
            quat_xyzw=np.array([0.0, 0.0, 0.0, 1.0]),
            **fields,
        )
        msg = edit_to_msg(edit)
        if spoil is not None:
            spoil(msg)
        heard = len(self.heard["edit_results"])
        self.edits.publish(msg)

        def answer():
            def find():
                results = map(edit_result_from_msg, self.heard["edit_results"][heard:])
                mine = (edit.stamp_ns, 0) if spoil is not None else (edit.stamp_ns,)
                return next((r for r in results if r.edit_stamp_ns in mine), None)

            return self.wait(find, f"the answer to {edit}")

        return answer

    def set_parameter(self, node, name, value):
        """Sets a parameter of a running node; returns the result."""
        client = self.node.create_client(SetParameters, f"/walk/{node}/set_parameters")
        self.wait(client.service_is_ready, f"{node}'s parameters")
        request = SetParameters.Request(parameters=[Parameter(name, value=value).to_parameter_msg()])
        future = client.call_async(request)
        self.wait(future.done, f"{node} to set {name}")
        self.node.destroy_client(client)
        return future.result().results[0]


def settled(observer):
    """Waits until the path belongs to the newest tour; returns it."""

    def condition():
        tour, path = observer.last("tour"), observer.last("path")
        told = observer.state("trajopt").get("tour_revision_ns")
        return tour is not None and path is not None and told == str(tour_from_msg(tour).stamp_ns)

    observer.wait(condition, "a path through the newest tour")
    return path_from_msg(observer.last("path"))


@contextlib.contextmanager
def _environment(**values):
    before = {key: os.environ.get(key) for key in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for key, value in before.items():
            if value is None:
                del os.environ[key]
            else:
                os.environ[key] = value


__all__ = ["LIMIT_S", "NODES", "EditKind", "Graph", "Observer", "edit_from_msg", "settled"]
