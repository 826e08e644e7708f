# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A service that waits does not keep its node from hearing."""

import threading

import pytest
import rclpy
from graph.domains import own_domain
from rclpy.executors import SingleThreadedExecutor
from std_srvs.srv import Trigger

from walk_ros.side_node import SideNode

LIMIT_S = 10.0


@pytest.fixture
def context(monkeypatch):
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    context = rclpy.Context()
    with own_domain() as domain:
        rclpy.init(context=context, domain_id=domain)
        yield context
        context.try_shutdown()


def test_the_node_works_while_a_service_waits_for_it(context):
    node = rclpy.create_node("beside", context=context, namespace="walk")
    worked = threading.Event()

    def wait_for_node(_request, response):
        response.success = worked.wait(LIMIT_S)
        return response

    services = SideNode(node, "services")
    services.offer(Trigger, "slow", wait_for_node)
    services.start()
    caller = rclpy.create_node("caller", context=context)
    client = caller.create_client(Trigger, "/walk/slow")
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    executor.add_node(caller)
    try:
        assert client.wait_for_service(LIMIT_S)
        node.create_timer(0.2, worked.set)
        future = client.call_async(Trigger.Request())
        executor.spin_until_future_complete(future, LIMIT_S)
        assert future.result().success
    finally:
        services.stop()
        executor.shutdown()
        caller.destroy_node()
        node.destroy_node()
