# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""A node goes on after every message, reports what it lacks, and clears what is over."""

import time

import pytest

pytest.importorskip('rclpy', reason='rclpy is not installed')
pytest.importorskip('lifting_interfaces.msg', reason='the interface package is not built')

import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from lifting_interfaces.msg import Subject, Task
from rclpy.executors import SingleThreadedExecutor
from std_srvs.srv import Trigger

from human_model.exceptions import LiftingError
from lifting_messages.station import Station
from lifting_messages.topics import SUBJECT, TASK, Quality, Topic
from lifting_node import pipeline_node, qos
from lifting_node.pipeline_node import PipelineNode

PATIENCE = 20.0


class FragileStation(Station):
    """A station that refuses a task without a name and has a defect at a negative mass."""

    PACKAGE = 'motion_tracker'
    INPUTS = (SUBJECT, TASK)
    OUTPUTS = (Topic('echo', 'lifting_interfaces/Task', Quality.LATCHED),)

    def __init__(self, *arguments, **options):
        super().__init__(*arguments, **options)
        self.handlers = {'subject': lambda _: iter(()), 'task': self.on_task}

    def on_task(self, message):
        """Repeat a good task."""
        if not message.task_id:
            raise LiftingError('task.task_id: empty')
        if message.box_mass < 0.0:
            raise ZeroDivisionError('a defect')
        yield 'echo', message


class FragileNode(PipelineNode[FragileStation]):
    """The node of that station, with a service that has a defect."""

    STATION = FragileStation

    def build(self):
        """Add the service."""
        super().build()
        self.serve(Trigger, '~/broken', lambda request, response: 1 / 0)


@pytest.fixture
def graph(monkeypatch):
    """Return node, client and a function that spins until a condition holds."""
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    monkeypatch.setattr(pipeline_node, 'ERROR_SHOWN', 2.0)
    rclpy.init(args=['--ros-args', '-r', '__ns:=/test_pipeline_node'])
    node = FragileNode()
    client = rclpy.create_node('client', namespace='test_pipeline_node')
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    executor.add_node(client)

    def until(condition, what):
        deadline = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < deadline, f'{what} did not happen in {PATIENCE} s'
            executor.spin_once(timeout_sec=0.05)

    yield node, client, until
    executor.shutdown()
    client.destroy_node()
    node.destroy_node()
    rclpy.shutdown()


def test_node_goes_on_and_says_what_is_wrong(graph):
    node, client, until = graph
    echo, health = [], []
    client.create_subscription(Task, 'echo', echo.append, qos.profile(Quality.LATCHED))
    client.create_subscription(
        DiagnosticArray, '/diagnostics', lambda array: health.append(array.status[0]), 10
    )
    subjects = client.create_publisher(Subject, 'subject', qos.profile(Quality.LATCHED))
    tasks = client.create_publisher(Task, 'task', qos.profile(Quality.LATCHED))
    node.trigger_configure()
    node.trigger_activate()
    until(lambda: health and 'no subject yet' in health[-1].message, 'missing subject')
    assert health[-1].level == DiagnosticStatus.WARN
    subjects.publish(Subject())
    tasks.publish(Task())
    until(lambda: health[-1].message == 'task: task.task_id: empty', 'refused task')
    until(lambda: health[-1].level == DiagnosticStatus.OK, 'end of the report')
    assert {v.key: v.value for v in health[-1].values}['errors'] == '1'
    tasks.publish(Task(task_id='a', box_mass=-1.0))
    until(lambda: health[-1].level == DiagnosticStatus.ERROR, 'defect')
    assert health[-1].message == '1 defects, see the log'
    tasks.publish(Task(task_id='b', box_mass=1.0))
    until(lambda: echo, 'task after the defect')


def test_defect_of_a_service_is_answered(graph):
    node, client, until = graph
    node.trigger_configure()
    service = client.create_client(Trigger, 'motion_tracker/broken')
    until(service.service_is_ready, 'service')
    future = service.call_async(Trigger.Request())
    until(future.done, 'answer')
    assert (future.result().success, future.result().message) == (
        False, 'defect of the node; see its log',
    )  # fmt: skip
