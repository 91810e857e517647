# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The node in this process, talked to over its topics."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import pytest

rclpy = pytest.importorskip('rclpy', reason='rclpy is not installed')
pytest.importorskip('lifting_interfaces.msg', reason='the interface package is not built')

from geometry_msgs.msg import Point  # noqa: E402
from lifting_interfaces.action import PredictLift  # noqa: E402
from lifting_interfaces.msg import (  # noqa: E402
    LiftComparison,
    MeasuredLift,
    PredictedLift,
    SolveReport,
    Subject,
    Task,
)
from rclpy.action import ActionClient  # noqa: E402
from rclpy.executors import SingleThreadedExecutor  # noqa: E402
from trajectory_msgs.msg import JointTrajectory  # noqa: E402

from lift_predictor.lift_predictor_node import LiftPredictorNode  # noqa: E402
from lifting_messages import encode  # noqa: E402
from lifting_messages.conversions import (  # noqa: E402
    MotionQuality,
    lift_to_msg,
    motion_from_msg,
    subject_to_msg,
)
from lifting_messages.exceptions import ParameterError  # noqa: E402
from lifting_node import qos  # noqa: E402

PATIENCE = 60.0


class Station:
    """The node and a client beside it, spun together."""

    def __init__(self, parameters: dict) -> None:
        arguments = ['--ros-args', '-r', '__ns:=/predictor_test']
        for name, value in parameters.items():
            arguments += ['-p', f'{name}:={value}']
        rclpy.init(args=arguments)
        self.node = LiftPredictorNode()
        self.client = rclpy.create_node('client', namespace='predictor_test')
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)
        self.executor.add_node(self.client)
        self.predicted: list[PredictedLift] = []
        self.trajectories: list[JointTrajectory] = []
        self.comparisons: list[LiftComparison] = []
        for kind, topic, store in (
            (PredictedLift, 'predicted_lift', self.predicted),
            (JointTrajectory, 'predicted_lift/joint_trajectory', self.trajectories),
            (LiftComparison, 'lift_comparison', self.comparisons),
        ):
            self.client.create_subscription(kind, topic, store.append, qos.RESULTS)
        self.publishers = {
            'subject': self.client.create_publisher(Subject, 'subject', qos.LATCHED),
            'task': self.client.create_publisher(Task, 'task', qos.LATCHED),
            'lift': self.client.create_publisher(MeasuredLift, 'measured_lift', qos.RESULTS),
        }

    def activate(self) -> None:
        """Configure and activate the node."""
        for change in (self.node.trigger_configure, self.node.trigger_activate):
            assert change().name == 'SUCCESS'

    def until(self, condition, what: str) -> None:
        """Spin until a condition holds; fail by name when patience is over."""
        deadline = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < deadline, f'{what} did not happen in {PATIENCE} s'
            self.executor.spin_once(timeout_sec=0.05)

    def close(self) -> None:
        """Destroy both nodes."""
        self.executor.shutdown()
        self.client.destroy_node()
        self.node.destroy_node()
        rclpy.try_shutdown()


@pytest.fixture
def station():
    station = Station({})
    yield station
    station.close()


def lift_message(lift, subject) -> MeasuredLift:
    return lift_to_msg(lift, MotionQuality.exact(len(lift.motion)), subject)


def task_message(mass: float) -> Task:
    unknown = Point(x=np.nan, y=np.nan, z=np.nan)
    return Task(
        task_id='test', box_mass=mass, box_size=[0.238, 0.305, 0.127],
        box_start=unknown, box_end=unknown,
    )  # fmt: skip


def test_lift_that_came_before_its_subject_is_predicted_as_by_the_core(
    station: Station, outcome, subject
) -> None:
    station.activate()
    result = outcome(7.0)
    station.publishers['lift'].publish(encode(lift_message(result.lift, subject)))
    station.publishers['task'].publish(task_message(7.0))
    station.until(lambda: station.node.station.counts['task'], 'task')
    assert not station.predicted
    station.publishers['subject'].publish(encode(subject_to_msg(subject, 0.0, '', 'test')))
    station.until(lambda: station.comparisons and station.trajectories, 'comparison')
    message = station.predicted[0]
    assert message.report.status == SolveReport.OK
    assert message.report.objective == pytest.approx(result.predicted.report.objective, rel=1e-6)
    motion = motion_from_msg(message.motion)
    np.testing.assert_allclose(motion.position, result.predicted.lift.motion.position, atol=1e-4)
    assert station.comparisons[0].lift_id == message.lift_id == 'lift_001'
    assert len(station.trajectories[0].points) == len(motion)


def test_bad_input_is_reported_and_the_node_goes_on(station: Station, outcome, subject) -> None:
    station.activate()
    lift = outcome(0.0).lift
    good = subject_to_msg(subject, 0.0, '', 'test')
    grams = subject_to_msg(subject, 0.0, '', 'test')
    grams.mass = 63500.0
    station.publishers['subject'].publish(encode(grams))
    station.until(lambda: station.node.station.counts['errors'] == 1, 'refusal of the subject')
    assert 'subject.mass' in station.node.station.last_error
    station.publishers['subject'].publish(encode(good))
    station.publishers['task'].publish(task_message(0.0))
    points = lift.motion.points.copy()
    points[:, lift.motion.point_names.index('shoulder_r'), 0] += 0.2
    turned = replace(lift, lift_id='lift_002', motion=replace(lift.motion, points=points))
    station.publishers['lift'].publish(encode(lift_message(turned, subject)))
    station.until(lambda: len(station.predicted) == 1, 'report of the asymmetric lift')
    assert station.predicted[0].report.status == SolveReport.PREDICTOR_BAD_INPUT
    assert not station.predicted[0].motion.position
    station.publishers['lift'].publish(encode(lift_message(lift, subject)))
    station.until(lambda: len(station.predicted) == 2, 'prediction after the bad lift')
    assert station.predicted[1].report.status == SolveReport.OK
    station.until(lambda: station.comparisons, 'comparison')
    assert len(station.comparisons) == 1


def ask(station: Station, lift_id: str, mass: float) -> tuple[PredictLift.Result, list]:
    client = ActionClient(station.client, PredictLift, 'lift_predictor/predict_lift')
    station.until(client.server_is_ready, 'action server')
    told: list = []
    sent = client.send_goal_async(
        PredictLift.Goal(lift_id=lift_id, box_mass=mass), feedback_callback=told.append
    )
    station.until(sent.done, 'answer to the goal')
    assert sent.result().accepted
    finished = sent.result().get_result_async()
    station.until(finished.done, 'result')
    client.destroy()
    return finished.result().result, [message.feedback for message in told]


def test_seen_lift_is_predicted_again_with_another_load(
    station: Station, outcome, subject
) -> None:
    station.activate()
    result = outcome(7.0)
    station.publishers['subject'].publish(encode(subject_to_msg(subject, 0.0, '', 'test')))
    station.publishers['task'].publish(task_message(7.0))
    station.publishers['lift'].publish(encode(lift_message(result.lift, subject)))
    station.until(lambda: station.predicted, 'prediction')
    unknown, _ = ask(station, 'lift_009', 7.0)
    assert unknown.error_code == PredictLift.Result.UNKNOWN_LIFT
    assert 'lift_009' in unknown.error_message
    lighter, feedback = ask(station, 'lift_001', 3.0)
    assert lighter.error_code == PredictLift.Result.NONE
    assert lighter.lift.box_mass == 3.0
    assert lighter.lift.report.objective < station.predicted[0].report.objective
    assert [told.starts_tried for told in feedback] == [1, 2, 3]
    again, _ = ask(station, 'lift_001', np.nan)
    assert again.lift.box_mass == 7.0
    bad, _ = ask(station, 'lift_001', -1.0)
    assert bad.error_code == PredictLift.Result.NOT_SOLVED
    assert 'box.mass' in bad.error_message
    assert len(station.predicted) == 1


def test_bad_parameter_is_refused() -> None:
    with pytest.raises(ParameterError, match='n_control'):
        Station({'n_control': 3})
    rclpy.try_shutdown()


def test_nodes_that_do_not_fit_fail_to_configure() -> None:
    station = Station({'n_nodes': 24})
    try:
        assert station.node.trigger_configure().name == 'FAILURE'
    finally:
        station.close()
