# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Assessment of one lift: peaks and limits, measured and predicted lift (thesis section 4.2)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from injury_monitor.core.activation_index import DEFAULT_WINDOW, ActivationIndex, activation_index
from injury_monitor.core.assignment import Assignment
from injury_monitor.core.exceptions import InvalidInputError
from injury_monitor.core.limits import Limit, LimitSet, Zone, zone_meaning
from injury_monitor.core.loads import LiftLoads
from injury_monitor.core.rnle_assessment import LiftEnds, LiftingAssessment, assess_lifting
from injury_monitor.core.torque_index import TorqueIndexPeaks, torque_index_peaks

#: Least share of good samples of a lift that is assessed: the majority.
MAJORITY = 0.5

#: Share of good samples below which peaks are stated as "at least". An engineering choice: what is
#: left out then lasts longer than a peak of motion filtered at 6 Hz.
COMPLETE = 0.95


@dataclass(frozen=True)
class Criterion:
    """One value of one lift against one limit.

    Attributes
    ----------
    criterion : str
        Name of the limit, for example ``compression_action``.
    source : str
        ``measured`` or ``predicted``.
    value, limit, margin : float
        Peak, limit, and limit minus peak, in ``unit``; NaN where nothing was solved.
    unit, limit_source : str
    time : float
        Of the peak, since the start of the lift [s].
    per_kilogram : float
        Value per kilogram body mass [N/kg]; NaN for an index.
    detail : str
        Joint or muscle of an index.
    """

    criterion: str
    source: str
    value: float
    limit: float
    margin: float
    unit: str
    limit_source: str
    time: float
    per_kilogram: float = math.nan
    detail: str = ''


@dataclass(frozen=True)
class RiskAssessment:
    """Assessment of one lift.

    Attributes
    ----------
    lift_id : str
    assignment : Assignment
    limits : LimitSet
        In force, with their sources.
    criteria : tuple of Criterion
        Compression (two limits), shear, torque and activation index; measured, then predicted.
    avoidable_compression, avoidable_shear : float
        Measured peak minus predicted peak [N]: the load that the optimal lift avoids; NaN without
        a predicted lift.
    torque_index : dict
        ``measured`` and ``predicted`` to the peaks of every joint, where there are torques.
    activation_index : dict
        The same for the muscles.
    lifting : LiftingAssessment
        Revised NIOSH lifting equation.
    zone : Zone
        NIOSH 1981 zone of the measured peak compression.
    summary : str
        One sentence.
    samples_left_out : int
        Samples of all series whose solve report is not good.
    notes : tuple of str
        Parts that could not be assessed, each with its reason.
    """

    lift_id: str
    assignment: Assignment
    limits: LimitSet
    criteria: tuple[Criterion, ...]
    avoidable_compression: float
    avoidable_shear: float
    torque_index: dict[str, TorqueIndexPeaks]
    activation_index: dict[str, ActivationIndex]
    lifting: LiftingAssessment
    zone: Zone
    summary: str
    samples_left_out: int
    notes: tuple[str, ...]

    def criterion(self, name: str, source: str) -> Criterion | None:
        """Return one criterion by limit name and source, or None."""
        for entry in self.criteria:
            if entry.criterion == name and entry.source == source:
                return entry
        return None


def assess_lift(
    assignment: Assignment,
    limits: LimitSet,
    measured: LiftLoads,
    predicted: LiftLoads | None = None,
    ends: LiftEnds | None = None,
    window: float = DEFAULT_WINDOW,
    no_prediction: str = '',
) -> RiskAssessment:
    """Assess one lift.

    Parameters
    ----------
    assignment : Assignment
    limits : LimitSet
    measured, predicted : LiftLoads
        Results of the recorded and of the optimal lift; the latter may be missing.
    ends : LiftEnds, optional
        Places of hands and ankles at origin and destination for the lifting equation.
    window : float
        Of the activation index [s].
    no_prediction : str
        Why there is no predicted lift, for the notes.

    Raises
    ------
    InvalidInputError
        If the two lifts do not belong together.
    """
    if predicted is not None and predicted.lift_id != measured.lift_id:
        raise InvalidInputError(
            'predicted.lift_id',
            predicted.lift_id,
            f'must be that of the measured lift, {measured.lift_id!r}',
        )
    criteria: list[Criterion] = []
    torques: dict[str, TorqueIndexPeaks] = {}
    activations: dict[str, ActivationIndex] = {}
    notes: list[str] = []
    if predicted is None:
        notes.append(
            'no predicted lift, the avoidable load is not known: '
            + (no_prediction or 'no reason was given')
        )
    lifts = (
        {'measured': measured}
        if predicted is None
        else {'measured': measured, 'predicted': predicted}
    )
    for source, lift in lifts.items():
        criteria += _spine(assignment, limits, source, lift, notes)
        if lift.torques is None:
            notes.append(f'{source}: no joint torques')
        else:
            series = lift.torques
            torques[source] = torque_index_peaks(
                series.time,
                series.joints,
                series.torque,
                series.lower,
                series.upper,
                series.solved,
            )
            joint, value, time = torques[source].worst()
            criteria.append(
                _criterion(limits.torque_index, source, value, time - lift.start, joint)
            )
        if lift.activations is None:
            notes.append(f'{source}: no muscle activations')
        else:
            muscles = lift.activations
            activations[source] = activation_index(
                muscles.time, muscles.muscles, muscles.activation, muscles.solved, window
            )
            muscle, value, time = activations[source].worst()
            criteria.append(
                _criterion(limits.activation_index, source, value, time - lift.start, muscle)
            )
    if not limits.shear_within_source:
        notes.append(
            f'{limits.loads_per_day:g} loads a day are more than the shear limit was '
            f'published for ({limits.shear.loads_up_to:g})'
        )
    peaks = {entry.source: entry for entry in criteria if entry.criterion == 'compression_action'}
    shears = {entry.source: entry for entry in criteria if entry.criterion == limits.shear.name}
    zone = limits.zone(peaks['measured'].value)
    more_compression = _difference(peaks)
    lifting = assess_lifting(assignment, ends)
    return RiskAssessment(
        measured.lift_id,
        assignment,
        limits,
        tuple(criteria),
        more_compression,
        _difference(shears),
        torques,
        activations,
        lifting,
        zone,
        _summary(
            peaks['measured'],
            zone,
            more_compression,
            lifting,
            float(np.mean(measured.solved)) < COMPLETE,
        ),
        sum(lift.left_out() for lift in lifts.values()),
        tuple(notes),
    )


def _spine(
    assignment: Assignment, limits: LimitSet, source: str, lift: LiftLoads, notes: list[str]
) -> list[Criterion]:
    values = {}
    for name, series in (('compression', lift.compression), ('shear', lift.anterior_shear)):
        if not np.any(lift.solved):
            values[name] = (math.nan, math.nan)
            continue
        k = int(np.argmax(np.where(lift.solved, series, -np.inf)))
        values[name] = (float(series[k]), float(lift.time[k]) - lift.start)
    share = float(np.mean(lift.solved)) if len(lift.solved) else 0.0
    if not share:
        notes.append(f'{source}: no sample of the spine load was solved')
    elif share < MAJORITY:
        least = ' and '.join(f'{name} {value:.0f} N' for name, (value, _) in values.items())
        notes.append(
            f'{source}: {100 * share:.0f} % of the samples are good, too few for an assessment; '
            f'at least {least}'
        )
        values = dict.fromkeys(values, (math.nan, math.nan))
    elif share < COMPLETE:
        notes.append(
            f'{source}: {100 * share:.0f} % of the samples are good: the peaks are at least as '
            'high as stated'
        )
    pairs = (
        (limits.compression_action, 'compression'),
        (limits.compression_maximum, 'compression'),
        (limits.shear, 'shear'),
    )
    return [
        _criterion(
            limit, source, *values[name], per_kilogram=values[name][0] / assignment.body_mass
        )
        for limit, name in pairs
    ]


def _criterion(
    limit: Limit,
    source: str,
    value: float,
    time: float,
    detail: str = '',
    per_kilogram: float = math.nan,
) -> Criterion:
    return Criterion(
        limit.name,
        source,
        value,
        limit.value,
        limit.margin(value),
        limit.unit,
        limit.source,
        time,
        per_kilogram,
        detail,
    )


def _difference(peaks: dict[str, Criterion]) -> float:
    if 'predicted' not in peaks:
        return math.nan
    return peaks['measured'].value - peaks['predicted'].value


def _summary(
    peak: Criterion, zone: Zone, avoidable: float, lifting: LiftingAssessment, least: bool
) -> str:
    if zone is Zone.UNKNOWN:
        text = 'L5-S1 compression ' + zone_meaning(zone)
    else:
        text = (
            f'Peak L5-S1 compression {"at least " if least else ""}{peak.value:.0f} N '
            f'({peak.per_kilogram:.1f} N/kg), '
            f'{zone_meaning(zone)}'
        )
    if avoidable > 0.0:
        text += f'; {avoidable:.0f} N of it were avoidable'
    elif not math.isnan(avoidable):
        text += f'; the peak of the optimal lift is {-avoidable:.0f} N higher'
    if not math.isnan(lifting.lifting_index):
        text += f'; lifting index {lifting.lifting_index:.2f} ({lifting.band})'
    return text + '.'
