# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The task of one recorded lift: box, feet, postures, time (section 4.3)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from human_model.motion import BodyMotion, Lift
from human_model.task import Box
from human_model.typing import Array
from lift_predictor.core.exceptions import TaskError, UnreachableError
from lift_predictor.core.models.ranges import hamstring_room
from lift_predictor.core.models.sagittal.grid import LiftBounds
from lift_predictor.core.models.sagittal.kinematics import chain_positions, reach
from lift_predictor.core.models.sagittal.parameters import HIP, JOINTS, KNEE, LiftParameters
from lift_predictor.core.models.sagittal.person import Person
from lift_predictor.core.models.sagittal.plane import SagittalMotion, SagittalPlane, SideView
from lift_predictor.core.options import POSTURE_TOLERANCE
from lift_predictor.core.planning.postures import REACHED
from lift_predictor.core.problem.task import NO_BOX, largest_acceleration

PLACE_ALLOWANCE: Final = 1e-3
"""How far below the lower of its places the box may be carried [m]: what motion capture resolves;
without it there would be no inside of the feasible set where the box stands at an end."""
INSTANTS: Final = ('start', 'middle', 'end')


@dataclass(frozen=True, eq=False)
class SagittalTask:
    """One lift to predict.

    Attributes
    ----------
    lift_id : str
        Of the recorded lift.
    start : float
        Start of the lift on the recording's clock [s].
    person : Person
        Who lifts.
    plane : SagittalPlane
        Where in the laboratory.
    measured : SagittalMotion or None
        The recorded lift seen from the side; None: the lift is planned, nothing was recorded.
    parameters : LiftParameters
        Numbers of person and task.
    bounds : LiftBounds
        Demands of the task.
    ends : array, shape (2, 6)
        Postures at start and end that reach the box [rad].
    notes : tuple of str
        What had to be adapted, in words.
    """

    lift_id: str
    start: float
    person: Person
    plane: SagittalPlane
    measured: SagittalMotion | None
    parameters: LiftParameters
    bounds: LiftBounds
    ends: Array
    notes: tuple[str, ...]

    @property
    def is_recorded(self) -> bool:
        """Whether there is a recorded lift to compare with."""
        return self.measured is not None

    @property
    def gravity(self) -> float:
        """[m/s^2]."""
        return self.parameters.gravity

    @property
    def mass(self) -> tuple[float, float]:
        """Least and largest mass of the box [kg]; equal: given."""
        return float(self.bounds.box_mass[0]), float(self.bounds.box_mass[1])

    def with_mass(self, least: float, largest: float) -> SagittalTask:
        """Return the task with other bounds of the box's mass [kg]."""
        return replace(self, bounds=replace(self.bounds, box_mass=np.array([least, largest])))

    def with_objective(self, effort: float, weight: float) -> SagittalTask:
        """Return the task with other factors of effort and log-weight (equation 2.11)."""
        parameters = replace(self.parameters, objective=np.array([effort, weight]))
        return replace(self, parameters=parameters)


def build_task(
    person: Person,
    lift: Lift,
    box: Box,
    posture_tolerance: float | Sequence[float] = POSTURE_TOLERANCE,
    fraction: float = 1.0,
    view: SideView | None = None,
) -> SagittalTask:
    """Build the task of a recorded lift.

    Parameters
    ----------
    person : Person
        Who lifted.
    lift : Lift
        The recorded lift, on either skeleton.
    box : Box
        What was lifted.
    posture_tolerance : float or sequence of 3 floats
        Epsilon of equation 4.8, or those of equation 2.23 at start, middle and end [rad].
    fraction : float
        Of the way from the recorded places of the box to those asked for.
    view : SideView, optional
        The lift seen from the side, if it is known already.

    Raises
    ------
    TaskError
        The recording has no usable feet, postures or samples, or the lift is asymmetric.
    UnreachableError
        A hand target cannot be met within joint limits and posture tolerance.
    """
    motion = lift.window
    view = view or SideView.of(motion, lift.start, person.neutral)
    plane, measured = view.plane, view.motion
    duration = lift.end - lift.start
    instants = np.array([0.0, 0.5, 1.0]) * duration
    tolerance = np.broadcast_to(np.asarray(posture_tolerance, dtype=float), 3)
    if reason := asymmetry(lift, view, box, tolerance):
        raise TaskError(reason)
    ankle, support = _feet(motion, plane)
    from_hand = _box_from_hand(motion, plane, measured)
    person, beyond = _with_range(person, measured)
    parameters = LiftParameters(
        body=person.body,
        strength_lower=person.strength_lower,
        strength_upper=person.strength_upper,
        circle=person.circle if box.depth > 0.0 else np.zeros_like(person.circle),
        hip_range=person.hip_range,
        ankle=ankle,
        support=support,
        ground_height=float(ankle[1] - person.ankle_height),
        gravity=person.gravity,
        duration=duration,
        box_mass=box.mass,
        box_half=0.5 * np.array([box.size[0], box.size[2]]),
        box_acceleration=NO_BOX,
        box_from_hand=from_hand,
        lowest_grip=float(ankle[1] - person.ankle_height),
    )
    parameters, closer = _fit_circles(parameters, measured)
    notes = (*beyond, *closer)
    postures = np.stack([np.interp(instants, measured.time, column) for column in measured.q.T], 1)
    hand = np.stack([_at(measured, measured.grip, t) for t in instants[[0, 2]]])
    for row, place in enumerate((box.start, box.end)):
        if place is not None:
            asked = plane.into(np.asarray(place, dtype=float)) - from_hand
            hand[row] += fraction * (asked - hand[row])
    if box.mass > 0.0 or box.depth > 0.0:
        parameters = replace(
            parameters,
            lowest_grip=lowest_grip(hand),
            box_acceleration=largest_acceleration(hand, duration),
        )
    bounds = _bounds(person, postures, tolerance, hand, box.mass)
    ends = _reachable_ends(bounds, postures, parameters)
    return SagittalTask(
        lift.lift_id, lift.start, person, plane, measured, parameters, bounds, ends, notes
    )


def lowest_grip(hand: Array) -> float:
    """Return the least height of the grip for places at start and end (2, 2) [m].

    The box stands on something at the lower of its places, and is not carried below it.
    """
    return float(hand[:, 1].min() - PLACE_ALLOWANCE)


def _at(measured: SagittalMotion, values: Array, time: float) -> Array:
    return np.array([np.interp(time, measured.time, column) for column in values.T])


def asymmetry(
    lift: Lift, view: SideView, box: Box, posture_tolerance: float | Array = POSTURE_TOLERANCE
) -> str:
    """Return the reason why a lift does not fit the sagittal model; empty: it fits.

    Its sides lie further from their mean than the posture may (equation 4.8), or trunk or box turn
    out of the sagittal plane by more than that.

    Parameters
    ----------
    lift : Lift
        The recorded lift.
    view : SideView
        The lift seen from the side.
    box : Box
        What was lifted.
    posture_tolerance : float or ndarray, shape (3,)
        Epsilon of equation 4.8, or those of equation 2.23 [rad].
    """
    motion, plane, measured = lift.window, view.plane, view.motion
    tolerance = np.broadcast_to(np.asarray(posture_tolerance, dtype=float), 3)
    instants = np.array([0.0, 0.5, 1.0]) * (lift.end - lift.start)
    for when, time, most in zip(INSTANTS, instants, tolerance, strict=True):
        half = 0.5 * np.abs(_at(measured, measured.side_difference, time))
        worst = int(np.argmax(half))
        if half[worst] > most:
            apart, allowed = np.degrees((2.0 * half[worst], 2.0 * most))
            return (
                f'{JOINTS[worst]}: right and left are {apart:.0f} deg apart at the {when} of the '
                f'lift; the sagittal model allows {allowed:.0f} deg'
            )
    turn = plane.rotation().T
    across = (motion.point('shoulder_l') - motion.point('shoulder_r')) @ turn.T
    checks = {'the line of the shoulders': np.abs(np.arctan2(across[:, 0], across[:, 1]))}
    if box.mass > 0.0:
        ankles = 0.5 * (motion.point('ankle_r') + motion.point('ankle_l'))
        hands = 0.5 * (motion.point('hand_r') + motion.point('hand_l'))
        out = (hands - ankles) @ turn.T
        aside = np.abs(np.arctan2(out[:, 1], np.abs(out[:, 0])))
        checks['the grip, seen from the ankles,'] = aside
    for name, angle in checks.items():
        if angle.max() > tolerance.max():
            return (
                f'{name} turns {np.degrees(angle.max()):.0f} deg out of the sagittal plane; '
                f'the sagittal model allows {np.degrees(tolerance.max()):.0f} deg'
            )
    return ''


def _feet(motion: BodyMotion, plane: SagittalPlane) -> tuple[Array, Array]:
    """Mean ankle (forward, up), and rear and front edge of the foot support region."""
    points = {
        name: np.stack([plane.into(motion.point(f'{name}_{side}')) for side in 'rl'])
        for name in ('heel', 'toe', 'ankle')
    }
    rear = points['heel'][..., 0]
    front = points['toe'][..., 0]
    for side, name in enumerate(('right', 'left')):
        if rear[side].max() >= front[side].min():
            raise TaskError(
                f'the {name} foot moves {np.ptp(rear[side]):.2f} m during the lift: '
                'the feet must stay (equation 4.4)'
            )
    support = np.array([rear.mean(axis=1).min(), front.mean(axis=1).max()])
    return points['ankle'].mean(axis=(0, 1)), support


def _box_from_hand(motion: BodyMotion, plane: SagittalPlane, measured: SagittalMotion) -> Array:
    """Mean of box centre minus grip; zero where no box is tracked."""
    box = plane.into(motion.box_position)
    tracked = np.all(np.isfinite(box), axis=1)
    if not tracked.any():
        return np.zeros(2)
    return np.asarray((box - measured.grip)[tracked].mean(axis=0))


def _with_range(person: Person, measured: SagittalMotion) -> tuple[Person, tuple[str, ...]]:
    """Widen the ranges of motion that the recorded lift itself exceeded: this person has more."""
    low = np.minimum(person.angle_lower, measured.q.min(axis=0))
    known = [person.skeleton.limits[person.skeleton.index(joint)][0] for joint in JOINTS]
    low = np.maximum(low, known)
    room = hamstring_room(measured.q[:, HIP], measured.q[:, KNEE], person.hip_range)
    more = max(-float(room.min()), 0.0)
    wider = {
        joint: float(np.degrees(amount))
        for joint, amount in zip(JOINTS, person.angle_lower - low, strict=True)
        if amount > 0.0
    }
    if more > 0.0:
        wider['hip_flexion with the knee'] = float(np.degrees(more))
    if not wider:
        return person, ()
    notes = tuple(
        f'the range of {name} is {amount:.0f} deg wider than published, as recorded'
        for name, amount in wider.items()
    )
    hip = person.hip_range + np.array([more, 0.0])
    return replace(person, angle_lower=low, hip_range=hip), notes


def _fit_circles(
    parameters: LiftParameters, measured: SagittalMotion
) -> tuple[LiftParameters, tuple[str, ...]]:
    """Shrink the circles that the recorded lift itself went through: the body is thinner."""
    gaps = chain_positions(measured.q, parameters, measured.grip).gaps.min(axis=0)
    circle = parameters.circle.copy()
    used = circle[:, 2] > 0.0
    deep = used & (gaps < 0.0)
    circle[deep, 2] = np.maximum(circle[deep, 2] + gaps[deep], 0.0)
    if not deep.any():
        return parameters, ()
    note = (
        f'{int(deep.sum())} of {int(used.sum())} collision circles were reduced, as the recorded '
        f'lift came up to {-1e3 * gaps[deep].min():.0f} mm closer'
    )
    return replace(parameters, circle=circle), (note,)


def _bounds(
    person: Person, postures: Array, tolerance: Array, hand: Array, mass: float
) -> LiftBounds:
    lower = np.maximum(postures - tolerance[:, None], person.angle_lower)
    upper = np.minimum(postures + tolerance[:, None], person.angle_upper)
    for row, when in enumerate(INSTANTS):
        for column, joint in enumerate(JOINTS):
            if lower[row, column] > upper[row, column]:
                low, high = person.angle_lower[column], person.angle_upper[column]
                raise TaskError(
                    f'{joint} at the {when} of the lift: {np.degrees(postures[row, column]):.1f} '
                    f'deg is outside its limits of {np.degrees(low):.1f} to '
                    f'{np.degrees(high):.1f} deg'
                )
    return LiftBounds(
        person.angle_lower, person.angle_upper, lower, upper, hand, np.array([mass, mass])
    )


def _reachable_ends(bounds: LiftBounds, postures: Array, parameters: LiftParameters) -> Array:
    ends = []
    for row, instant in enumerate((0, 2)):
        lower, upper = bounds.posture_lower[instant], bounds.posture_upper[instant]
        posture, distance = reach(bounds.hand[row], postures[instant], lower, upper, parameters)
        if distance > REACHED:
            span = upper - lower
            at_bound = (posture - lower < 0.01 * span) | (upper - posture < 0.01 * span)
            raise UnreachableError(
                f'hand position (4.6) at the {INSTANTS[instant]}: the grip stays '
                f'{1e3 * distance:.0f} mm from forward {bounds.hand[row, 0]:.3f} m, up '
                f'{bounds.hand[row, 1]:.3f} m; joints at the end of the posture tolerance or of '
                f'their range: {", ".join(np.array(JOINTS)[at_bound]) or "none"}'
            )
        ends.append(posture)
    return np.stack(ends)
