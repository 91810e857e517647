# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The muscle analyzer in the graph: motion in, muscle forces and L5-S1 loads out."""

from __future__ import annotations

import math
from collections import OrderedDict, deque
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

from human_model.exceptions import LiftingError
from human_model.named_subjects import named_subject, subject_names
from human_model.subject import Subject
from lifting_messages import Message
from lifting_messages.station import Output, Station
from lifting_messages.topics import Quality
from muscle_analyzer import conversions, topics
from muscle_analyzer.core.loads.analysis import MuscleAnalysis
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer
from muscle_analyzer.core.loads.muscle_model import read_generic_model
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions
from muscle_analyzer.core.recruitment.static_optimization import StaticOptimizationOptions
from muscle_analyzer.core.subject.muscle_strength import StrengthScaling
from muscle_analyzer.core.subject.segment_masses import MassDistribution
from muscle_analyzer.lift_queue import LiftQueue, WaitingLift

#: Lifts kept until their person is known.
WAITING_LIFTS: Final = 100


def options_from(values: Mapping[str, Any]) -> MuscleAnalyzerOptions:
    """Return options from the values of `data/parameters.yaml` by name."""
    others = dict(values)
    model = others.pop('model')
    return MuscleAnalyzerOptions(
        model_path=Path(model) if model else None,
        strength=StrengthScaling(others.pop('strength')),
        static_optimization=StaticOptimizationOptions(
            criterion=others.pop('criterion'),
            minimum_activation=others.pop('minimum_activation'),
        ),
        mass_distribution=MassDistribution(others.pop('mass_distribution')),
        **others,
    )


class AnalyzerStation(Station):
    """Analyses live motion at once and whole lifts in the background.

    Motion that comes before the person and the task it belongs to waits for them.

    Parameters
    ----------
    values, name, log, clock
        See `Station`.
    """

    PACKAGE = 'muscle_analyzer'
    INPUTS = topics.INPUTS
    OUTPUTS = topics.OUTPUTS

    def prepare(self) -> None:
        """Create the pipeline and the functions of the inputs."""
        self.handlers = {
            'subject': self._on_subject,
            'task': self._on_task,
            'body_motion': self._on_body_motion,
            'measured_lift': self._on_measured_lift,
            'predicted_lift': self._on_predicted_lift,
        }
        self._options = options_from(self.values)
        self._model = read_generic_model(self._options)
        self._analyzer: MuscleAnalyzer | None = None
        self._subject: Subject | None = None
        self._box_mass = math.nan
        self._disc = conversions.disc_frame_id(self.name)
        self._early: deque[Message] = deque(maxlen=Quality.FRAMES.depth)
        self._waiting: OrderedDict[tuple[str, str], Message] = OrderedDict()
        self._queue = LiftQueue(self._lift_messages, self._lift_failed)

    def warm_up(self) -> None:
        """Load the compiled functions, with a model of any person."""
        MuscleAnalyzer(named_subject(subject_names()[0]), self._options, self._model)

    @property
    def pending(self) -> bool:
        """Whether whole lifts wait for their analysis."""
        return bool(self._queue)

    def work(self, duration: float) -> Iterator[Output]:
        """Analyse whole lifts for about this time [s], at least by one step."""
        return self._queue.work(duration)

    def _on_subject(self, message: Message) -> Iterator[Output]:
        subject = conversions.subject_from_msg(message)
        self._subject = None
        self._analyzer = MuscleAnalyzer(subject, self._options, self._model)
        self._subject = subject
        self._queue_waiting()
        yield from self._analyze_early()

    def _on_task(self, message: Message) -> Iterator[Output]:
        self._box_mass = message.box_mass
        yield from self._analyze_early()

    def _analyze_early(self) -> Iterator[Output]:
        while self._early and self._subject is not None and not math.isnan(self._box_mass):
            yield from self._on_body_motion(self._early.popleft())

    def _on_body_motion(self, message: Message) -> Iterator[Output]:
        analyzer = self._analyzer
        if analyzer is None or self._subject is None or math.isnan(self._box_mass):
            self.counts['samples before person and task'] += 1
            self._early.append(message)
            return
        motion = conversions.motion_from_msg(message)
        mass = conversions.mass_in_hands(motion, self._box_mass)
        analysis = analyzer.analyze(motion, '', 'live', message.status)
        spine = conversions.spine_load_to_msg(analysis, mass, self._disc, message.filter_delay)
        # The load of the alarms first.
        yield 'spine_load', spine
        torques = analyzer.joint_torques(analysis, motion)
        yield 'joint_torques', conversions.torques_to_msg(torques)
        yield 'muscle_analysis', conversions.analysis_to_msg(analysis)
        if self.has_subscribers('joint_reactions'):
            yield 'joint_reactions', conversions.joint_reactions_to_msg(analysis)
        if self.has_subscribers('l5_s1/reaction'):
            for reaction in conversions.reactions_to_msg(analysis, self._disc):
                yield 'l5_s1/reaction', reaction
        self.counts['live samples'] += len(analysis)
        self.counts['live samples with good L5-S1 load'] += analysis.good_spine_samples

    def _on_measured_lift(self, message: Message) -> Iterator[Output]:
        self._wait('measured', message)
        return iter(())

    def _on_predicted_lift(self, message: Message) -> Iterator[Output]:
        if message.report.status != 0:
            self.counts['failed predictions'] += 1
        else:
            self._wait('predicted', message)
        return iter(())

    def _wait(self, source: str, message: Message) -> None:
        self._waiting[source, message.lift_id] = message
        while len(self._waiting) > WAITING_LIFTS:
            (kind, lift_id), _ = self._waiting.popitem(last=False)
            self.report_error(f'{kind}_lift {lift_id}: its person did not come, dropped')
        self._queue_waiting()

    def _queue_waiting(self) -> None:
        """Queue the lifts of the current person; those of other persons wait on."""
        if self._subject is None or self._analyzer is None:
            return
        person = self._subject.pseudonym
        for key in [key for key, lift in self._waiting.items() if lift.subject == person]:
            lift = self._waiting.pop(key)
            source, name = key
            try:
                motion = conversions.motion_from_msg(lift.motion)
            except LiftingError as error:
                self.report_error(f'{source}_lift {name}: {error}')
                continue
            status = conversions.quality_from_msg(lift.motion).status
            waiting = WaitingLift(name, source, lift.box_mass, motion, status)
            self._queue.add(waiting, self._analyzer)

    def _lift_failed(self, lift: WaitingLift, error: LiftingError) -> None:
        self.report_error(f'{lift.source}_lift {lift.lift_id}: {error}')

    def _lift_messages(
        self, lift: WaitingLift, analyzer: MuscleAnalyzer, analysis: MuscleAnalysis
    ) -> Iterator[Output]:
        """Yield the messages of a whole lift, each in a step of its own."""
        yield 'spine_load', conversions.spine_load_to_msg(analysis, lift.box_mass, self._disc)
        torques = analyzer.joint_torques(analysis, lift.motion)
        yield 'joint_torques', conversions.torques_to_msg(torques)
        yield 'muscle_analysis', conversions.analysis_to_msg(analysis)
        yield 'joint_reactions', conversions.joint_reactions_to_msg(analysis)
        self.log.info(
            f'{lift.lift_id} {lift.source}: peak L5-S1 compression '
            f'{analysis.peak_compression:.0f} N; {analysis.good_spine_samples} of '
            f'{len(analysis)} samples good; {analysis.spine_report.message}'
        )
