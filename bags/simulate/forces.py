# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Forces that make the simulated motion: hands by the box's balance, feet by inverse dynamics.

The box: m (g + a) = hands + floor. Before lift-off the floor carries what the hands do not yet;
the hands' part grows with continuous slope, so nothing steps. The ground: the whole body's inverse
dynamics (Newton-Euler) gives one wrench; it is divided between the feet so that

* both centres of pressure are at the same share of the way from heel to toe of their foot,
* the weighted mean of the two is the centre of pressure of the whole,
* horizontal force and free moment go with the vertical load, and each foot's force leans inwards
  by a share (`inward_lean`) of the angle to the centre of mass.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from bags.simulate.body import Body
from bags.simulate.motion import SimulatedMotion, grips
from bags.simulate.profiles import quintic
from bags.simulate.tasks import Stage

from human_model import compiled
from human_model.constants import GRAVITY
from human_model.skeleton import ExternalForce
from human_model.typing import Array

_PELVIS_TRANSLATIONS = 3


@dataclass(frozen=True)
class SimulatedForces:
    """Forces on the person at given times; [right, left] where there are two.

    Attributes
    ----------
    time : ndarray (n,)
        [s].
    position, velocity, acceleration : ndarray (n, n_q)
        Of the joint coordinates.
    box : ndarray (n, 4)
        Centre [m] and yaw [rad].
    hand_force, hand_moment : ndarray (n, 2, 3)
        Of the box on the hands [N], [N m] about the grip centres.
    ground_force, centre_of_pressure, free_moment : ndarray (n, 2, 3)
        Of the ground on the feet [N], [m], [N m].
    torque : ndarray (n, n_q)
        Joint torques [N m]; zero at the pelvis.
    """

    time: Array
    position: Array
    velocity: Array
    acceleration: Array
    box: Array
    hand_force: Array
    hand_moment: Array
    ground_force: Array
    centre_of_pressure: Array
    free_moment: Array
    torque: Array


def hand_forces(motion: SimulatedMotion, time: Array) -> tuple[Array, Array]:
    """Return forces and moments (n, 2, 3) of the box on the hands.

    The two forces are the smallest that move the box and keep it level; what two forces cannot
    do (turn the box about the line between the hands) is left to equal moments of the hands.
    """
    task, when = motion.task, motion.phases
    box, acceleration = (np.asarray(motion.box(time, nu=k)) for k in (0, 2))
    mass = task.box_mass
    depth, width, _ = task.box_size
    # Uniform cuboid about its vertical.
    inertia = mass / 12.0 * (depth**2 + width**2)
    force = mass * acceleration[:, :3]
    force[:, 2] += mass * GRAVITY
    # While the box stands on the floor the hands take over its weight from grasp to lift-off, with
    # the slope and curvature that the rise begins with: the floor's part ends at zero smoothly.
    jerk = float(np.asarray(motion.box(when.lift_off + 1e-3, nu=3))[2])
    ramp = quintic(
        time, when.grasp, when.lift_off, (0.0, 0.0, 0.0), (mass * GRAVITY, mass * jerk, 0.0)
    )
    before = time < when.lift_off
    force[before, :2] = 0.0
    force[before, 2] = ramp[before]
    moment = np.zeros_like(force)
    moment[~before, 2] = inertia * acceleration[~before, 3]
    arms = grips(task, box) - box[:, None, :3]
    hands, couples = np.empty((time.size, 2, 3)), np.empty((time.size, 2, 3))
    for i in range(time.size):
        hands[i], couples[i] = _shared(arms[i], force[i], moment[i])
    # The hand feels the opposite of what it does to the box.
    return -hands, -couples


def _shared(arms: Array, force: Array, moment: Array) -> tuple[Array, Array]:
    """Return two forces at `arms` and two equal couples with this resultant."""
    system = np.zeros((6, 6))
    for k in range(2):
        x, y, z = arms[k]
        system[:3, 3 * k : 3 * k + 3] = np.eye(3)
        system[3:, 3 * k : 3 * k + 3] = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]
    line = arms[1] - arms[0]
    line = line / np.linalg.norm(line)
    # Forces are to do all but the moment about the line between the hands.
    middle = arms.mean(axis=0)
    about_line = line * (line @ (moment - np.cross(middle, force)))
    wanted = np.concatenate((force, moment - about_line))
    solution = np.linalg.pinv(system, rcond=1e-9) @ wanted
    return solution.reshape(2, 3), np.tile(0.5 * about_line, (2, 1))


def ground_wrench(body: Body, q: Array, torque: Array) -> tuple[Array, Array]:
    """Return force (3,) and moment about the origin (3,) that the pelvis residual stands for."""
    _, origin, axis = compiled.body_frames(body.skeleton.tree, q)
    force = axis[:_PELVIS_TRANSLATIONS].T @ torque[:_PELVIS_TRANSLATIONS]
    turning = slice(_PELVIS_TRANSLATIONS, 2 * _PELVIS_TRANSLATIONS)
    moment = np.linalg.solve(axis[turning], torque[turning])
    return np.asarray(force), np.asarray(moment + np.cross(origin[5], force))


class GroundSplit:
    """Divides a ground wrench between the feet; the rule stands in the module's docstring."""

    def __init__(self, stage: Stage, body: Body) -> None:
        self._heel, tip = body.sole(0.0)[:, :2], body.sole(1.0)[:, :2]
        self._along = tip - self._heel
        self._lean = float(stage.settings['inward_lean'])

    def __call__(
        self, force: Array, moment: Array, centre_height: float
    ) -> tuple[Array, Array, Array, float]:
        """Return forces, COPs, free moments (2, 3) and the share of the foot [0..1].

        Raises
        ------
        RuntimeError
            The centre of pressure is outside of the feet.
        """
        total = np.array([-moment[1], moment[0]]) / force[2]
        share, load = self._balance(total)
        if not (0.0 <= share <= 1.0 and 0.0 < load < 1.0):
            raise RuntimeError(
                f'centre of pressure {total.round(3).tolist()} m is outside of the feet '
                f'(share {share:.2f} of the foot, {load:.2f} of the load on the right)'
            )
        loads = np.array([load, 1.0 - load])
        cop = np.zeros((2, 3))
        cop[:, :2] = self._heel + share * self._along
        forces = loads[:, None] * force
        apart = cop[1, 1] - cop[0, 1]
        inward = self._lean * force[2] * loads[0] * loads[1] * apart / centre_height
        forces[0, 1] += inward
        forces[1, 1] -= inward
        rest = moment - np.cross(cop, forces).sum(axis=0)
        free = np.zeros((2, 3))
        free[:, 2] = loads * rest[2]
        return forces, cop, free, share

    def _balance(self, total: Array) -> tuple[float, float]:
        """Solve load * right(share) + (1 - load) * left(share) = total by Newton's method."""
        share, load = 0.4, 0.5
        for _ in range(20):
            right, left = self._heel + share * self._along
            residual = load * right + (1.0 - load) * left - total
            slope = np.stack(
                (load * self._along[0] + (1.0 - load) * self._along[1], right - left), axis=1
            )
            step = np.linalg.solve(slope, residual)
            share, load = share - step[0], load - step[1]
            if np.abs(step).max() < 1e-12:
                break
        return float(share), float(load)


def whole_wrench(body: Body, motion: SimulatedMotion, time: Array) -> tuple[Array, Array]:
    """Return force and moment about the origin (n, 3) of the ground on person with box."""
    states = [np.ascontiguousarray(motion.coordinates(time, nu=k)) for k in range(3)]
    hand_force, hand_moment = hand_forces(motion, time)
    place = grips(motion.task, np.asarray(motion.box(time)))
    force, moment = np.empty((time.size, 3)), np.empty((time.size, 3))
    for i in range(time.size):
        loads = _hand_loads(hand_force[i], place[i], hand_moment[i])
        residual = body.skeleton.inverse_dynamics(states[0][i], states[1][i], states[2][i], loads)
        force[i], moment[i] = ground_wrench(body, states[0][i], residual)
    return force, moment


def _hand_loads(force: Array, place: Array, moment: Array) -> list[ExternalForce]:
    return [
        ExternalForce(f'hand_{side}', force[k], place[k], moment[k]) for k, side in enumerate('rl')
    ]


def simulate_forces(
    stage: Stage, body: Body, motion: SimulatedMotion, time: Array
) -> SimulatedForces:
    """Return all forces at the given times.

    Raises
    ------
    RuntimeError
        The motion would need a ground that pulls, or a foot beyond its tips.
    """
    skeleton = body.skeleton
    position, velocity, acceleration = (
        np.ascontiguousarray(motion.coordinates(time, nu=k)) for k in range(3)
    )
    box = np.asarray(motion.box(time))
    hand_force, hand_moment = hand_forces(motion, time)
    hand_place = grips(motion.task, box)
    split = GroundSplit(stage, body)
    n = time.size
    ground, cop, free = np.empty((n, 2, 3)), np.empty((n, 2, 3)), np.empty((n, 2, 3))
    torque = np.empty_like(position)
    whole_force, whole_moment = whole_wrench(body, motion, time)
    for i in range(n):
        loads = _hand_loads(hand_force[i], hand_place[i], hand_moment[i])
        height = float(skeleton.centre_of_mass(position[i])[2])
        ground[i], cop[i], free[i], _ = split(whole_force[i], whole_moment[i], height)
        loads += [
            ExternalForce(f'foot_{side}', ground[i, k], cop[i, k], free[i, k])
            for k, side in enumerate('rl')
        ]
        torque[i] = skeleton.inverse_dynamics(position[i], velocity[i], acceleration[i], loads)
    return SimulatedForces(
        time,
        position,
        velocity,
        acceleration,
        box,
        hand_force,
        hand_moment,
        ground,
        cop,
        free,
        torque,
    )
