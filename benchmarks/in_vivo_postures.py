# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Static postures on the musculoskeletal model: feet flat, in balance, hands at their place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from scipy.optimize import least_squares

from human_model.constants import GRAVITY
from human_model.typing import Array
from muscle_analyzer.core.multibody.inverse_dynamics import add_force
from muscle_analyzer.core.multibody.kinematics import BodyState, forward_kinematics
from muscle_analyzer.core.multibody.model import MultibodyModel

SIDES: Final = ('r', 'l')
#: Sum of the coefficients of the lumbar rhythm, flexion (lifting full-body model).
RHYTHM: Final = 7.1429
#: Centre of pressure, fraction of the foot's length from the heel: recorded in quiet standing.
BALANCE: Final = 0.44
#: Length of a foot over that from the heel to the joint of the toes, of the model's foot.
FOOT_OF_HEEL_TO_TOES: Final = 1.4
#: Elbow of an arm that hangs or reaches [rad].
NEARLY_STRAIGHT: Final = 0.1
#: Distance [m] and angle [rad] within which a posture meets its conditions.
MET: Final = 1e-3


@dataclass(frozen=True, eq=False)
class Posture:
    """A static posture.

    Attributes
    ----------
    q : ndarray, shape (n_q,)
    external : ndarray, shape (n_b, 6)
        Wrenches of ground and crate on the bodies.
    state : BodyState
    ankle : ndarray, shape (3,)
        Between the ankles, on the floor, OpenSim's axes [m].
    crate : ndarray, shape (3,) or None
        Its centre [m].
    lean : float
        Of the thorax against upright [deg].
    """

    q: Array
    external: Array
    state: BodyState
    ankle: Array
    crate: Array | None
    lean: float


class PostureSolver:
    """Finds postures of one model.

    Parameters
    ----------
    model : MultibodyModel
    """

    def __init__(self, model: MultibodyModel) -> None:
        self.model = model
        self._foot = [model.body_index(f'calcn_{side}') for side in SIDES]
        self._hand = [model.body_index(f'hand_{side}') for side in SIDES]
        self._ankle = [model.body_index(f'talus_{side}') for side in SIDES]
        self._toes = model.body_index('toes_r')

    def solve(
        self, task: dict[str, Any], place: dict[str, Any] | None, crate_mass: float
    ) -> Posture:
        """Return the posture of a task of the file.

        Parameters
        ----------
        task, place
            Rows of the file; `place` has the hands, None with empty hands.
        crate_mass
            [kg]

        Raises
        ------
        ValueError
            If the hands cannot be at their place.
        """
        mass = crate_mass if place else 0.0
        free_lean = 'lean' not in task
        lean = np.radians(60.0 if free_lean else task['lean'])
        # Hip, ankle, shoulder, and elbow or lean.
        start = np.array([0.3 + lean, 0.0, lean, lean if free_lean else 1.0])

        def posture(x: Array) -> tuple[Array, BodyState]:
            whole = x[3] if free_lean else lean
            straight = free_lean or place is None
            return self._q(task, whole, x, NEARLY_STRAIGHT if straight else x[3])

        def conditions(x: Array) -> Array:
            state = posture(x)[1]
            foot = state.rotation[self._foot[0]][:, 0]
            balance = self._balance(state, place, mass)
            if place is None:
                # The upper arm hangs, and the last unknown does nothing.
                arm = state.rotation[self._arm()][0, 1]
                return np.array([foot[1], balance, arm, x[3] - start[3]])
            hand = self._hands(state) - self._origin(state, place)
            return np.array([foot[1], balance, *(hand[:2] - place['hands'])])

        found = least_squares(conditions, start, x_scale='jac', xtol=1e-12)
        if np.abs(found.fun).max() > MET:
            raise ValueError(f'{task}: conditions of the posture are off by {found.fun}')
        q, state = posture(found.x)
        whole = found.x[3] if free_lean else lean
        return self._loaded(q, state, place, mass, float(np.degrees(whole)))

    def _arm(self) -> int:
        return self.model.body_index('humerus_r')

    def _q(
        self, task: dict[str, Any], lean: float, x: Array, elbow: float
    ) -> tuple[Array, BodyState]:
        lumbar = np.radians(task['lumbar'])
        values = {
            'pelvis_tilt': lumbar - lean,
            'L5_S1_Flex_Ext': -lumbar / RHYTHM,
            'hip_flexion': x[0],
            'knee_angle': np.radians(task['knee']),
            'ankle_angle': x[1],
            'arm_flex': x[2],
            'arm_add': 0.0,
            'elbow_flex': elbow,
        }
        q = self.model.default.copy()
        for name, value in values.items():
            for full in (name, *(f'{name}_{side}' for side in SIDES)):
                if full in self.model.coordinate_names:
                    q[self.model.coordinate_index(full)] = value
        return q, forward_kinematics(self.model.tree, q, 0.0 * q, 0.0 * q)

    def _hands(self, state: BodyState) -> Array:
        return np.asarray(np.mean([self._centre(state, body) for body in self._hand], axis=0))

    def _origin(self, state: BodyState, place: dict[str, Any]) -> Array:
        """Return the point from which the places of hands and crate are given."""
        if place['from'] == 'ankles':
            return self._ankles(state)
        origin: Array = state.joint_position[self._arm()]
        return origin

    def _ankles(self, state: BodyState) -> Array:
        """Return the place between the ankles, on the floor."""
        ankle: Array = np.mean([state.position[body] for body in self._ankle], axis=0)
        ankle[1] = state.position[self._foot[0], 1]
        return ankle

    def _centre(self, state: BodyState, body: int) -> Array:
        tree = self.model.tree
        return np.asarray(state.position[body] + state.rotation[body] @ tree.mass_center[body])

    def _crate(self, state: BodyState, place: dict[str, Any]) -> Array:
        crate = self._hands(state)
        if 'load' in place:
            crate[0] = self._origin(state, place)[0] + place['load']
        return crate

    def _pressure_centre(
        self, state: BodyState, place: dict[str, Any] | None, mass: float
    ) -> float:
        """Return where the line of gravity of body and crate is [m]."""
        tree = self.model.tree
        moment = sum(tree.mass[b] * self._centre(state, b)[0] for b in range(tree.mass.size))
        if place:
            moment += mass * self._crate(state, place)[0]
        return float(moment / (tree.mass.sum() + mass))

    def _balance(self, state: BodyState, place: dict[str, Any] | None, mass: float) -> float:
        heel = float(state.position[self._foot[0], 0])
        length = FOOT_OF_HEEL_TO_TOES * (float(state.position[self._toes, 0]) - heel)
        return self._pressure_centre(state, place, mass) - heel - BALANCE * length

    def _loaded(
        self, q: Array, state: BodyState, place: dict[str, Any] | None, mass: float, lean: float
    ) -> Posture:
        ankle = self._ankles(state)
        external = np.zeros((len(self.model.body_names), 6))
        total = (self.model.tree.mass.sum() + mass) * GRAVITY
        x, none = self._pressure_centre(state, place, mass), np.zeros(3)
        crate = self._crate(state, place) if place else None
        for foot, hand in zip(self._foot, self._hand, strict=True):
            under = np.array([x, ankle[1], state.position[foot, 2]])
            add_force(external, foot, np.array([0.0, 0.5 * total, 0.0]), under, none)
            if crate is not None:
                held = np.array([crate[0], crate[1], state.position[hand, 2]])
                pull = np.array([0.0, -0.5 * mass * GRAVITY, 0.0])
                add_force(external, hand, pull, held, none)
        return Posture(q, external, state, ankle, crate, lean)
