# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""The person with feet on the floor and hands on the box: constraints, postures, projection."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from bags.simulate.tasks import Stage
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from human_model import compiled
from human_model.named_subjects import named_subject
from human_model.skeletons import Skeleton3D
from human_model.subject import Subject
from human_model.typing import Array, IntArray

SIDES = ('r', 'l')
# Lever [m] of the second point that holds the direction of the grip.
_LEVER = 0.05
_HARD = 1e3
# Least knee flexion of a key posture [rad]; chosen.
_SOFT_KNEE = 0.24
_TOLERANCE = 1e-10
# How far a joint may deviate before it costs as much as another [rad], [m]: pelvis freely,
# spine and wrist reluctantly. Chosen.
_EASE = {
    'pelvis': 1.0,
    'knee': 0.15,
    'lumbar': 0.3,
    'thorax': 0.2,
    'wrist': 0.15,
    'pro_sup': 0.3,
    'arm': 0.5,
}


@dataclass(frozen=True)
class Goal:
    """Where the hands and the balance are to be.

    Attributes
    ----------
    hands : ndarray (2, 3) or None
        Grip centres right, left [m]; None: free.
    grip_axis : ndarray (3,)
        Forward direction of the grip (the box's x axis).
    balance : ndarray (2,) or None
        Where the weight of person and box is to fall on the floor [m]; None: free.
    box_mass : float
        In the hands [kg].
    box : ndarray (3,)
        Centre of the box [m].
    """

    hands: Array | None
    grip_axis: Array
    balance: Array | None = None
    box_mass: float = 0.0
    box: Array | None = None


class Body:
    """The subject standing at the origin.

    Parameters
    ----------
    stage : Stage
        Subject and stance.
    subject : Subject, optional
        In place of the stage's subject.
    """

    def __init__(self, stage: Stage, subject: Subject | None = None) -> None:
        self.subject = subject or named_subject(stage.subject)
        self.skeleton = Skeleton3D.of(self.subject)
        lengths = self.skeleton.parameters.lengths
        self.lengths = lengths
        index = self.skeleton.parameters.index
        # Three points fix a foot; they span the sole.
        sole = np.array(
            [
                (-lengths['heel_length'], 0.0, -lengths['ankle_height']),
                (lengths['ankle_mtp'], 0.05, -lengths['ankle_height']),
                (lengths['ankle_mtp'], -0.05, -lengths['ankle_height']),
            ]
        )
        grip = np.array([(0.0, 0.0, -lengths['hand_grip'])])
        axis = grip + (_LEVER, 0.0, 0.0)
        self._foot_segments = np.repeat([index('foot_r'), index('foot_l')], 3)
        self._foot_local = np.concatenate((sole, sole))
        self._hand_segments = np.array([index('hand_r'), index('hand_l')])
        self._grip_local = np.concatenate((grip, grip))
        self._axis_local = np.concatenate((axis, axis))
        half = 0.5 * stage.stance_width
        self.feet_rotation = [
            Rotation.from_euler('z', sign * stage.toe_out).as_matrix() for sign in (-1.0, 1.0)
        ]
        self.ankles = np.array(
            [(0.0, -half, lengths['ankle_height']), (0.0, half, lengths['ankle_height'])]
        )
        self._foot_targets = np.concatenate(
            [self.ankles[i] + sole @ self.feet_rotation[i].T for i in range(2)]
        )
        self._mass_segments = np.arange(len(self.skeleton.segments), dtype=np.int64)
        self._mass_local = np.array(self.skeleton.parameters.com)
        self._mass_share = self.skeleton.parameters.mass / self.skeleton.total_mass
        names = self.skeleton.coordinates
        self.ease = np.array(
            [next((v for k, v in _EASE.items() if name.startswith(k)), 0.7) for name in names]
        )

    def sole(self, share: float) -> Array:
        """Return the points (2, 3) at a share of the way from heel to toe tip on both soles."""
        lengths = self.lengths
        back = -lengths['heel_length']
        front = lengths['ankle_mtp'] + lengths['toes']
        local = np.array([back + share * (front - back), 0.0, -lengths['ankle_height']])
        return np.stack([self.ankles[i] + self.feet_rotation[i] @ local for i in range(2)])

    def _points(self, q: Array, segments: IntArray, local: Array) -> tuple[Array, Array]:
        position, jacobian = compiled.points_and_jacobian(
            self.skeleton.tree, q, segments, np.ascontiguousarray(local)
        )
        return position, jacobian

    def hands(self, q: Array) -> Array:
        """Return the grip centres (2, 3) [m]."""
        return self._points(q, self._hand_segments, self._grip_local)[0]

    def centre_of_mass(self, q: Array) -> tuple[Array, Array]:
        """Return the centre of mass (3,) [m] and its Jacobian (3, n_q)."""
        place, slope = self._points(q, self._mass_segments, self._mass_local)
        return np.asarray(self._mass_share @ place), np.tensordot(self._mass_share, slope, 1)

    def constraint(
        self, q: Array, hands: Array | None, centre: Array | None = None
    ) -> tuple[Array, Array]:
        """Return residuals and Jacobian of feet, hands and balance: what has to be zero [m].

        Parameters
        ----------
        q : ndarray (n_q,)
            Posture.
        hands : ndarray (2, 3) or None
            Grip centres [m]; None: free.
        centre : ndarray (2,) or None
            Centre of mass, horizontally [m]; None: free.
        """
        place, slope = self._points(q, self._foot_segments, self._foot_local)
        residual = [(place - self._foot_targets).ravel()]
        jacobian = [slope.reshape(-1, q.size)]
        if hands is not None:
            place, slope = self._points(q, self._hand_segments, self._grip_local)
            residual.append((place - hands).ravel())
            jacobian.append(slope.reshape(-1, q.size))
        if centre is not None:
            mass, slope = self.centre_of_mass(q)
            residual.append(mass[:2] - centre)
            jacobian.append(slope[:2])
        return np.concatenate(residual), np.concatenate(jacobian)

    def project(
        self,
        reference: Array,
        hands: Array | None,
        start: Array | None = None,
        centre: Array | None = None,
    ) -> Array:
        """Return the posture nearest to `reference` that meets the constraint.

        Raises
        ------
        RuntimeError
            The constraints cannot be met.
        """
        ease = self.ease
        x_ref = reference / ease
        x = (reference if start is None else start) / ease
        for _ in range(200):
            residual, jacobian = self.constraint(x * ease, hands, centre)
            scaled = jacobian * ease
            inverse = np.linalg.pinv(scaled, rcond=1e-8)
            back = x_ref - x
            step = back - inverse @ (scaled @ back + residual)
            x = x + step
            if np.abs(step).max() < _TOLERANCE and np.abs(residual).max() < _TOLERANCE:
                return np.asarray(x * ease)
        raise RuntimeError(
            f'hands {hands} cannot be reached: residual {np.abs(residual).max():.2e} m'
        )

    def posture(self, preferred: Mapping[str, float], goal: Goal) -> Array:
        """Return a posture near `preferred` within the joint limits that meets the goal."""
        skeleton = self.skeleton
        wish = skeleton.vector(preferred)
        if 'pelvis_ty' not in preferred:
            wish[skeleton.index('pelvis_ty')] = skeleton.standing_height - 0.01
        low, high = skeleton.limits.T.copy()
        # Nobody lifts with locked knees, and a straight leg is singular.
        low[[skeleton.index(f'knee_angle_{side}') for side in SIDES]] = _SOFT_KNEE

        def residual(q: Array) -> Array:
            hard, _ = self.constraint(q, goal.hands)
            parts = [_HARD * hard, (q - wish) / self.ease]
            if goal.hands is not None:
                place, _ = self._points(q, self._hand_segments, self._axis_local)
                wanted = goal.hands + _LEVER * goal.grip_axis
                parts.append(20.0 * (place - wanted).ravel())
            if goal.balance is not None:
                parts.append(50.0 * (self.weight_point(q, goal) - goal.balance))
            return np.concatenate(parts)

        start = np.clip(wish, low + 1e-6, high - 1e-6)
        found = least_squares(residual, start, bounds=(low, high), xtol=1e-10, max_nfev=200)
        return np.asarray(found.x)

    def weight_point(self, q: Array, goal: Goal) -> Array:
        """Return where the weight of person and box falls on the floor (2,) [m]."""
        mass = self.skeleton.total_mass
        total = mass * self.skeleton.centre_of_mass(q)
        if goal.box is not None:
            total = total + goal.box_mass * goal.box
            mass += goal.box_mass
        return np.asarray(total[:2] / mass)
