# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""`lift run --offline`: the same pipelines on a recording in one process, without middleware.

Every result goes through the same message as online, so that both ways see the same numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

from human_model.exceptions import LiftingError
from human_model.report import SolveStatus
from injury_monitor import conversions as monitor_messages
from injury_monitor.core.lift_parts import MEASURED, PREDICTED, LiftCollector
from injury_monitor.core.monitor import InjuryMonitor
from lift_predictor import conversions as predictor_messages
from lift_predictor.core.predictor import LiftPredictor
from lifting_cli.graph_errors import SessionError
from lifting_cli.live_state import FOLLOWED, LiveState
from lifting_cli.live_view import LiveView
from lifting_cli.recording_summary import NO_LIFT, gauge_limits, summarise
from lifting_messages.conversions import (
    lift_from_msg,
    motion_from_msg,
    quality_from_msg,
    subject_from_msg,
)
from lifting_messages.parameters import defaults
from lifting_recordings.reader import BagReader
from lifting_report.results_writer import ResultsWriter
from motion_tracker import conversions as tracker_messages
from motion_tracker import inputs
from motion_tracker.core import tracked
from motion_tracker.core.configuration import tracker_from
from motion_tracker.core.tracker import MotionTracker
from muscle_analyzer import conversions as muscle_messages
from muscle_analyzer.core.loads.analyzer import MuscleAnalyzer
from muscle_analyzer.core.loads.muscle_model import read_generic_model
from muscle_analyzer.core.loads.options import MuscleAnalyzerOptions

Emit = Callable[[str, Any], None]


class OfflineGraph:
    """The four pipelines of a station, joined by calls instead of topics.

    Parameters
    ----------
    station : str
        Name that the alarms carry.
    emit : callable
        Takes each result: topic and message.
    complain : callable
        Takes each input error in words.
    """

    def __init__(self, station: str, emit: Emit, complain: Callable[[str], None]) -> None:
        self._emit = emit
        self._complain = complain
        self._tracker_values = defaults('motion_tracker')
        self._subject: Any = None
        self._task: Any = None
        self._tracker: MotionTracker | None = None
        self._predictor = LiftPredictor()
        self._model = read_generic_model(MuscleAnalyzerOptions())
        self._analyzer: MuscleAnalyzer | None = None
        self._disc = muscle_messages.disc_frame_id(station)
        values = defaults('injury_monitor')
        self._monitor = InjuryMonitor(
            station,
            max_gap=values['max_gap'],
            activation_window=values['activation_window'],
            max_shelve=values['max_shelve'],
        )
        self._collector = LiftCollector(values['result_wait'])
        self._filter_delay = math.nan
        self.samples_left_out = 0

    def feed(self, topic: str, message: Any) -> None:
        """Take one message of the recording; an input error is reported and the run goes on."""
        try:
            self._feed(topic, message)
        except LiftingError as error:
            self._complain(f'{topic}: {error}')

    def flush(self) -> None:
        """End of the recording."""
        if self._tracker is None:
            raise SessionError(
                'nothing was tracked: subject and task are missing or were refused; '
                f'{self.samples_left_out} samples left out'
            )
        if self.samples_left_out:
            self._complain(f'{self.samples_left_out} samples came before subject and task')
        self._take(self._tracker.flush())

    def _feed(self, topic: str, message: Any) -> None:
        if topic in ('subject', 'task'):
            setattr(self, f'_{topic}', message)
            self._begin()
            return
        if self._tracker is None:
            self.samples_left_out += 1
        else:
            self._take(inputs.push(self._tracker, topic, message))

    def _begin(self) -> None:
        if self._subject is None or self._task is None:
            return
        self._monitor.configure(monitor_messages.assignment_from_msg(self._subject, self._task))
        subject = subject_from_msg(self._subject)
        tracker = tracker_from(
            self._tracker_values,
            subject,
            self._subject.marker_set,
            *inputs.task_from_msg(self._task),
        )
        self._analyzer = MuscleAnalyzer(tracker.subject, model=self._model)
        self._tracker = tracker

    def _take(self, outputs: list[tracked.Output]) -> None:
        for output in outputs:
            match output:
                case tracked.TrackedFrame():
                    self._live(output)
                case tracked.DetectedEvent():
                    self._emit('lift_event', tracker_messages.event_to_msg(output))
                case tracked.MeasuredLift():
                    self._lift(output)
                case tracked.Notice(information=False):
                    self._complain(output.text)

    def _live(self, frame: tracked.TrackedFrame) -> None:
        self._emit('joint_states', tracker_messages.joint_state_to_msg(frame))
        message = tracker_messages.body_motion_to_msg(frame)
        self._filter_delay = message.filter_delay
        motion = motion_from_msg(message)
        mass = muscle_messages.mass_in_hands(motion, self._task.box_mass)
        spine, torques, muscles = self._analyze(message, motion, '', 'live', mass)
        series = monitor_messages.spine_from_msg(spine)
        events = self._monitor.update_spine_load(
            float(series.time[0]),
            float(series.compression[0]),
            float(series.anterior_shear[0]),
            bool(series.solved[0]),
        )
        joints = monitor_messages.torques_from_msg(torques)
        events += self._monitor.update_joint_torques(
            float(joints.time[0]),
            joints.joints,
            joints.torque[0],
            joints.lower[0],
            joints.upper[0],
            bool(joints.solved[0]),
        )
        held = monitor_messages.activations_from_msg(muscles)
        events += self._monitor.update_activations(
            float(held.time[0]), held.muscles, held.activation[0], bool(held.solved[0])
        )
        for event in events:
            self._emit('alarms', monitor_messages.alarm_to_msg(event, self._filter_delay))

    def _analyze(
        self, message: Any, motion: Any, lift_id: str, source: str, mass: float
    ) -> tuple[Any, Any, Any]:
        """Analyse a block; emit and return spine load, joint torques and muscle analysis."""
        status = quality_from_msg(message).status
        assert self._analyzer is not None  # A motion exists only after person and task.
        analysis = self._analyzer.analyze(motion, lift_id, source, status)
        spine = muscle_messages.spine_load_to_msg(analysis, mass, self._disc, message.filter_delay)
        torques = muscle_messages.torques_to_msg(self._analyzer.joint_torques(analysis, motion))
        muscles = muscle_messages.analysis_to_msg(analysis)
        self._emit('spine_load', spine)
        self._emit('joint_torques', torques)
        self._emit('joint_reactions', muscle_messages.joint_reactions_to_msg(analysis))
        self._emit('muscle_analysis', muscles)
        if source == 'live':
            for reaction in muscle_messages.reactions_to_msg(analysis, self._disc):
                self._emit('l5_s1/reaction', reaction)
        return spine, torques, muscles

    def _lift(self, measured: tracked.MeasuredLift) -> None:
        assert self._tracker is not None
        message = tracker_messages.measured_lift_to_msg(measured, self._tracker.subject)
        self._emit('measured_lift', message)
        parts = self._collector.parts(message.lift_id, 0.0)
        assert parts is not None
        parts.start = float(measured.lift.start)
        parts.ends = monitor_messages.ends_from_msg(message)
        self._analyze_lift(message, MEASURED, parts)
        self._predict(message, parts)
        loads = parts.loads(MEASURED)
        if loads is None:
            self._complain(f'{message.lift_id} not assessed: no measured spine load')
            return
        result = self._monitor.assess(
            loads, parts.loads(PREDICTED), parts.ends, parts.no_prediction
        )
        self._emit('risk_assessment', monitor_messages.assessment_to_msg(result, parts.start))

    def _predict(self, message: Any, parts: Any) -> None:
        assert self._tracker is not None
        lift = lift_from_msg(message)
        box = predictor_messages.box_from_msg(self._task, lift.box_mass)
        prediction = self._predictor.predict(self._tracker.subject, lift, box)
        answer = predictor_messages.prediction_to_msg(prediction, lift, self._tracker.subject)
        self._emit('predicted_lift', answer)
        if prediction.report.status is not SolveStatus.OK or prediction.comparison is None:
            parts.no_prediction = f'prediction failed: {prediction.report.message}'
            return
        self._emit(
            'predicted_lift/joint_trajectory', predictor_messages.trajectory_to_msg(prediction)
        )
        self._emit(
            'lift_comparison',
            predictor_messages.comparison_to_msg(prediction.comparison, prediction, lift),
        )
        self._analyze_lift(answer, PREDICTED, parts)

    def _analyze_lift(self, message: Any, source: str, parts: Any) -> None:
        motion = motion_from_msg(message.motion)
        try:
            spine, torques, muscles = self._analyze(
                message.motion, motion, message.lift_id, source, message.box_mass
            )
        except LiftingError as error:
            self._complain(f'{source}_lift {message.lift_id}: {error}')
            return
        parts.spine[source] = monitor_messages.spine_from_msg(spine)
        parts.torques[source] = monitor_messages.torques_from_msg(torques)
        parts.activations[source] = monitor_messages.activations_from_msg(muscles)


def run_offline(bag_path: Path, output: Path, station: str = 'station_1') -> Path:
    """Run a recording through the pipelines; return the results file.

    Raises
    ------
    lifting_recordings.exceptions.BagError
        If the recording cannot be read.
    SessionError
        If it has no subject and task.
    """
    summary = summarise(bag_path)
    output.mkdir(parents=True, exist_ok=True)
    results = output / 'results.mcap'
    state = LiveState(summary.start)
    view = LiveView(state, summary.duration, gauge_limits(summary))
    with BagReader(bag_path) as bag, ResultsWriter(results, station) as writer, view:

        def emit(topic: str, message: Any) -> None:
            writer.write(topic, message)
            if topic in FOLLOWED:
                view.add(state.update(message))
                view.refresh()

        graph = OfflineGraph(station, emit, view.warn)
        names = {name: name.strip('/') for name in bag.topics}
        wanted = [n for n, short in names.items() if short in (*summary.inputs, 'subject', 'task')]
        for name, _, message in bag.messages(wanted):
            graph.feed(names[name], message)
            if names[name] in ('subject', 'task'):
                writer.write_decoded(names[name], message, bag.types)
        graph.flush()
        if not state.lifts_ended:
            view.warn(NO_LIFT)
        if bag.loss is not None:
            view.warn(str(bag.loss))
    return results
