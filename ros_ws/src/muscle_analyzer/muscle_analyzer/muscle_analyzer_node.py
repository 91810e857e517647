# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Lifecycle node round the muscle analyzer: motion in, muscle forces and L5-S1 loads out."""

from __future__ import annotations

import math
import time
from collections import OrderedDict, deque
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from geometry_msgs.msg import WrenchStamped
from lifting_interfaces.msg import (
    BodyMotion,
    JointReactions,
    JointTorques,
    MeasuredLift,
    MuscleAnalysis,
    PredictedLift,
    SpineLoad,
    Task,
)
from lifting_interfaces.msg import Subject as SubjectMsg
from rclpy.clock import Clock, ClockType
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn

from human_model.exceptions import HumanModelError
from human_model.named_subjects import named_subject, subject_names
from human_model.subject import Subject
from lifting_messages import Message, encode
from lifting_node import qos
from lifting_node.pipeline_node import PipelineNode
from lifting_node.run import run_node
from muscle_analyzer import conversions
from muscle_analyzer.core.exceptions import MuscleAnalyzerError
from muscle_analyzer.core.loads.analysis import MuscleAnalysis as Analysis
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
from muscle_analyzer.core.recruitment.static_optimization import StaticOptimizationOptions
from muscle_analyzer.core.subject.muscle_strength import StrengthScaling
from muscle_analyzer.core.subject.segment_masses import MassDistribution
from muscle_analyzer.lift_queue import LiftQueue, WaitingLift

WAITING_LIFTS: Final = 100
"""Lifts kept until their person is known and the node is active."""

LIFT_STEP: Final = 0.001
"""Time [s] that whole lifts are worked on between two live samples, or one step of them."""

BREATH: Final = 0.002
"""Time [s] from a live sample to that work: who waits for the sample has the cores until then."""

QUIET: Final = 0.02
"""Time [s] without a live sample after which whole lifts are worked on all the time."""

QUIET_STEP: Final = 0.004
"""Time [s] that they are worked on then before the node looks for messages again."""


class MuscleAnalyzerNode(PipelineNode):
    """Analyses live motion and whole lifts of one station; the namespace is the station."""

    PACKAGE = 'muscle_analyzer'
    INPUT_ERRORS = (MuscleAnalyzerError, HumanModelError)

    def build(self) -> None:
        """Read the model, load compiled functions; create publishers and subscriptions."""
        values = dict(self.values)
        model = values.pop('model')
        # Of any person: the model is read and the compiled functions are loaded before the first.
        self.analyzer = MuscleAnalyzer(
            named_subject(subject_names()[0]),
            MuscleAnalyzerOptions(
                model_path=Path(model) if model else None,
                strength=StrengthScaling(values.pop('strength')),
                static_optimization=StaticOptimizationOptions(
                    criterion=values.pop('criterion'),
                    minimum_activation=values.pop('minimum_activation'),
                ),
                mass_distribution=MassDistribution(values.pop('mass_distribution')),
                **values,
            ),
        )
        self._disc = conversions.disc_frame_id(self.get_namespace())
        self._subject: Subject | None = None
        self._box_mass = float('nan')
        # Topics overtake each other: motion may come before the person and the task it belongs to.
        self._early: deque[Message] = deque(maxlen=qos.FRAME_DEPTH)
        self._waiting: OrderedDict[tuple[str, str], Message] = OrderedDict()
        self._queue = LiftQueue(
            self.analyzer, self._lift_done, self._lift_failed, self.INPUT_ERRORS
        )
        self._last_live = -math.inf
        self._worked = False
        self._turn = self.create_timer(
            BREATH, self._work, clock=Clock(clock_type=ClockType.STEADY_TIME), autostart=False
        )
        self._muscles = self.advertise(MuscleAnalysis, 'muscle_analysis', qos.FRAMES)
        self._spine = self.advertise(SpineLoad, 'spine_load', qos.FRAMES)
        self._torques = self.advertise(JointTorques, 'joint_torques', qos.FRAMES)
        self._joints = self.advertise(JointReactions, 'joint_reactions', qos.FRAMES)
        self._reaction = self.advertise(WrenchStamped, 'l5_s1/reaction', qos.FRAMES)
        self.subscribe(SubjectMsg, 'subject', self._on_subject, qos.LATCHED)
        self.subscribe(Task, 'task', self._on_task, qos.LATCHED)
        self.subscribe(BodyMotion, 'body_motion', self._on_body_motion, qos.FRAMES)
        self.subscribe(MeasuredLift, 'measured_lift', self._on_measured_lift, qos.RESULTS)
        self.subscribe(PredictedLift, 'predicted_lift', self._on_predicted_lift, qos.RESULTS)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Start publishing, and analyse the lifts that came before."""
        result = super().on_activate(state)
        self._analyze_waiting()
        return result

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Finish the lifts that are being analysed, then stop publishing."""
        self._queue.finish()
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Drop the timer with the rest."""
        self.destroy_timer(self._turn)
        return super().on_cleanup(state)

    def _on_subject(self, message: Message) -> None:
        subject = conversions.subject_from_msg(message)
        # Lifts of the person before are analysed with that person's model.
        self._queue.finish()
        self._subject = None
        self.analyzer = self._queue.analyzer = self.analyzer.for_subject(subject)
        self._subject = subject
        self._analyze_waiting()
        self._work_off_early()

    def _on_task(self, message: Message) -> None:
        self._box_mass = message.box_mass
        self._work_off_early()

    def _work_off_early(self) -> None:
        while self._early and self._subject is not None and not math.isnan(self._box_mass):
            self._on_body_motion(self._early.popleft())

    def _on_body_motion(self, message: Message) -> None:
        if not self.active:
            self.counts['samples while not active'] += 1
            return
        if self._subject is None or math.isnan(self._box_mass):
            self.counts['samples before person and task'] += 1
            self._early.append(message)
            return
        motion = conversions.motion_from_msg(message)
        mass = conversions.mass_in_hands(motion, self._box_mass)
        analysis = self.analyzer.analyze(motion, '', 'live', message.status)
        # The load of the alarms first.
        spine = conversions.spine_load_to_msg(analysis, mass, self._disc, message.filter_delay)
        self._spine.publish(encode(spine))
        torques = self.analyzer.joint_torques(analysis, motion)
        self._torques.publish(encode(conversions.torques_to_msg(torques)))
        self._muscles.publish(encode(conversions.analysis_to_msg(analysis)))
        # Nobody needs these at once, and often nobody listens.
        if self._joints.get_subscription_count():
            joints = conversions.joint_reactions_to_msg(analysis)
            self._joints.publish(encode(joints))
        if self._reaction.get_subscription_count():
            for reaction in conversions.reactions_to_msg(analysis, self._disc):
                self._reaction.publish(encode(reaction))
        self.counts['live samples'] += len(analysis)
        self.counts['live samples with good L5-S1 load'] += analysis.good_spine_samples
        self._last_live = time.monotonic()
        self._worked = False
        if self._queue:
            self._turn.reset()

    def _on_measured_lift(self, message: Message) -> None:
        self._wait('measured', message)

    def _on_predicted_lift(self, message: Message) -> None:
        if message.report.status != 0:
            self.counts['failed predictions'] += 1
            return
        self._wait('predicted', message)

    def _wait(self, source: str, message: Message) -> None:
        self._waiting[source, message.lift_id] = message
        while len(self._waiting) > WAITING_LIFTS:
            (kind, lift_id), _ = self._waiting.popitem(last=False)
            self.report_error(f'{kind}_lift {lift_id}: its person did not come, dropped')
        self._analyze_waiting()

    def _analyze_waiting(self) -> None:
        """Queue the lifts of the person that is known; those of others go on waiting."""
        if self._subject is None or not self.active:
            return
        person = self._subject.pseudonym
        for key in [key for key, lift in self._waiting.items() if lift.subject == person]:
            lift = self._waiting.pop(key)
            source, name = key
            try:
                motion = conversions.motion_from_msg(lift.motion)
            except self.INPUT_ERRORS as error:
                self.report_error(f'{source}_lift {name}: {error}')
                continue
            status = conversions.quality_from_msg(lift.motion).status
            self._queue.add(WaitingLift(name, source, lift.box_mass, motion, status))
            self._turn.reset()

    def _work(self) -> None:
        if time.monotonic() - self._last_live > QUIET:
            self._queue.work(QUIET_STEP)
        elif not self._worked:
            self._queue.work(LIFT_STEP)
            self._worked = True
        if not self._queue:
            self._turn.cancel()

    def _lift_failed(self, lift: WaitingLift, error: Exception) -> None:
        self.report_error(f'{lift.source}_lift {lift.lift_id}: {error}')

    def _lift_done(self, lift: WaitingLift, analysis: Analysis) -> Iterator[None]:
        """Publish the analysis of a whole lift, message by message."""
        spine = conversions.spine_load_to_msg(analysis, lift.box_mass, self._disc)
        self._spine.publish(encode(spine))
        yield
        torques = self.analyzer.joint_torques(analysis, lift.motion)
        self._torques.publish(encode(conversions.torques_to_msg(torques)))
        yield
        # Half a megabyte: made in one step, sent in the next.
        muscles = encode(conversions.analysis_to_msg(analysis))
        yield
        self._muscles.publish(muscles)
        yield
        self._joints.publish(encode(conversions.joint_reactions_to_msg(analysis)))
        yield
        self.get_logger().info(
            f'{lift.lift_id} {lift.source}: peak L5-S1 compression '
            f'{analysis.peak_compression:.0f} N; {analysis.good_spine_samples} of '
            f'{len(analysis)} samples good; {analysis.spine_report.message}'
        )


def main(args: list[str] | None = None) -> None:
    """Run the node."""
    run_node(MuscleAnalyzerNode, args)


if __name__ == '__main__':
    main()
