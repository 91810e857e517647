# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of the graph to the core types of the monitor, and back."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from human_model.task import Coupling, Work
from human_model.typing import Array, BoolArray
from injury_monitor.core.alarm_event import AlarmEvent
from injury_monitor.core.assessment import RiskAssessment
from injury_monitor.core.assignment import Assignment
from injury_monitor.core.exceptions import InvalidInputError
from injury_monitor.core.lift_parts import MEASURED, PREDICTED, SpineSeries
from injury_monitor.core.lifting_geometry import LiftEnd
from injury_monitor.core.loads import ActivationSeries, TorqueSeries
from injury_monitor.core.rnle_assessment import LiftEnds
from lifting_messages.message_types import Message, make, message_type
from lifting_messages.names import split
from lifting_messages.stamps import header, to_seconds, to_stamp

_SPINE_LOAD = message_type('SpineLoad')

_SOURCES = {_SPINE_LOAD.MEASURED: MEASURED, _SPINE_LOAD.PREDICTED: PREDICTED}


def _name(message: Message) -> str:
    """Return the name of a message's type, without its package."""
    return type(message).__name__.rpartition('__')[2]


def lift_source(message: Message) -> str:
    """Return ``measured``, ``predicted`` or, for the live stream, ''."""
    if message.source == _SPINE_LOAD.LIVE:
        return ''
    if message.source not in _SOURCES:
        raise InvalidInputError(
            f'{_name(message)}.source',
            message.source,
            'must be LIVE, MEASURED or PREDICTED',
        )
    return _SOURCES[message.source]


def assignment_from_msg(subject: Message, task: Message) -> Assignment:
    """Return person and task; the recording is named by the task and its stamp of entry."""
    try:
        coupling = Coupling(task.coupling)
    except ValueError as error:
        raise InvalidInputError(
            'Task.coupling', task.coupling, 'must be good, fair or poor'
        ) from error
    return Assignment(
        recording=f'{task.task_id}@{to_seconds(task.header.stamp):.3f}',
        subject=subject.pseudonym,
        body_mass=subject.mass,
        box_mass=task.box_mass,
        work=Work(
            task.lifts_per_day,
            task.lifts_per_minute,
            task.duration_hours,
            coupling,
            task.control_at_destination,
        ),
    )


def block_clock(message: Message) -> tuple[Array, BoolArray]:
    """Return time [s] and solve flag of each sample of a block, both (n,)."""
    start = to_seconds(message.header.stamp)
    time = np.array([start + seconds for seconds in message.time_from_start.tolist()], np.float64)
    solved = np.array([code == 0 for code in message.status.tolist()], np.bool_)
    if time.size == 0 or solved.shape != time.shape:
        raise InvalidInputError(
            f'{_name(message)}.status',
            solved.size,
            f'must have one entry for each of the {time.size} samples',
        )
    return time, solved


def rows(message: object, field: str, n: int, width: int) -> Array:
    """Return a row-major field as (n, width)."""
    values = np.asarray(getattr(message, field), np.float64)
    if values.size != n * width:
        raise InvalidInputError(
            f'{_name(message)}.{field}', values.size, f'must have {n} x {width} values'
        )
    return values.reshape(n, width)


def spine_from_msg(message: Message) -> SpineSeries:
    """Return the L5-S1 load of a block."""
    time, solved = block_clock(message)
    compression, shear = (
        rows(message, field, time.size, 1)[:, 0] for field in ('compression', 'anterior_shear')
    )
    return SpineSeries(time, compression, shear, solved)


def torques_from_msg(message: Message) -> TorqueSeries:
    """Return the joint torques of a block."""
    time, solved = block_clock(message)
    joints = split(message.joint_names)
    torque, lower, upper = (
        rows(message, field, time.size, len(joints))
        for field in ('torque', 'torque_lower', 'torque_upper')
    )
    return TorqueSeries(time, joints, torque, lower, upper, solved)


def activations_from_msg(message: Message) -> ActivationSeries:
    """Return the muscle activations of a block."""
    time, solved = block_clock(message)
    muscles = split(message.muscle_names)
    activation = rows(message, 'activation', time.size, len(muscles))
    return ActivationSeries(time, muscles, activation, solved)


def ends_from_msg(lift: Message) -> LiftEnds:
    """Return the places of hands and ankles at the first and last sample of a lift."""
    motion = lift.motion
    names = split(motion.point_names)
    wanted = ('hand_r', 'hand_l', 'ankle_r', 'ankle_l')
    missing = [name for name in wanted if name not in names]
    if missing:
        raise InvalidInputError('MeasuredLift.motion.point_names', list(names), f'lacks {missing}')
    time = to_seconds(motion.header.stamp) + np.asarray(motion.time_from_start, np.float64)
    points = rows(motion, 'points', time.size, 3 * len(names)).reshape(time.size, -1, 3)
    start = to_seconds(lift.header.stamp)
    inside = np.flatnonzero((time >= start - 1e-6) & (time <= start + lift.duration + 1e-6))
    if inside.size == 0:
        raise InvalidInputError(
            'MeasuredLift.duration',
            lift.duration,
            'leaves no sample of the motion inside the lift',
        )

    def end(sample: int) -> LiftEnd:
        hands = points[sample, [names.index('hand_r'), names.index('hand_l')]]
        ankles = points[sample, [names.index('ankle_r'), names.index('ankle_l')]]
        return LiftEnd(hands.mean(axis=0), ankles)

    return LiftEnds(end(int(inside[0])), end(int(inside[-1])))


def alarm_to_msg(event: AlarmEvent, filter_delay: float, unjournaled: bool = False) -> Message:
    """Return the message of an alarm event; `unjournaled`: the journal could not be written."""
    message = make(
        'AlarmEvent',
        header=header(event.stamp),
        occurrence_id=event.occurrence,
        alarm_id=event.alarm,
        station=event.station,
        state=int(event.state),
        previous_state=int(event.previous_state),
        severity=event.severity,
        value=event.value,
        limit=event.limit,
        margin=event.margin,
        unit=event.unit,
        limit_source=event.limit_source,
        filter_delay=filter_delay,
        lift_id=event.lift_id,
        operator_id=event.operator,
        historical=event.historical,
        unjournaled=unjournaled,
        message=event.message(),
    )
    for field in ('stamp_raised', 'stamp_returned'):
        stamp = getattr(event, field)
        if not math.isnan(stamp):
            setattr(message, field, to_stamp(stamp))
    return message


def states_to_msg(events: Sequence[AlarmEvent], filter_delay: float, unjournaled: int) -> Message:
    """Return the message of the present states, from the last event of each alarm."""
    return make(
        'AlarmStates',
        header=header(max((event.stamp for event in events), default=0.0)),
        alarms=[alarm_to_msg(event, filter_delay) for event in events],
        unjournaled=unjournaled,
    )


def assessment_to_msg(result: RiskAssessment, start: float) -> Message:
    """Return the message of an assessment; ``start`` is the start of the lift [s]."""
    assignment, lifting = result.assignment, result.lifting
    equation = lifting.result()
    held = result.activation_index.get(MEASURED)
    muscle, activation, _ = held.worst() if held is not None else ('', math.nan, math.nan)
    joints, measured, predicted = _torque_index(result)
    rows_ = result.criteria
    return make(
        'RiskAssessment',
        header=header(start),
        lift_id=result.lift_id,
        subject=assignment.subject,
        body_mass=assignment.body_mass,
        box_mass=assignment.box_mass,
        lifts_per_day=result.limits.loads_per_day,
        criterion=[row.criterion for row in rows_],
        source=[row.source for row in rows_],
        value=[row.value for row in rows_],
        limit=[row.limit for row in rows_],
        margin=[row.margin for row in rows_],
        unit=[row.unit for row in rows_],
        limit_source=[row.limit_source for row in rows_],
        time_from_start=[row.time for row in rows_],
        avoidable_compression=result.avoidable_compression,
        avoidable_shear=result.avoidable_shear,
        torque_index_joints=list(joints),
        torque_index_measured=measured,
        torque_index_predicted=predicted,
        activation_index_muscle=muscle,
        activation_index=activation,
        multipliers=[math.nan] * 6 if equation is None else list(equation.multipliers),
        recommended_weight_limit=lifting.recommended_weight_limit,
        lifting_index=lifting.lifting_index,
        limiting_multiplier='' if equation is None else equation.limiting_multiplier,
        lifting_index_note=lifting.note,
        zone=int(result.zone),
        summary=' '.join([result.summary, *(f'({note})' for note in result.notes)]),
        samples_left_out=result.samples_left_out,
    )


def _torque_index(result: RiskAssessment) -> tuple[tuple[str, ...], Array, Array]:
    """Return joints and both peaks, NaN where a source lacks a joint."""
    peaks = [result.torque_index.get(source) for source in (MEASURED, PREDICTED)]
    joints = tuple(
        dict.fromkeys(joint for entry in peaks if entry is not None for joint in entry.joints)
    )
    columns = []
    for entry in peaks:
        by_joint = {} if entry is None else dict(zip(entry.joints, entry.peak, strict=True))
        columns.append(np.array([by_joint.get(joint, math.nan) for joint in joints], np.float64))
    return joints, columns[0], columns[1]
