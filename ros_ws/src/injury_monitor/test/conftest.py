# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The node with a client beside it."""

import time
from contextlib import suppress

import pytest

# The tests of the core need no ROS.
with suppress(ModuleNotFoundError):
    import rclpy
    from lifecycle_msgs.msg import Transition
    from lifecycle_msgs.srv import ChangeState
    from lifting_interfaces.msg import (
        AlarmEvent,
        AlarmStates,
        JointTorques,
        MeasuredLift,
        MuscleAnalysis,
        PredictedLift,
        RiskAssessment,
        SpineLoad,
        Subject,
        Task,
    )
    from rclpy.executors import SingleThreadedExecutor

    from injury_monitor.injury_monitor_node import InjuryMonitorNode
    from lifting_messages.stamps import to_stamp
    from lifting_node import qos

PATIENCE = 20.0


class Station:
    """The node and a client beside it, spun together."""

    def __init__(self, namespace, parameters):
        arguments = ['--ros-args', '-r', f'__ns:=/{namespace}']
        for name, value in parameters.items():
            arguments += ['-p', f'{name}:={value}']
        rclpy.init(args=arguments)
        self.node = InjuryMonitorNode()
        self.client = rclpy.create_node('client', namespace=namespace)
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)
        self.executor.add_node(self.client)
        self.alarms, self.assessments, self.states = [], [], []
        self.client.create_subscription(
            AlarmStates, 'alarm_states', self.states.append, qos.LATCHED
        )
        self.client.create_subscription(AlarmEvent, 'alarms', self.alarms.append, qos.RESULTS)
        self.client.create_subscription(
            RiskAssessment, 'risk_assessment', self.assessments.append, qos.RESULTS
        )
        topics = {
            'subject': (Subject, qos.LATCHED),
            'task': (Task, qos.LATCHED),
            'spine_load': (SpineLoad, qos.FRAMES),
            'joint_torques': (JointTorques, qos.FRAMES),
            'muscle_analysis': (MuscleAnalysis, qos.FRAMES),
            'measured_lift': (MeasuredLift, qos.RESULTS),
            'predicted_lift': (PredictedLift, qos.RESULTS),
        }
        self.publishers = {
            topic: self.client.create_publisher(kind, topic, profile)
            for topic, (kind, profile) in topics.items()
        }

    def until(self, condition, what):
        """Spin until a condition holds; fail by name when patience is over."""
        deadline = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < deadline, f'{what} did not happen in {PATIENCE} s'
            self.executor.spin_once(timeout_sec=0.05)

    def call(self, kind, name, request):
        """Call a service and return its answer."""
        service = self.client.create_client(kind, f'injury_monitor/{name}')
        self.until(service.service_is_ready, f'service {name}')
        future = service.call_async(request)
        self.until(future.done, f'answer of {name}')
        return future.result()

    def transition(self, number):
        """Ask for a lifecycle transition."""
        request = ChangeState.Request(transition=Transition(id=number))
        return self.call(ChangeState, 'change_state', request).success

    def bring_up(self):
        """Configure and activate the node, enter person and task."""
        assert self.transition(Transition.TRANSITION_CONFIGURE)
        assert self.transition(Transition.TRANSITION_ACTIVATE)
        self.send('subject', Subject(pseudonym='P01', mass=70.0))
        self.send(
            'task',
            Task(
                task_id='bag',
                box_mass=12.0,
                coupling=Task.COUPLING_GOOD,
                lifts_per_day=50.0,
                lifts_per_minute=1.0,
                duration_hours=1.0,
            ),
        )
        self.until(lambda: self.node.station.monitor.assignment is not None, 'configuration')

    def send(self, topic, message):
        """Publish once there is a reader."""
        publisher = self.publishers[topic]
        self.until(lambda: publisher.get_subscription_count() > 0, f'reader of {topic}')
        publisher.publish(message)

    def live(self, start, compression, status=0):
        """Send live samples at 100 Hz, ten a message."""
        for first in range(0, len(compression), 10):
            part = list(compression[first : first + 10])
            message = SpineLoad(
                source=SpineLoad.LIVE,
                lift_id='lift_001',
                filter_delay=0.045,
                compression=part,
                anterior_shear=[0.0] * len(part),
                status=[status] * len(part),
                time_from_start=[k / 100.0 for k in range(len(part))],
            )
            message.header.stamp = to_stamp(start + first / 100.0)
            self.send('spine_load', message)

    def close(self):
        """End everything."""
        self.executor.shutdown()
        self.client.destroy_node()
        self.node.destroy_node()
        rclpy.shutdown()


@pytest.fixture
def new_station(monkeypatch):
    """Return the class of stations, whose discovery stays on this machine."""
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    return Station


@pytest.fixture
def station(request, new_station):
    name = f'test_{request.node.name.split("[")[0]}'
    result = new_station(name, getattr(request, 'param', {}))
    yield result
    result.close()
