# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The action `~/plan_lift`: a task and a person in, the optimal lift out."""

from __future__ import annotations

import math
from collections.abc import Callable

from lifting_interfaces.action import PlanLift
from lifting_interfaces.msg import PredictedLift
from rclpy.action import ActionServer, GoalResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.node import Node

from human_model.exceptions import LiftingError
from human_model.subject import Subject
from lift_predictor import conversions
from lift_predictor.background import Background
from lift_predictor.core.exceptions import CancelledError
from lift_predictor.core.planning.plan_task import DEFAULT_DURATION, PlanTask
from lift_predictor.core.planning.planned_lift import PlannedLift
from lift_predictor.core.planning.planner import LiftPlanner
from lift_predictor.core.planning.progress import PlanProgress
from lift_predictor.core.planning.technique import FREE
from lifting_node.ros_messages import to_ros


def task_from_goal(goal: PlanLift.Goal) -> PlanTask:
    """Return the task of a goal.

    Raises
    ------
    PlanError
        Naming field and value.
    """
    task, feet = goal.task, goal.feet
    start, end = ((p.x, p.y, p.z) for p in (task.box_start, task.box_end))
    depth, width, height = (float(length) for length in task.box_size)
    return PlanTask(
        name=task.task_id or 'plan',
        box_mass=None if math.isnan(task.box_mass) else task.box_mass,
        box_size=(depth, width, height),
        start=start,
        end=end,
        feet=None if math.isnan(feet.x) else (feet.x, feet.y),
        duration=DEFAULT_DURATION if math.isnan(goal.duration) else goal.duration,
        technique=goal.technique or FREE,
        end_posture=goal.end_posture or FREE,
    )


class PlanAction:
    """Server of the action; plans one goal after the other, on a thread.

    Parameters
    ----------
    node : Node
        Offers the action.
    background : Background
        Does the work, one goal at a time.
    ready : callable
        Tells whether goals are accepted now.
    """

    def __init__(self, node: Node, background: Background, ready: Callable[[], bool]) -> None:
        self._background = background
        self._ready = ready
        self._logger = node.get_logger()
        self._server = ActionServer(
            node,
            PlanLift,
            '~/plan_lift',
            self._on_goal,
            goal_callback=self._accept,
            cancel_callback=background.cancel,
        )

    def destroy(self) -> None:
        """Drop the action."""
        self._server.destroy()

    def _accept(self, goal: PlanLift.Goal) -> GoalResponse:
        return GoalResponse.ACCEPT if self._ready() else GoalResponse.REJECT

    async def _on_goal(self, handle: ServerGoalHandle) -> PlanLift.Result:
        result = PlanLift.Result(
            feet_forward=math.nan, feet_left=math.nan, feet_heading=math.nan,
            technique_index=math.nan,
        )  # fmt: skip
        try:
            subject = conversions.subject_from_msg(handle.request.subject)
            task = task_from_goal(handle.request)
        except LiftingError as error:
            handle.abort()
            result.error_code = PlanLift.Result.BAD_GOAL
            result.error_message = str(error)
            return result
        try:
            planned = await self._background.run(handle, lambda: self._plan(handle, subject, task))
        except CancelledError as error:
            result.error_code = PlanLift.Result.CANCELLED
            result.error_message = str(error)
            (handle.canceled if handle.is_cancel_requested else handle.abort)()
            return result
        lift = conversions.prediction_to_msg(planned.prediction, None, subject)
        lift.maximum_weight = task.box_mass is None
        result.lift = to_ros(lift, PredictedLift)
        if not planned.report.ok:
            result.error_code = PlanLift.Result.NOT_SOLVED
            result.error_message = planned.report.message
            handle.abort()
            return result
        result.feet_forward = planned.feet.forward
        result.feet_left = planned.feet.left
        result.feet_heading = planned.feet.heading
        result.technique_index = planned.index
        result.binding = list(planned.prediction.active_constraints)
        handle.succeed()
        self._logger.info(f'planned {task.name}: {planned.report.message}')
        return result

    def _plan(self, handle: ServerGoalHandle, subject: Subject, task: PlanTask) -> PlannedLift:
        def listen(progress: PlanProgress) -> None:
            handle.publish_feedback(
                PlanLift.Feedback(
                    stage=progress.stage,
                    done=progress.done,
                    total=progress.total,
                    best_objective=progress.best,
                )
            )
            self._background.check()

        return LiftPlanner(self._background.predictor).plan(subject, task, listen)
