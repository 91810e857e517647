# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Joint torques of an analysed motion beside the strength of the joints (equations 2.14 to 2.19).

Torques come from the musculoskeletal model, angles and speeds from the skeleton of the motion,
strength from `human_model.strength`.  Which torque belongs to which strength, and with which
sign, is in ``data/joint_torques.csv``; joints whose strength is not published are not in it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from human_model.motion import BodyMotion
from human_model.strength import JointStrength
from human_model.subject import Subject
from human_model.tables import read_table
from human_model.typing import Array
from muscle_analyzer.core.boxed_tuple import boxed
from muscle_analyzer.core.exceptions import InputArrayError
from muscle_analyzer.core.loads.analysis import MuscleAnalysis
from muscle_analyzer.core.loads.torque_arrays import TorqueTable, torques_and_limits

#: Skeleton with the strength of one limb.
LIMB_SKELETON = '3d_40dof'
#: Axes of the pelvis (columns of its orientation) that the net moment is taken about.
PELVIS_AXES = {'forward': 0, 'left': 1, 'up': 2}


@dataclass(frozen=True, eq=False)
class JointTorques:
    """Joint torques and dynamic strength of n samples.

    Attributes
    ----------
    lift_id, source : str
        Of the analysis.
    time : (n,)
        [s].
    joint_names : tuple of str, n_j
    torque : (n, n_j)
        In the positive direction of the coordinate [N m].
    lower, upper : (n, n_j)
        Strength in the negative (not positive) and positive (not negative) direction [N m].
    status : (n,) int
        SolveStatus per sample.
    """

    lift_id: str
    source: str
    time: Array
    joint_names: tuple[str, ...]
    torque: Array
    lower: Array
    upper: Array
    status: NDArray[np.int64]


@dataclass(frozen=True)
class TorqueRow:
    """One joint of the table.

    Attributes
    ----------
    joint
        Name of the result.
    of_net_moment
        Whether the torque is the net L5-S1 moment about an axis of the pelvis, or that of a
        coordinate.
    name
        Of that axis or coordinate.
    sign
        1 or -1: from that torque to the coordinate's positive direction.
    coordinate
        Coordinate of the 3D skeleton whose angle, speed and strength count.
    """

    joint: str
    of_net_moment: bool
    name: str
    sign: float
    coordinate: str


def read_torque_rows() -> tuple[TorqueRow, ...]:
    """Read which torque is compared with which strength."""
    rows = []
    columns = 'joint from name sign coordinate'
    for row in read_table('muscle_analyzer', 'joint_torques.csv', columns):
        of_net_moment = row.choice('from', {'net_moment': True, 'coordinate': False})
        if of_net_moment and row['name'] not in PELVIS_AXES:
            raise row.error('name', f'one of {", ".join(PELVIS_AXES)} is needed')
        sign = row.choice('sign', {'1': 1.0, '-1': -1.0})
        rows.append(TorqueRow(row['joint'], of_net_moment, row['name'], sign, row['coordinate']))
    return tuple(rows)


class TorqueLimits:
    """Dynamic strength of one subject for the motions of one skeleton.

    Parameters
    ----------
    subject
        The person.
    skeleton
        Name of the motions' skeleton.
    coordinates
        Its coordinates.
    coefficient_set
        Of `human_model.strength`.

    Raises
    ------
    StrengthError
        If the set is not known or has no strength for a joint of the table.
    """

    def __init__(
        self, subject: Subject, skeleton: str, coordinates: tuple[str, ...], coefficient_set: str
    ) -> None:
        self.rows = read_torque_rows()
        self.joint_names = tuple(row.joint for row in self.rows)
        self._skeleton = skeleton
        own = JointStrength(skeleton, subject, coefficient_set)
        limb = JointStrength(LIMB_SKELETON, subject, coefficient_set)
        # The sagittal skeleton has the strength of both limbs in one coordinate; where its
        # coordinate is no pair (the spine, which it has one joint for) its own strength counts.
        strength = [own if row.coordinate in coordinates else limb for row in self.rows]
        bounds = [
            [of.bound(row.coordinate, side) for of, row in zip(strength, self.rows, strict=True)]
            for side in ('lower', 'upper')
        ]
        # Coordinates that the sagittal skeleton lacks are zero in it.
        column = [
            next((coordinates.index(c) for c in _names(row) if c in coordinates), -1)
            for row in self.rows
        ]
        self._table = TorqueTable(
            of_net_moment=np.array([row.of_net_moment for row in self.rows]),
            source=np.full(len(self.rows), -1),
            sign=np.array([row.sign for row in self.rows]),
            column=np.array(column),
            **{
                name: np.array([[getattr(bound, name) for bound in side] for side in bounds])
                for name in ('coefficients', 'magnitude', 'angle_factor', 'speed_factor')
            },
        )
        self._coordinates: tuple[str, ...] = ()
        self._boxed = boxed(self._table)

    def of(self, analysis: MuscleAnalysis, motion: BodyMotion) -> JointTorques:
        """Put the torques of an analysis beside the strength in the motion's posture and speed.

        Parameters
        ----------
        analysis
            Of this motion.
        motion
            Of this skeleton.

        Raises
        ------
        InputArrayError
            If the two do not belong together.
        """
        if motion.skeleton != self._skeleton or not np.array_equal(analysis.time, motion.time):
            raise InputArrayError(
                f'{motion.skeleton} motion of {len(motion)} samples is not the {self._skeleton} '
                f'motion of the {len(analysis)} samples analysed'
            )
        if analysis.coordinate_names != self._coordinates:
            self._coordinates = analysis.coordinate_names
            self._boxed = boxed(self._table._replace(source=self._sources()))
        torque, lower, upper = torques_and_limits(
            self._boxed,
            motion.position,
            motion.velocity,
            motion.frames,
            motion.frame_names.index('pelvis'),
            analysis.net_moment_top_down,
            analysis.torque,
        )
        return JointTorques(
            analysis.lift_id,
            analysis.source,
            analysis.time,
            self.joint_names,
            torque,
            lower,
            upper,
            analysis.torque_status,
        )

    def _sources(self) -> NDArray[np.int64]:
        """Return the numbers of axes and of coordinates of the analysis that torques come from."""
        return np.array(
            [
                PELVIS_AXES[row.name] if row.of_net_moment else self._coordinates.index(row.name)
                for row in self.rows
            ]
        )


def _names(row: TorqueRow) -> tuple[str, str]:
    """Return the names that a coordinate has in the 3D and in the sagittal skeleton."""
    return row.coordinate, row.coordinate.removesuffix('_r').removesuffix('_l')
