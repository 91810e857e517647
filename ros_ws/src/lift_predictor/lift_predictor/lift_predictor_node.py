# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Lifecycle node round the lift predictor: recorded lifts in, optimal lifts out."""

from __future__ import annotations

import math
import os
from collections import OrderedDict
from typing import Final

from lifting_interfaces.action import PredictLift
from lifting_interfaces.msg import LiftComparison, MeasuredLift, PredictedLift, Task
from lifting_interfaces.msg import Subject as SubjectMsg
from rclpy.action import ActionServer, GoalResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from trajectory_msgs.msg import JointTrajectory

from human_model.exceptions import HumanModelError
from human_model.motion import Lift
from human_model.subject import Subject
from lift_predictor import conversions
from lift_predictor.background import Background
from lift_predictor.core.exceptions import CancelledError, LiftPredictorError
from lift_predictor.core.options import PredictorOptions
from lift_predictor.core.predictor import LiftPredictor
from lift_predictor.core.problem.prediction import Prediction
from lift_predictor.plan_action import PlanAction
from lifting_messages import encode
from lifting_node import qos
from lifting_node.pipeline_node import PipelineNode
from lifting_node.ros_messages import to_ros
from lifting_node.run import run_node

KEPT_LIFTS: Final = 100
"""Lifts kept until subject and task are known, and afterwards for the action."""

NICENESS: Final = 10
"""Of the process: where cores are short, a prediction waits for the live samples of others."""


class LiftPredictorNode(PipelineNode):
    """Predicts each recorded lift of one station; the namespace is the station."""

    PACKAGE = 'lift_predictor'
    INPUT_ERRORS = (LiftPredictorError, HumanModelError)
    LATER = ('scipy.interpolate', 'scipy.optimize')

    def build(self) -> None:
        """Load (once per machine: compile) the programme; create publishers and subscriptions."""
        options = PredictorOptions(**self.values)
        self.predictor = LiftPredictor(options)
        library = self.predictor.sagittal.model.library
        self.get_logger().info(f'{library.backend} ({library.build_time:.2f} s)')
        self._subject: Subject | None = None
        self._task: Task | None = None
        self._waiting: OrderedDict[str, Lift] = OrderedDict()
        self._seen: OrderedDict[str, Lift] = OrderedDict()
        self._predicted = self.advertise(PredictedLift, 'predicted_lift', qos.RESULTS)
        self._trajectory = self.advertise(
            JointTrajectory, 'predicted_lift/joint_trajectory', qos.RESULTS
        )
        self._comparison = self.advertise(LiftComparison, 'lift_comparison', qos.RESULTS)
        self.subscribe(SubjectMsg, 'subject', self._on_subject, qos.LATCHED)
        self.subscribe(Task, 'task', self._on_task, qos.LATCHED)
        self.subscribe(MeasuredLift, 'measured_lift', self._on_measured_lift, qos.RESULTS)
        self._background = Background(self, options)
        self._plan = PlanAction(self, self._background, lambda: self.active)
        self._action = ActionServer(
            self,
            PredictLift,
            '~/predict_lift',
            self._on_goal,
            goal_callback=self._accept,
            cancel_callback=self._background.cancel,
        )

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Drop the actions with the rest; what they are working on ends."""
        self._background.close()
        self._plan.destroy()
        self._action.destroy()
        return super().on_cleanup(state)

    def _accept(self, goal: PredictLift.Goal) -> GoalResponse:
        known = self._subject is not None and self._task is not None
        return GoalResponse.ACCEPT if self.active and known else GoalResponse.REJECT

    async def _on_goal(self, handle: ServerGoalHandle) -> PredictLift.Result:
        """Predict a lift that was seen before, with its own load or another."""
        subject = self._subject
        goal: PredictLift.Goal = handle.request
        result = PredictLift.Result()
        lift = self._seen.get(goal.lift_id)
        if lift is None or subject is None or self._task is None:
            handle.abort()
            result.error_code = PredictLift.Result.UNKNOWN_LIFT
            result.error_message = f'lift_id: no lift {goal.lift_id!r} was seen'
            return result

        def report(tried: int, total: int, best: float) -> None:
            feedback = PredictLift.Feedback(starts_tried=tried, starts_total=total)
            feedback.best_objective = best
            handle.publish_feedback(feedback)
            self._background.check()

        def work() -> Prediction:
            return self._background.predictor.predict(subject, lift, box, report)

        mass = lift.box_mass if math.isnan(goal.box_mass) else goal.box_mass
        try:
            box = conversions.box_from_msg(self._task, mass)
        except LiftPredictorError as error:
            handle.abort()
            result.error_code = PredictLift.Result.NOT_SOLVED
            result.error_message = str(error)
            return result
        try:
            prediction = await self._background.run(handle, work)
        except CancelledError as error:
            (handle.canceled if handle.is_cancel_requested else handle.abort)()
            result.error_code = PredictLift.Result.CANCELLED
            result.error_message = str(error)
            return result
        result.lift = to_ros(
            conversions.prediction_to_msg(prediction, lift, subject), PredictedLift
        )
        if prediction.report.ok:
            handle.succeed()
        else:
            handle.abort()
            result.error_code = PredictLift.Result.NOT_SOLVED
            result.error_message = prediction.report.message
        return result

    def _on_subject(self, message: SubjectMsg) -> None:
        self._subject = conversions.subject_from_msg(message)
        self._predict_waiting()

    def _on_task(self, message: Task) -> None:
        self._task = message
        self._predict_waiting()

    def _on_measured_lift(self, message: MeasuredLift) -> None:
        lift = conversions.lift_from_msg(message)
        self._waiting[lift.lift_id] = lift
        while len(self._waiting) > KEPT_LIFTS:
            dropped, _ = self._waiting.popitem(last=False)
            self.report_error(f'measured_lift {dropped}: no subject or task came, dropped')
        self._predict_waiting()

    def _predict_waiting(self) -> None:
        """Predict the lifts that were waiting, once person and task are known."""
        if self._subject is None or self._task is None:
            return
        while self._waiting:
            _, lift = self._waiting.popitem(last=False)
            self._predict(lift, self._subject, self._task)

    def _predict(self, lift: Lift, subject: Subject, task: Task) -> None:
        box = conversions.box_from_msg(task, lift.box_mass)
        self._seen[lift.lift_id] = lift
        if len(self._seen) > KEPT_LIFTS:
            self._seen.popitem(last=False)
        prediction = self.predictor.predict(subject, lift, box)
        comparison = prediction.comparison
        self.counts['predicted' if prediction.report.ok else 'not predicted'] += 1
        self._predicted.publish(encode(conversions.prediction_to_msg(prediction, lift, subject)))
        if not prediction.report.ok or comparison is None:
            self.report_error(f'{lift.lift_id}: {prediction.report.message}')
            return
        self._trajectory.publish(encode(conversions.trajectory_to_msg(prediction)))
        self._comparison.publish(
            encode(conversions.comparison_to_msg(comparison, prediction, lift))
        )
        self.get_logger().info(
            f'{lift.lift_id}: {prediction.report.message}; effort '
            f'{comparison.predicted_effort:.3g} s, recorded {comparison.measured_effort:.3g} s; '
            f'solved in {prediction.report.solve_time:.2f} s'
        )


def main(args: list[str] | None = None) -> None:
    """Run the node."""
    os.nice(NICENESS)
    run_node(LiftPredictorNode, args)


if __name__ == '__main__':
    main()
