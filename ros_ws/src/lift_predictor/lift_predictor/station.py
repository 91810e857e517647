# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The lift predictor in the graph: measured lifts in, optimal lifts out."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterator
from time import perf_counter
from typing import Final

from human_model.exceptions import LiftingError
from human_model.motion import Lift
from human_model.subject import Subject
from lift_predictor import conversions, topics
from lift_predictor.core.options import PredictorOptions
from lift_predictor.core.predictor import LiftPredictor
from lifting_messages import Message
from lifting_messages.station import Output, Station

#: Lifts kept until subject and task are known, and afterwards for further predictions.
KEPT_LIFTS: Final = 100


class PredictorStation(Station):
    """Predicts each measured lift in the background.

    Parameters
    ----------
    values, name, log, clock
        See `Station`.

    Attributes
    ----------
    options : PredictorOptions
    subject : Subject or None
    task : message or None
    predicted : dict
        Lifts that a prediction was made of, by `lift_id`.
    """

    PACKAGE = 'lift_predictor'
    INPUTS = topics.INPUTS
    OUTPUTS = topics.OUTPUTS

    def prepare(self) -> None:
        """Create the pipeline and the functions of the inputs."""
        self.handlers = {
            'subject': self._on_subject,
            'task': self._on_task,
            'measured_lift': self._on_measured_lift,
        }
        self.options = PredictorOptions(**self.values)
        self.subject: Subject | None = None
        self.task: Message | None = None
        self.predicted: OrderedDict[str, Lift] = OrderedDict()
        self._predictor = LiftPredictor(self.options)
        self._waiting: OrderedDict[str, Lift] = OrderedDict()

    def warm_up(self) -> None:
        """Load the compiled functions (first run on a machine: compile)."""
        library = self._predictor.sagittal.model.library
        self.log.info(f'{library.backend} ({library.build_time:.2f} s)')

    @property
    def pending(self) -> bool:
        """Whether a lift waits whose person and task are known."""
        return bool(self._waiting) and self.subject is not None and self.task is not None

    def work(self, duration: float) -> Iterator[Output]:
        """Predict lifts for about this time [s], at least one."""
        end = perf_counter() + duration
        while self.pending:
            _, lift = self._waiting.popitem(last=False)
            try:
                yield from self._predict(lift)
            except LiftingError as error:
                self.report_error(f'{lift.lift_id}: {error}')
            if perf_counter() > end:
                return

    def _on_subject(self, message: Message) -> Iterator[Output]:
        self.subject = conversions.subject_from_msg(message)
        return iter(())

    def _on_task(self, message: Message) -> Iterator[Output]:
        self.task = message
        return iter(())

    def _on_measured_lift(self, message: Message) -> Iterator[Output]:
        lift = conversions.lift_from_msg(message)
        self._waiting[lift.lift_id] = lift
        while len(self._waiting) > KEPT_LIFTS:
            dropped, _ = self._waiting.popitem(last=False)
            self.report_error(f'measured_lift {dropped}: no subject or task came, dropped')
        return iter(())

    def _predict(self, lift: Lift) -> Iterator[Output]:
        assert self.subject is not None  # Only pending lifts are predicted.
        box = conversions.box_from_msg(self.task, lift.box_mass)
        self.predicted[lift.lift_id] = lift
        if len(self.predicted) > KEPT_LIFTS:
            self.predicted.popitem(last=False)
        prediction = self._predictor.predict(self.subject, lift, box)
        comparison = prediction.comparison
        self.counts['predicted' if prediction.report.ok else 'not predicted'] += 1
        yield 'predicted_lift', conversions.prediction_to_msg(prediction, lift, self.subject)
        if not prediction.report.ok or comparison is None:
            return
        yield 'predicted_lift/joint_trajectory', conversions.trajectory_to_msg(prediction)
        yield 'lift_comparison', conversions.comparison_to_msg(comparison, prediction, lift)
        self.log.info(
            f'{lift.lift_id}: {prediction.report.message}; effort '
            f'{comparison.predicted_effort:.3g} s, recorded {comparison.measured_effort:.3g} s; '
            f'solved in {prediction.report.solve_time:.2f} s'
        )
