# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Lifecycle node of the lift predictor: its station and the actions."""

from __future__ import annotations

import math
import os
from typing import Final

from lifting_interfaces.action import PredictLift
from lifting_interfaces.msg import PredictedLift
from rclpy.action import ActionServer, GoalResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn

from human_model.exceptions import LiftingError
from lift_predictor import conversions
from lift_predictor.background import Background
from lift_predictor.core.exceptions import CancelledError
from lift_predictor.core.problem.prediction import Prediction
from lift_predictor.plan_action import PlanAction
from lift_predictor.station import PredictorStation
from lifting_messages import Message
from lifting_node.pipeline_node import PipelineNode
from lifting_node.ros_messages import to_ros
from lifting_node.run import run_node

NICENESS: Final = 10
"""Of the process: where cores are short, a prediction waits for the live samples of others."""


class LiftPredictorNode(PipelineNode[PredictorStation]):
    """Predicts each measured lift of one station; the namespace is the station."""

    STATION = PredictorStation
    LATER = ('scipy.interpolate', 'scipy.optimize')

    def build(self) -> None:
        """Create the station, its topics and the actions."""
        super().build()
        self._background = Background(self, self.station.options)
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

    def publish(self, topic: str, message: Message) -> None:
        """Publish a message; report a failed prediction on /diagnostics."""
        super().publish(topic, message)
        if topic == 'predicted_lift' and message.report.status != 0:
            self.station.report_error(f'{message.lift_id}: {message.report.message}')

    def _accept(self, goal: PredictLift.Goal) -> GoalResponse:
        known = self.station.subject is not None and self.station.task is not None
        return GoalResponse.ACCEPT if self.active and known else GoalResponse.REJECT

    async def _on_goal(self, handle: ServerGoalHandle) -> PredictLift.Result:
        """Predict a lift that was seen before, with its own load or another."""
        subject, task = self.station.subject, self.station.task
        goal: PredictLift.Goal = handle.request
        result = PredictLift.Result()
        lift = self.station.predicted.get(goal.lift_id)
        if lift is None or subject is None or task is None:
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
            box = conversions.box_from_msg(task, mass)
        except LiftingError as error:
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


def main(args: list[str] | None = None) -> None:
    """Run the node."""
    os.nice(NICENESS)
    run_node(LiftPredictorNode, args)


if __name__ == '__main__':
    main()
