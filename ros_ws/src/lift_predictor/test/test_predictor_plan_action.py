# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The action that plans: the node as a process of its own, killed at the end come what may."""

from __future__ import annotations

import math
import os
import subprocess
import sys
import time

import pytest

rclpy = pytest.importorskip('rclpy', reason='rclpy is not installed')
pytest.importorskip('lifting_interfaces.msg', reason='the interface package is not built')

from action_msgs.msg import GoalStatus  # noqa: E402
from geometry_msgs.msg import Point  # noqa: E402
from lifecycle_msgs.msg import Transition  # noqa: E402
from lifecycle_msgs.srv import ChangeState  # noqa: E402
from lifting_interfaces.action import PlanLift  # noqa: E402
from lifting_interfaces.msg import SolveReport, Task  # noqa: E402
from lifting_interfaces.msg import Subject as SubjectMsg  # noqa: E402
from rclpy.action import ActionClient  # noqa: E402
from rclpy.executors import SingleThreadedExecutor  # noqa: E402

from human_model.subject import Subject  # noqa: E402
from lift_predictor.core.planning.planner import LiftPlanner  # noqa: E402
from lift_predictor.plan_action import task_from_goal  # noqa: E402
from lifting_messages.conversions import motion_from_msg, subject_to_msg  # noqa: E402
from lifting_node.ros_messages import to_ros  # noqa: E402

PATIENCE = 120.0


class Client:
    """A client of the action, and the process that serves it."""

    def __init__(self) -> None:
        self.process = subprocess.Popen(
            [sys.executable, '-m', 'lift_predictor.lift_predictor_node',
             '--ros-args', '-r', '__ns:=/plan_test'],
        )  # fmt: skip
        rclpy.init()
        self.node = rclpy.create_node('client', namespace='plan_test')
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)
        self.action = ActionClient(self.node, PlanLift, 'lift_predictor/plan_lift')
        self.told: list[PlanLift.Feedback] = []

    def wait(self, future, what: str):
        """Return the result of a future; fail by name when patience is over."""
        self.until(future.done, what)
        return future.result()

    def until(self, condition, what: str) -> None:
        """Spin until a condition holds."""
        deadline = time.monotonic() + PATIENCE
        while not condition():
            assert self.process.poll() is None, f'the node ended before: {what}'
            assert time.monotonic() < deadline, f'{what} did not happen in {PATIENCE} s'
            self.executor.spin_once(timeout_sec=0.05)

    def change(self, transition: int) -> None:
        """Bring the node one lifecycle state further."""
        service = self.node.create_client(ChangeState, 'lift_predictor/change_state')
        self.until(service.service_is_ready, 'lifecycle service')
        request = ChangeState.Request(transition=Transition(id=transition))
        assert self.wait(service.call_async(request), 'transition').success
        self.node.destroy_client(service)

    def send(self, goal: PlanLift.Goal):
        """Send a goal; return its handle."""
        self.until(self.action.server_is_ready, 'action server')
        self.told.clear()
        sent = self.action.send_goal_async(
            goal, feedback_callback=lambda message: self.told.append(message.feedback)
        )
        return self.wait(sent, 'answer to the goal')

    def result(self, handle):
        """Return status and result of a goal."""
        answer = self.wait(handle.get_result_async(), 'result')
        return answer.status, answer.result

    def close(self) -> None:
        """End the node, and kill it if it does not obey."""
        self.process.terminate()
        try:
            self.process.wait(15.0)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.action.destroy()
        self.executor.shutdown()
        self.node.destroy_node()
        rclpy.try_shutdown()


@pytest.fixture(scope='module')
def client():
    patch = pytest.MonkeyPatch()
    patch.setenv('ROS_DOMAIN_ID', str(100 + os.getpid() % 100))
    patch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    client = Client()
    try:
        client.change(Transition.TRANSITION_CONFIGURE)
        client.change(Transition.TRANSITION_ACTIVATE)
        yield client
    finally:
        client.close()
        patch.undo()


@pytest.fixture(scope='module')
def subject() -> Subject:
    return Subject(pseudonym='thesis', sex='male', mass=63.5, stature=1.69, age=31.0)


def goal_for(person: Subject, **changes) -> PlanLift.Goal:
    goal = PlanLift.Goal(
        subject=to_ros(subject_to_msg(person, 0.0, '', 'test'), SubjectMsg),
        task=Task(
            task_id='shelf', box_mass=7.0, box_size=[0.238, 0.305, 0.127],
            box_start=Point(x=0.35, y=0.0, z=0.0635), box_end=Point(x=0.55, y=0.0, z=0.9635),
        ),
        feet=Point(x=0.0, y=0.0, z=0.0),
        duration=1.2,
    )  # fmt: skip
    for name, value in changes.items():
        setattr(goal, name, value)
    return goal


def test_goal_is_planned_with_feedback_as_by_the_core(client: Client, subject) -> None:
    goal = goal_for(subject)
    handle = client.send(goal)
    assert handle.accepted
    status, result = client.result(handle)
    assert status == GoalStatus.STATUS_SUCCEEDED, result.error_message
    assert result.error_code == PlanLift.Result.NONE
    assert result.lift.report.status == SolveReport.OK
    assert [(told.stage, told.done) for told in client.told[:2]] == [('lift', 1), ('lift', 2)]
    assert client.told[-1].total >= client.told[-1].done
    motion = motion_from_msg(result.lift.motion)
    assert motion.box_position[-1] == pytest.approx([0.55, 0.0, 0.9635], abs=1e-4)
    planned = LiftPlanner().plan(subject, task_from_goal(goal))
    assert result.lift.report.objective == pytest.approx(planned.report.objective, rel=1e-6)
    assert result.technique_index == pytest.approx(planned.index, rel=1e-3)
    feet = (result.feet_forward, result.feet_left, result.feet_heading)
    planned_feet = (planned.feet.forward, planned.feet.left, planned.feet.heading)
    assert feet == planned_feet == (0.0, 0.0, 0.0)


def test_cancel_ends_the_work_before_it_is_done(client: Client, subject) -> None:
    handle = client.send(goal_for(subject, feet=Point(x=math.nan, y=math.nan, z=math.nan)))
    client.until(lambda: client.told, 'first feedback')
    answer = client.wait(handle.cancel_goal_async(), 'answer to the cancel request')
    assert len(answer.goals_canceling) == 1
    status, result = client.result(handle)
    assert status == GoalStatus.STATUS_CANCELED
    assert result.error_code == PlanLift.Result.CANCELLED
    assert not result.lift.motion.position
    assert client.told[-1].stage == 'feet'
    assert client.told[-1].done < client.told[-1].total


def test_bad_goal_is_refused_in_words_and_the_node_goes_on(client: Client, subject) -> None:
    heavy = to_ros(subject_to_msg(subject, 0.0, '', 'test'), SubjectMsg)
    heavy.mass = 63500.0
    for changes, words in (
        ({'subject': heavy}, 'subject.mass: 63500'),
        ({'technique': 'jump'}, "task.technique: 'jump'"),
        ({'duration': -1.0}, 'task.duration: -1'),
    ):
        status, result = client.result(client.send(goal_for(subject, **changes)))
        assert status == GoalStatus.STATUS_ABORTED
        assert result.error_code == PlanLift.Result.BAD_GOAL
        assert words in result.error_message
    far = goal_for(subject)
    far.task.box_end.z = 2.6
    status, result = client.result(client.send(far))
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, PlanLift.Result.NOT_SOLVED)
    assert 'task.end' in result.error_message
    assert result.lift.report.status == SolveReport.PREDICTOR_UNREACHABLE
