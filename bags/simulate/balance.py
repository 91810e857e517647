# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Keep the centre of pressure in the feet by moving the centre of mass.

A posture in balance is not yet a motion in balance. The centre of pressure p follows the centre
of mass c nearly as that of an inverted pendulum of height h does, p = c - (h / g) c'' (Kajita et
al. 2003); what it is off is taken back by solving that equation for a change of c, and the whole
motion is solved again, a few times.
"""

from __future__ import annotations

import numpy as np
from bags.simulate.forces import whole_wrench
from bags.simulate.motion import SOLVE_RATE, MotionBuilder, SimulatedMotion
from bags.simulate.tasks import Task
from scipy.linalg import solve_banded
from scipy.signal import butter, sosfiltfilt

from human_model.constants import GRAVITY
from human_model.typing import Array

# How far the centre of pressure may swing about its resting place, forward and sideways [m];
# chosen, well inside a foot of 0.26 m.
_SWING = np.array([0.045, 0.03])
# Corrections are made below this frequency: above it a change of the centre of mass comes with
# so much turning of the trunk that the pendulum is no longer near the body.
_SLOW = butter(2, 5.0, fs=SOLVE_RATE, output='sos')
# What may remain [m]; with the swing it leaves more than 3 cm to heel and toe.
_GOOD = 28e-3
_ROUNDS = 12


def pressure_centre(builder: MotionBuilder, motion: SimulatedMotion, time: Array) -> Array:
    """Return the centre of pressure of both feet together (n, 2) [m]."""
    force, moment = whole_wrench(builder.body, motion, time)
    return np.stack((-moment[:, 1], moment[:, 0]), axis=1) / force[:, 2:]


def pendulum(error: Array, height: Array) -> Array:
    """Solve change - (height / g) change'' = -error, at rest at both ends.

    Parameters
    ----------
    error : ndarray (n, 2)
        [m], at `SOLVE_RATE`.
    height : ndarray (n,)
        Of the centre of mass [m].
    """
    n = len(error)
    stiffness = height / GRAVITY * SOLVE_RATE**2
    band = np.zeros((3, n))
    band[0, 1:] = -stiffness[:-1]
    band[1] = 1.0 + 2.0 * stiffness
    band[2, :-1] = -stiffness[1:]
    # Mirrored ends: no slope.
    band[0, 1] *= 2.0
    band[2, -2] *= 2.0
    return np.asarray(solve_banded((1, 1), band, -error))


def balanced_motion(builder: MotionBuilder, task: Task) -> SimulatedMotion:
    """Return a motion of the task whose centre of pressure stays in the feet.

    Raises
    ------
    RuntimeError
        It does not come near enough to the wanted centre of pressure.
    """
    plan = builder.plan(task)
    motion = builder.solve(plan)
    body = builder.body
    masses = np.array([body.centre_of_mass(q)[0] for q in motion.coordinates(plan.time)])
    centre, height = masses[:, :2], masses[:, 2]
    first = pressure_centre(builder, motion, plan.time)
    rest = np.array([body.sole(0.43)[:, 0].mean(), 0.0])
    # What a free passage would do, held within the swing.
    wanted = rest + _SWING * np.tanh((first - rest) / _SWING)
    error = first - wanted
    for _ in range(_ROUNDS):
        centre = centre + sosfiltfilt(_SLOW, pendulum(error, height), axis=0)
        motion = builder.solve(plan, centre)
        error = pressure_centre(builder, motion, plan.time) - wanted
        if np.abs(error).max() < _GOOD:
            return motion
    raise RuntimeError(
        f'{task.name}: the centre of pressure is {np.abs(error).max() * 1e3:.1f} mm off'
    )
