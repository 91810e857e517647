# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Joint strength of a person as numbers of the compiled functions."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from human_model.strength import JointStrength
from human_model.typing import Array
from lift_predictor.core.exceptions import TaskError


def strength_rows(
    strength: JointStrength, joints: Sequence[str], side: str, constant: Collection[str] = ()
) -> Array:
    """Coefficients with magnitude and signs put in; the bells of equation 2.14 are even.

    Parameters
    ----------
    strength : JointStrength
        Of the person.
    joints : sequence of str
        Joint coordinates.
    side : str
        'lower' or 'upper'.
    constant : collection of str
        Joints whose strength the compiled functions take as constant.

    Returns
    -------
    ndarray, shape (n_joints, 8)
        Coefficients of equations 2.14 and 2.17; the lower ones give a negative torque.

    Raises
    ------
    TaskError
        Coefficients that can become negative (equations 2.16 and 2.19 would leave no torque at
        all), or that vary where the model takes them as constant.
    """
    rows = []
    for joint in joints:
        bound = strength.bound(joint, side)
        c = np.array(bound.coefficients)
        where = f'{strength.coefficient_set}: {side} strength of {joint}'
        if min(c[0], c[1], c[4], c[7]) < 0.0:
            raise TaskError(
                f'{where} has negative coefficients ({bound.source}); a set that cannot change '
                'sign is needed'
            )
        if joint in constant and max(c[1], c[4], c[7]) > 0.0:
            raise TaskError(f'{where} depends on angle or speed; the model takes it as constant')
        c[[0, 1, 4, 7]] *= bound.magnitude
        c[[2, 3]] /= bound.angle_factor, abs(bound.angle_factor)
        c[[5, 6]] /= bound.speed_factor, abs(bound.speed_factor)
        rows.append(c)
    return np.array(rows)
