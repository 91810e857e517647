# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""No lifecycle request ends a node."""

import time

import pytest

pytest.importorskip('rclpy', reason='rclpy is not installed')

import rclpy
from lifecycle_msgs.msg import State, Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rclpy.executors import SingleThreadedExecutor
from rclpy.experimental import EventsExecutor
from rclpy.lifecycle import LifecycleNode

from lifting_node.lifecycle_guard import refuse_unfit_requests

PATIENCE = 20.0


@pytest.mark.parametrize('executor_type', [SingleThreadedExecutor, EventsExecutor])
def test_requests_in_any_order(monkeypatch, executor_type):
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    rclpy.init(args=['--ros-args', '-r', '__ns:=/test_lifecycle_guard'])
    node, client = LifecycleNode('guarded'), rclpy.create_node('client')
    refuse_unfit_requests(node)
    executor = executor_type()
    executor.add_node(node)
    executor.add_node(client)
    services = {
        kind: client.create_client(kind, f'/test_lifecycle_guard/guarded/{name}')
        for kind, name in ((ChangeState, 'change_state'), (GetState, 'get_state'))
    }

    def call(kind, request):
        deadline = time.monotonic() + PATIENCE
        while not services[kind].service_is_ready() and time.monotonic() < deadline:
            executor.spin_once(timeout_sec=0.05)
        future = services[kind].call_async(request)
        while not future.done() and time.monotonic() < deadline:
            executor.spin_once(timeout_sec=0.05)
        assert future.done(), f'no answer within {PATIENCE:g} s'
        return future.result()

    def change(**transition):
        request = ChangeState.Request(transition=Transition(**transition))
        return call(ChangeState, request).success

    try:
        assert not change(id=Transition.TRANSITION_ACTIVATE)
        assert change(id=Transition.TRANSITION_CONFIGURE)
        assert not change(id=Transition.TRANSITION_CONFIGURE)
        assert not change(id=250)
        assert not change(label='no such transition')
        assert not change(label='deactivate')
        assert change(id=Transition.TRANSITION_ACTIVATE)
        assert not change(id=Transition.TRANSITION_CLEANUP)
        assert not change(id=Transition.TRANSITION_ACTIVATE)
        state = call(GetState, GetState.Request()).current_state
        assert state.id == State.PRIMARY_STATE_ACTIVE
    finally:
        executor.shutdown()
        client.destroy_node()
        node.destroy_node()
        rclpy.shutdown()
